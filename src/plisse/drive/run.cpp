#include <plisse/drive/run.h>

#include <algorithm>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <plisse/base/error.h>
#include <plisse/drive/level_stepper.h>
#include <plisse/drive/refine.h>
#include <plisse/mesh/intersecting_surfaces.h>
#include <plisse/model/strain_limit.h>
#include <plisse/spatial/box.h>
#include <plisse/spatial/intersections.h>

namespace plisse {

namespace {

using Outcome = LevelStepper::Outcome;

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

/// Steps the timeline on the first level, then refines level by level to the last. `direct` has one level only.
class Driver {
public:
    Driver(const Model& model, const RunOptions& options, Recorder& recorder, Context& context);
    RunResult run();

private:
    bool simulate();
    bool run_level(LevelStepper& stepper);
    std::optional<Positions> refine_from(const Checkpoint& coarse);
    void check_start(const Positions& x) const;
    void check_limits(int level, const Positions& x) const;
    void finish(LevelStepper& stepper);
    void find_lagging(LevelStepper& stepper);
    void find_preview_distances(const Checkpoint& finest);
    std::vector<Reaction> reactions_of(LevelStepper& stepper) const;
    Checkpoint fresh_progress(int level, const Positions& x) const;
    void fail(RunStatus status, const std::string& message);

