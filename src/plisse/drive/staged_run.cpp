#include <plisse/drive/staged_run.h>

#include <algorithm>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <plisse/base/error.h>
#include <plisse/drive/refine.h>
#include <plisse/mesh/intersecting_surfaces.h>
#include <plisse/model/strain_limit.h>
#include <plisse/spatial/box.h>
#include <plisse/spatial/intersections.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

bool is_direct(const Model& model) {
    return model.solve.method == Method::direct;
}

/// Meshes a run needs: `direct` on the finest needs no hierarchy, unless that makes the finest.
int levels_needed(const Model& model) {
    const bool by_decimation = model.hierarchy.source == HierarchySource::decimation;
    return is_direct(model) && !model.solve.level && by_decimation ? 1 : model.hierarchy.levels;
}

RunReport starting_report(const Model& model, const RunOptions& options) {
    if (options.resume)
        return options.resume->report;
    RunReport report;
    report.name = model.name;
    report.method = is_direct(model) ? "direct" : "progressive";
    return report;
}

double timeline_end(const Model& model, double until) {
    return until >= 0 ? std::min(until, model.solve.duration) : model.solve.duration;
}

} // namespace

StagedRun::StagedRun(const Model& model, const RunOptions& options, Recorder& recorder, Context& context)
    : recorder_(recorder), context_(context), until_(options.until),
      discretization_(model, levels_needed(model), context, options.hierarchies),
      duration_(timeline_end(model, until_)),
      log_(discretization_.hierarchy(), static_cast<int>(model.bodies.size()), governing_scales(model), recorder,
           context, starting_report(model, options)),
      first_level_(is_direct(model) ? model.solve.level.value_or(discretization_.finest()) : 0),
      last_level_(is_direct(model) ? first_level_ : discretization_.finest()) {
    if (first_level_ > discretization_.finest())
        throw InputError(model.name,
                         fmt::format("level {} was asked for, but there are only levels 0 to {}", first_level_,
                                     discretization_.finest()),
                         "a smaller level, or more hierarchy.levels");
    recorder_.on_hierarchy(discretization_.hierarchy());
    report().status = RunStatus::running;
    if (options.resume) {
        log_.restore_frame_numbers(options.resume->frame_numbers);
        log_.publish();
        enter(*options.resume);
        return;
    }
    log_.publish();
    const Checkpoint progress = fresh_progress(first_level_, 0, discretization_.start(first_level_));
    check_start(progress.positions);
    const int input_level = discretization_.hierarchy().input_level();
    check_limits(input_level, discretization_.start(input_level));
    check_limits(first_level_, progress.positions);
    enter(progress);
}

void StagedRun::enter(const Checkpoint& progress) {
    const EnergiesOf energies = is_direct(model()) ? EnergiesOf::level : EnergiesOf::finest;
    stepper_.emplace(discretization_, progress.level, energies, progress.level == last_level_, log_);
    stepper_->start_from(progress);
}

void StagedRun::fail(RunStatus status, const std::string& message) {
    RunReport& report = log_.report();
    if (report.status == RunStatus::running)
        report.status = status;
    if (!message.empty())
        report.message += (report.message.empty() ? "" : "; ") + message;
}

void StagedRun::check_start(const Positions& x) const {
    const std::vector<int>& part = discretization_.layout(first_level_).face_part;
    const auto both_obstacles = [&](int a, int b) {
        return model().is_obstacle(part[at(a)]) && model().is_obstacle(part[at(b)]);
    };
    const auto& faces = discretization_.mesh(first_level_).faces;
    const auto pairs = intersecting_pairs(x, faces, both_obstacles);
    if (pairs.empty())
        return;
    const Vec3 place = meeting_place(x, faces[at(pairs.front()[0])], faces[at(pairs.front()[1])]);
    const InputError error(
        model().name,
        fmt::format("{} pairs of faces of level {} intersect at the start, the first near ({:.6g}, {:.6g}, {:.6g})",
                    pairs.size(), first_level_, place.x(), place.y(), place.z()),
        "surfaces may not touch");
    throw IntersectingSurfaces(error, x, faces, pairs, part);
}