    const Model& model_;
    Recorder& recorder_;
    Context& context_;
    const Checkpoint* resume_;
    double duration_;
    Discretization discretization_;
    RunLog log_;
    int first_level_, last_level_;
    RunResult result_;
};

RunReport starting_report(const Model& model, const RunOptions& options) {
    if (options.resume)
        return options.resume->report;
    RunReport report;
    report.name = model.name;
    report.method = is_direct(model) ? "direct" : "progressive";
    return report;
}

Driver::Driver(const Model& model, const RunOptions& options, Recorder& recorder, Context& context)
    : model_(model), recorder_(recorder), context_(context), resume_(options.resume),
      duration_(options.until >= 0 ? std::min(options.until, model.solve.duration) : model.solve.duration),
      discretization_(model, levels_needed(model), context, options.hierarchies),
      log_(discretization_.hierarchy(), static_cast<int>(model.bodies.size()), governing_scales(model), recorder,
           context, starting_report(model, options)),
      first_level_(is_direct(model) ? model.solve.level.value_or(discretization_.finest()) : 0),
      last_level_(is_direct(model) ? first_level_ : discretization_.finest()) {
    if (first_level_ > discretization_.finest())
        throw InputError(model.name,
                         fmt::format("level {} was asked for, but there are only levels 0 to {}", first_level_,
                                     discretization_.finest()),
                         "a smaller level, or more hierarchy.levels");
    if (resume_)
        log_.restore_frame_numbers(resume_->frame_numbers);
}

void Driver::fail(RunStatus status, const std::string& message) {
    RunReport& report = log_.report();
    if (report.status == RunStatus::running)
        report.status = status;
    if (!message.empty())
        report.message += (report.message.empty() ? "" : "; ") + message;
}

void Driver::check_start(const Positions& x) const {
    const std::vector<int>& part = discretization_.layout(first_level_).face_part;
    const auto both_obstacles = [&](int a, int b) {
        return model_.is_obstacle(part[at(a)]) && model_.is_obstacle(part[at(b)]);
    };
    const auto& faces = discretization_.mesh(first_level_).faces;
    const auto pairs = intersecting_pairs(x, faces, both_obstacles);
    if (pairs.empty())
        return;
    const Vec3 place = meeting_place(x, faces[at(pairs.front()[0])], faces[at(pairs.front()[1])]);
    const InputError error(
        model_.name,
        fmt::format("{} pairs of faces of level {} intersect at the start, the first near ({:.6g}, {:.6g}, {:.6g})",
                    pairs.size(), first_level_, place.x(), place.y(), place.z()),
        "surfaces may not touch");
    throw IntersectingSurfaces(error, x, faces, pairs, part);
}

void Driver::check_limits(int level, const Positions& x) const {
    const StrainLimit::Excess excess = StrainLimit(discretization_, level).excess(x, 2 * StrainLimitEnergy::least_room);
    if (excess.faces == 0)
        return;
    const Hierarchy& hierarchy = discretization_.hierarchy();
    const bool as_given = level == hierarchy.input_level();
    throw InputError(model_.name,
                     fmt::format("{} faces{} are stretched beyond their strain limit at the start: one of \"{}\" near "
                                 "({:.6g}, {:.6g}, {:.6g}) to {:.6g}, and its limit is {:.6g}",
                                 excess.faces, as_given ? "" : fmt::format(" of level {}", level),
                                 model_.bodies[at(excess.body)].name, excess.place.x(), excess.place.y(),
                                 excess.place.z(), excess.stretch, excess.limit),
                     as_given || hierarchy.is_subdivided()
                         ? "a start that is stretched less, or a higher `strain_limit`"
                         : "use fewer levels, more coarsest_vertices, or method `direct`");
}

Checkpoint Driver::fresh_progress(int level, const Positions& x) const {
    Checkpoint progress;
    progress.level = level;
    progress.t = duration_;
    progress.positions = x;
    progress.settle_time_step = model_.solve.time_step;
    progress.settle_tolerance = model_.solve.tolerance;
    return progress;
}

/// Timeline (first level only), then equilibrium. False when the run cannot or shall not go on.
bool Driver::run_level(LevelStepper& stepper) {
    const int level = stepper.progress().level;
    Checkpoint& progress = stepper.progress();
    if (progress.step == 0 && progress.settle_step == 0) {
        const Outcome outcome = stepper.bring_to_thickness(progress.t);
        if (outcome == Outcome::cut_short)
            fail(RunStatus::failed, fmt::format("level {} could not be brought out of its contact thickness", level));
        if (outcome != Outcome::done)
            return false;
    }
    if (level == first_level_ && progress.settle_step == 0) {
        const Outcome outcome = stepper.run_timeline(duration_);
        if (outcome == Outcome::cancelled)
            return false;
        if (outcome != Outcome::done && level == last_level_)
            fail(RunStatus::not_converged,
                 fmt::format("a step of the timeline {} ({})",
                             outcome == Outcome::stalled ? "stalled" : "was cut short", stepper.trouble()));
    }
    const Outcome outcome = model_.solve.settle     ? stepper.settle(duration_)
                            : level == first_level_ ? Outcome::done
                                                    : stepper.step_once(duration_);
    if (outcome == Outcome::cancelled)
        return false;
    if (outcome != Outcome::done && (model_.solve.settle || level == last_level_))
        fail(RunStatus::not_converged, fmt::format("level {} did not reach equilibrium{}", level,
                                                   stepper.trouble().empty() ? "" : " (" + stepper.trouble() + ")"));
    stepper.measure();
    log_.level_report(level).reactions = reactions_of(stepper);
    log_.frame(level, duration_, level == last_level_ ? "final" : "settle", stepper.positions());
    progress.settled = true;
    progress.positions = stepper.positions();
    log_.checkpoint(progress);
    return true;
}

std::optional<Positions> Driver::refine_from(const Checkpoint& coarse) {
    RefineResult refined =
        refine(discretization_, coarse.level, coarse.positions, duration_, context_, coarse.stiffness_factor);
    if (refined.cancelled)
        return std::nullopt;
    log_.report().refinements.push_back(refined.report);
    if (!refined.complete) {
        fail(RunStatus::not_converged, refined.message);
        return std::nullopt;
    }
    return refined.positions;
}

/// True when the last level was reached and stepped.
bool Driver::simulate() {
    Checkpoint progress;
    if (resume_) {
        progress = *resume_;
    } else {
        progress = fresh_progress(first_level_, discretization_.start(first_level_));
        progress.t = 0;
        check_start(progress.positions);
        const int input_level = discretization_.hierarchy().input_level();
        check_limits(input_level, discretization_.start(input_level));
        check_limits(first_level_, progress.positions);
    }
    for (int level = progress.level;; ++level) {
        const EnergiesOf energies = is_direct(model_) ? EnergiesOf::level : EnergiesOf::finest;
        LevelStepper stepper(discretization_, level, energies, level == last_level_, log_);
        stepper.start_from(progress);
        result_.level = level;
        const bool goes_on = progress.settled || run_level(stepper);
        result_.positions = stepper.positions();
        if (!goes_on)
            return false;
        if (level == last_level_) {
            finish(stepper);
            return true;
        }
        const std::optional<Positions> refined = refine_from(stepper.progress());
        if (!refined)
            return false;
        log_.frame(level + 1, duration_, "refine", *refined);
        std::vector<Positions> previews = std::move(stepper.progress().previews);
        previews.push_back(stepper.positions());
        const double stiffness_factor = stepper.progress().stiffness_factor;
        progress = fresh_progress(level + 1, *refined);
        progress.previews = std::move(previews);
        progress.stiffness_factor = stiffness_factor;
        result_.level = level + 1;
        result_.positions = *refined;
        log_.checkpoint(progress);
    }
}

void Driver::finish(LevelStepper& stepper) {
    stepper.measure();
    find_lagging(stepper);
    log_.report().reactions = log_.level_report(result_.level).reactions;
    find_preview_distances(stepper.progress());
    if (!log_.report().lagging.empty())
        fail(RunStatus::not_converged, "a script could not be followed");
    if (log_.report().intersecting_pairs > 0)
        fail(RunStatus::failed, "intersecting faces were found");
    fail(RunStatus::converged, "");
}

void Driver::find_lagging(LevelStepper& stepper) {
    const int level = result_.level;
    const HierarchyLevel& mesh = discretization_.mesh(level);
    const Positions script = discretization_.script(level, duration_);
    const double allowed = 1e-4 * bounding_box(mesh.rest).diagonal();
    std::vector<Lag> lags(model_.handles.size() + model_.obstacles.size());
    for (int v = 0; v < script.cols(); ++v) {
        Vec3 away = stepper.positions().col(v) - script.col(v);
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
        if (model_.is_obstacle(part))
            count(model_.handles.size() + at(part) - model_.bodies.size());
    }
    for (std::size_t s = 0; s < lags.size(); ++s) {
        lags[s].name =
            s < model_.handles.size() ? model_.handles[s].name : model_.obstacles[s - model_.handles.size()].name;
        if (lags[s].vertices > 0)
            log_.report().lagging.push_back(lags[s]);
    }
}

void Driver::find_preview_distances(const Checkpoint& finest) {
    for (std::size_t level = 0; level < finest.previews.size(); ++level)
        log_.level_report(static_cast<int>(level)).to_final =
            preview_distance(discretization_, static_cast<int>(level), finest.previews[level], result_.positions);
}

/// The gradient of the energy on the vertices of each handle and obstacle.
std::vector<Reaction> Driver::reactions_of(LevelStepper& stepper) const {
    const int level = stepper.progress().level;
    const Positions x = stepper.positions();
    const Positions holding = -stepper.problem().forces(stepper.unknowns()).total();
    std::vector<Reaction> reactions;
    for (const Handle& handle : model_.handles)
        reactions.push_back({handle.name});
    for (const Obstacle& obstacle : model_.obstacles)
        reactions.push_back({obstacle.name});
    const auto add = [&](std::size_t number, const Vec3& point, const Vec3& force) {
        reactions[number].force += force;
        reactions[number].torque += point.cross(force);
    };
    for (int v = 0; v < x.cols(); ++v) {
        for (int h : discretization_.handles_of(level, v)) {
            Vec3 force = holding.col(v);
            for (int axis = 0; axis < 3; ++axis)
                if (!model_.handles[at(h)].axes[at(axis)])
                    force[axis] = 0;
            add(at(h), x.col(v), force);
        }
        const int part = discretization_.mesh(level).part[at(v)];
        if (model_.is_obstacle(part))
            add(model_.handles.size() + at(part) - model_.bodies.size(), x.col(v), holding.col(v));
    }
    return reactions;
}

RunResult Driver::run() {
    recorder_.on_hierarchy(discretization_.hierarchy());
    log_.report().status = RunStatus::running;
    log_.publish();
    if (!simulate() && log_.report().status == RunStatus::running)
        fail(RunStatus::interrupted, "interrupted");
    log_.publish();
    result_.report = log_.report();
    return result_;
}

} // namespace

RunResult run(const Model& model, const RunOptions& options, Recorder& recorder, Context& context) {
    return Driver(model, options, recorder, context).run();
}

} // namespace plisse