void StagedRun::check_limits(int level, const Positions& x) const {
    const StrainLimit::Excess excess = StrainLimit(discretization_, level).excess(x, 2 * StrainLimitEnergy::least_room);
    if (excess.faces == 0)
        return;
    const Hierarchy& hierarchy = discretization_.hierarchy();
    const bool as_given = level == hierarchy.input_level();
    throw InputError(model().name,
                     fmt::format("{} faces{} are stretched beyond their strain limit at the start: one of \"{}\" near "
                                 "({:.6g}, {:.6g}, {:.6g}) to {:.6g}, and its limit is {:.6g}",
                                 excess.faces, as_given ? "" : fmt::format(" of level {}", level),
                                 model().bodies[at(excess.body)].name, excess.place.x(), excess.place.y(),
                                 excess.place.z(), excess.stretch, excess.limit),
                     as_given || hierarchy.is_subdivided()
                         ? "a start that is stretched less, or a higher `strain_limit`"
                         : "use fewer levels, more coarsest_vertices, or method `direct`");
}

Checkpoint StagedRun::fresh_progress(int level, double t, const Positions& x) const {
    Checkpoint progress;
    progress.level = level;
    progress.t = t;
    progress.positions = x;
    progress.settle_time_step = model().solve.time_step;
    progress.settle_tolerance = model().solve.tolerance;
    return progress;
}

bool StagedRun::bring_to_thickness() {
    const Checkpoint& progress = stepper_->progress();
    if (progress.step > 0 || progress.settle_step > 0)
        return true;
    const LevelStepper::Outcome outcome = stepper_->bring_to_thickness(progress.t);
    if (outcome == LevelStepper::Outcome::cut_short)
        fail(RunStatus::failed, fmt::format("level {} could not be brought out of its contact thickness", level()));
    return outcome == LevelStepper::Outcome::done;
}

void StagedRun::conclude_level() {
    stepper_->measure();
    log_.level_report(level()).reactions = reactions();
    log_.frame(level(), time(), level() == last_level_ ? "final" : "settle", stepper_->positions());
    Checkpoint& progress = stepper_->progress();
    progress.settled = true;
    progress.positions = stepper_->positions();
    log_.checkpoint(progress);
}

bool StagedRun::refine() {
    const Checkpoint& coarse = stepper_->progress();
    RefineResult refined =
        plisse::refine(discretization_, level(), stepper_->positions(), time(), context_, coarse.stiffness_factor);
    if (refined.cancelled)
        return false;
    report().refinements.push_back(refined.report);
    if (!refined.complete) {
        fail(RunStatus::not_converged, refined.message);
        return false;
    }
    log_.frame(level() + 1, time(), "refine", refined.positions);
    Checkpoint progress = fresh_progress(level() + 1, time(), refined.positions);
    progress.previews = coarse.previews;
    progress.previews.push_back(stepper_->positions());
    progress.stiffness_factor = coarse.stiffness_factor;
    log_.checkpoint(progress);
    enter(progress);
    return true;
}

void StagedRun::finish() {
    stepper_->measure();
    find_lagging();
    report().reactions = log_.level_report(level()).reactions;
    find_preview_distances();
    if (!report().lagging.empty())
        fail(RunStatus::not_converged, "a script could not be followed");
    if (report().intersecting_pairs > 0)
        fail(RunStatus::failed, "intersecting faces were found");
    fail(RunStatus::converged, "");
}

void StagedRun::find_lagging() {
    const int level = this->level();
    const HierarchyLevel& mesh = discretization_.mesh(level);
    const Positions script = discretization_.script(level, time());
    const double allowed = 1e-4 * bounding_box(mesh.rest).diagonal();
    std::vector<Lag> lags(model().handles.size() + model().obstacles.size());
    for (int v = 0; v < script.cols(); ++v) {
        Vec3 away = stepper_->positions().col(v) - script.col(v);
        for (int axis = 0; axis < 3; ++axis)
            if (!discretization_.layout(level).prescribed[at(3 * v + axis)])
                away[axis] = 0;
        if (away.norm() <= allowed)
            continue;
        const auto count = [&](std::size_t script_number) {
            Lag& lag = lags[script_number];
            ++lag.vertices;
            lag.distance = std::max(lag.distance, away.norm());
            if (lag.ranges.empty() || lag.ranges.back()[1] != v - 1)
                lag.ranges.push_back({v, v});
            lag.ranges.back()[1] = v;
        };
        for (int h : discretization_.handles_of(level, v))
            count(at(h));
        const int part = mesh.part[at(v)];
        if (model().is_obstacle(part))
            count(model().handles.size() + at(part) - model().bodies.size());
    }
    for (std::size_t s = 0; s < lags.size(); ++s) {
        lags[s].name =
            s < model().handles.size() ? model().handles[s].name : model().obstacles[s - model().handles.size()].name;
        if (lags[s].vertices > 0)
            log_.report().lagging.push_back(lags[s]);
    }
}

void StagedRun::find_preview_distances() {
    const std::vector<Positions>& previews = stepper_->progress().previews;
    for (std::size_t l = 0; l < previews.size(); ++l)
        log_.level_report(static_cast<int>(l)).to_final =
            preview_distance(discretization_, static_cast<int>(l), previews[l], stepper_->positions());
}

/// The gradient of the energy on the vertices of each handle and obstacle.
std::vector<Reaction> StagedRun::reactions() {
    const int level = this->level();
    const Positions x = stepper_->positions();
    const Positions holding = -stepper_->problem().forces(stepper_->unknowns()).total();
    std::vector<Reaction> reactions;
    for (const Handle& handle : model().handles)
        reactions.push_back({handle.name});
    for (const Obstacle& obstacle : model().obstacles)
        reactions.push_back({obstacle.name});
    const auto add = [&](std::size_t number, const Vec3& point, const Vec3& force) {
        reactions[number].force += force;
        reactions[number].torque += point.cross(force);
    };
    for (int v = 0; v < x.cols(); ++v) {
        for (int h : discretization_.handles_of(level, v)) {
            Vec3 force = holding.col(v);
            for (int axis = 0; axis < 3; ++axis)
                if (!model().handles[at(h)].axes[at(axis)])
                    force[axis] = 0;
            add(at(h), x.col(v), force);
        }
        const int part = discretization_.mesh(level).part[at(v)];
        if (model().is_obstacle(part))
            add(model().handles.size() + at(part) - model().bodies.size(), x.col(v), holding.col(v));
    }
    return reactions;
}

RunResult StagedRun::result() {
    return {report(), level(), stepper_->positions()};
}

Checkpoint StagedRun::state() {
    Checkpoint state = stepper_->progress();
    state.positions = stepper_->positions();
    state.frame_numbers = log_.frame_numbers();
    state.report = report();
    return state;
}

void StagedRun::restore(const Checkpoint& state, std::optional<Model> model) {
    if (model)
        take(std::move(*model));
    report() = state.report;
    log_.restore_frame_numbers(state.frame_numbers);
    enter(state);
}

void StagedRun::take(Model model) {
    stepper_.reset(); // it knows the model before
    discretization_.set_model(std::move(model));
    duration_ = timeline_end(this->model(), until_);
}

void StagedRun::set_model(Model model) {
    Checkpoint now = state();
    const double time_step_before = this->model().solve.time_step;
    take(std::move(model));
    const SolveSettings& solve = this->model().solve;
    if (level() == first_level_ && solve.time_step != time_step_before)
        now.step = static_cast<int>(std::floor(now.t / solve.time_step + 1e-9));
    now.settle_step = 0;
    now.settle_time_step = solve.time_step;
    now.settle_tolerance = solve.tolerance;
    now.settled = false;
    log_.level_report(now.level).equilibrium = false;
    enter(now);
}

} // namespace plisse
