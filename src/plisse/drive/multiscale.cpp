#include <plisse/drive/multiscale.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <plisse/drive/run_log.h>
#include <plisse/drive/surface_stepper.h>
#include <plisse/spatial/box.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

void append_obstacles(const SubdivisionModel& model, HierarchyLevel& level) {
    const auto first = static_cast<int>(level.rest.cols());
    Positions all(3, first + model.obstacles.vertex_count());
    all << level.rest, model.obstacles_at(0);
    level.rest = std::move(all);
    for (const Face& face : model.obstacles.faces)
        level.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
    for (const int obstacle : model.obstacle_of_vertex)
        level.part.push_back(1 + obstacle);
}

/// What frames show: every level's limit surface at its own vertices, and the obstacles.
Hierarchy limit_surfaces(const SubdivisionModel& model) {
    Hierarchy shown;
    for (int l = 0; l < model.levels.level_count(); ++l) {
        TriangleMesh surface = limit_surface(model.levels, l);
        HierarchyLevel& level = shown.levels.emplace_back();
        level.rest = std::move(surface.positions);
        level.faces = std::move(surface.faces);
        level.part.assign(static_cast<std::size_t>(level.rest.cols()), 0);
        append_obstacles(model, level);
    }
    return shown;
}

RunReport starting_report(const SubdivisionModel& model, const Checkpoint* resume) {
    if (resume)
        return resume->report;
    RunReport report;
    report.name = model.name;
    report.method = "rmtr";
    return report;
}

/// Steps the timeline in the finest level's variables; coarser levels are at work within each step.
class MultiscaleDriver {
public:
    MultiscaleDriver(const SubdivisionModel& model, const RunOptions& options, Recorder& recorder, Context& context);
    RunResult run();

private:
    void run_timeline();
    void settle();
    /// Solves a step from x_. False when the run was cancelled, and x_ is as before, or where obstacles do not get
    /// through to where the step has them.
    bool solve(const SurfaceStep& step, const char* phase, double fraction);
    void finish();
    void measure();
    void save(double t);
    void find_lagging();
    std::vector<Reaction> reactions();
    void fail(RunStatus status, const std::string& message);

    int step_count() const { return static_cast<int>(std::ceil(duration_ / settings_.time_step - 1e-9)); }
    int finest() const { return model_.levels.level_count() - 1; }
    /// As frames show it.
    Positions surface() const {
        Positions all = shown_.finest().rest;
        all.leftCols(model_.surface.vertex_count()) = stepper_.limit_points(x_);
        if (const Positions obstacles = stepper_.obstacles(); obstacles.cols() > 0)
            all.rightCols(obstacles.cols()) = obstacles;
        return all;
    }

    const SubdivisionModel& model_;
    const SolveSettings& settings_;
    Recorder& recorder_;
    Context& context_;
    double duration_;
    Hierarchy shown_;
    RunLog log_;
    SurfaceStepper stepper_;
    Checkpoint progress_;
    VecX x_;
    PhaseTimes times_at_start_;
    Stopwatch watch_;
};

MultiscaleDriver::MultiscaleDriver(const SubdivisionModel& model, const RunOptions& options, Recorder& recorder,
                                   Context& context)
    : model_(model), settings_(model.solve), recorder_(recorder), context_(context),
      duration_(options.until >= 0 ? std::min(options.until, settings_.duration) : settings_.duration),
      shown_(limit_surfaces(model)), log_(shown_, 1, {shape_scale(model.surface.positions, model.surface.faces)},
                                          recorder, context, starting_report(model, options.resume)),
      stepper_(model, context), times_at_start_(context.times) {
    if (options.resume) {
        progress_ = *options.resume;
        log_.restore_frame_numbers(progress_.frame_numbers);
    } else {
        progress_.level = finest();
        progress_.positions = model.levels.rest(finest());
    }
    x_ = as_vector(progress_.positions);
    stepper_.place_obstacles(progress_.t);
}

void MultiscaleDriver::fail(RunStatus status, const std::string& message) {
    RunReport& report = log_.report();
    if (report.status == RunStatus::running)
        report.status = status;
    if (!message.empty())
        report.message += (report.message.empty() ? "" : "; ") + message;
}

bool MultiscaleDriver::solve(const SurfaceStep& step, const char* phase, double fraction) {
    const VecX before = x_;
    LevelReport& report = log_.level_report(finest());
    int count = 0;
    const SurfaceOutcome outcome = stepper_.solve(step, x_, [&](const SurfaceIteration& iteration) {
        IterationRecord record;
        record.level = iteration.level;
        record.step = progress_.step;
        record.iteration = ++count;
        record.t = step.t;
        record.energy = iteration.value;
        record.step_norm = iteration.gradient_norm;
        record.step_length = iteration.radius;
        record.seconds = log_.seconds();
        log_.iteration(record);
        context_.on_progress({iteration.level, finest() + 1, phase, step.t, duration_, progress_.step, count,
                              iteration.gradient_norm, 0, fraction});
    });
    report.newton_iterations += outcome.iterations;
    report.work.resize(outcome.work.size());
    for (std::size_t l = 0; l < outcome.work.size(); ++l)
        report.work[l] += outcome.work[l];
    if (outcome.end == TrustRegionEnd::interrupted) {
        x_ = before;
        return false;
    }
    ++report.steps;
    report.equilibrium = is_converged(outcome.end);
    if (!report.equilibrium)
        fail(RunStatus::not_converged, fmt::format("t = {:.4g} s: {}", step.t, outcome.message));
    return stepper_.obstacles() == model_.obstacles_at(step.t);
}

void MultiscaleDriver::run_timeline() {
    const int steps = step_count();
    if (progress_.step == 0)
        log_.frame(finest(), 0, "preview", surface());
    while (progress_.step < steps) {
        const double t_before = std::min(progress_.step * settings_.time_step, duration_);
        SurfaceStep step;
        step.t = std::min((progress_.step + 1) * settings_.time_step, duration_);
        step.grips = progress_.friction.reference.cols() == 0;
        const Positions before = as_positions(x_);
        if (settings_.dynamics) {
            step.time_step = step.t - t_before;
            step.inertial = before;
            if (progress_.velocity.cols() > 0)
                step.inertial += step.time_step * progress_.velocity;
        }
        if (!solve(step, "preview", static_cast<double>(progress_.step) / steps))
            return;
        progress_.velocity = (as_positions(x_) - before) / (step.t - t_before);
        progress_.friction = stepper_.friction_memory();
        ++progress_.step;
        const double interval = settings_.frame_interval;
        if (std::floor(step.t / interval + 1e-9) > std::floor(t_before / interval + 1e-9) || progress_.step == steps)
            log_.frame(finest(), step.t, "preview", surface());
        save(step.t);
    }
}

void MultiscaleDriver::settle() {
    SurfaceStep step;
    step.t = duration_;
    step.rubbing = progress_.friction;
    step.grips = progress_.friction.reference.cols() == 0;
    if (!solve(step, "settle", 1))
        return;
    progress_.settled = true;
    save(duration_);
}

void MultiscaleDriver::save(double t) {
    progress_.t = t;
    progress_.positions = as_positions(x_);
    measure();
    log_.checkpoint(progress_);
}

void MultiscaleDriver::measure() {
    LevelReport& report = log_.level_report(finest());
    const SubdivisionProblem::Energies energies = stepper_.finest().energies(x_);
    report.energy.elastic = energies.elastic;
    report.energy.gravity = energies.gravity;
    report.energy.contact = energies.contact;
    report.energy.friction = energies.friction;
    LevelContact* contact = stepper_.finest().contact();
    report.min_gap = contact ? contact->min_gap(as_positions(x_)) : std::numeric_limits<double>::infinity();
    report.max_stretch = stepper_.finest().largest_stretch(x_);
    report.residual = stepper_.finest().residual(x_);
    report.reactions = reactions();
    report.total_seconds += watch_.seconds();
    watch_ = Stopwatch();
    const PhaseTimes& now = context_.times;
    double known = 0;
    for (int p = 0; p < phase_count; ++p) {
        const auto phase = static_cast<Phase>(p);
        report.seconds[phase] += now[phase] - times_at_start_[phase];
        known += report.seconds[phase];
    }
    times_at_start_ = now;
    report.seconds[Phase::other] += std::max(0.0, report.total_seconds - known);
}

std::vector<Reaction> MultiscaleDriver::reactions() {
    std::vector<Reaction> reactions;
    for (const BoundaryHandle& handle : model_.handles)
        reactions.push_back({handle.name});
    const SubdivisionProblem::Holding holding = stepper_.finest().holding(x_);
    const std::vector<int>& handle_of = stepper_.finest().handle_of_place();
    for (Eigen::Index p = 0; p < holding.places.cols(); ++p) {
        Reaction& reaction = reactions[at(handle_of[static_cast<std::size_t>(p)])];
        const Vec3 force = holding.forces.col(p);
        reaction.force += force;
        reaction.torque += holding.places.col(p).cross(force);
    }
    return reactions;
}

void MultiscaleDriver::find_lagging() {
    const double allowed = 1e-4 * bounding_box(model_.surface.positions).diagonal();
    const std::vector<double> away = stepper_.finest().away_from_targets(x_);
    const std::vector<int>& handle_of = stepper_.finest().handle_of_place();
    for (std::size_t h = 0; h < model_.handles.size(); ++h) {
        Lag lag;
        lag.name = model_.handles[h].name;
        for (std::size_t p = 0; p < away.size(); ++p)
            if (handle_of[p] == static_cast<int>(h) && away[p] > allowed) {
                ++lag.vertices;
                lag.distance = std::max(lag.distance, away[p]);
            }
        if (lag.vertices > 0)
            log_.report().lagging.push_back(lag);
    }
    if (!log_.report().lagging.empty())
        fail(RunStatus::not_converged, "a script could not be followed: a larger solve.rmtr.penalty holds more firmly");
}

void MultiscaleDriver::finish() {
    log_.frame(finest(), duration_, "final", surface());
    SurfaceStep end;
    end.t = duration_;
    stepper_.begin_step(end); // a resumed run may have had nothing left to solve
    if (log_.level_report(finest()).steps == 0)
        measure();
    find_lagging();
    log_.report().reactions = log_.level_report(finest()).reactions;
    if (log_.report().intersecting_pairs > 0)
        fail(RunStatus::failed, "intersecting faces were found");
    fail(RunStatus::converged, "");
}

RunResult MultiscaleDriver::run() {
    recorder_.on_hierarchy(shown_);
    log_.report().status = RunStatus::running;
    log_.publish();
    run_timeline();
    if (settings_.settle && !progress_.settled && progress_.step == step_count() && !context_.cancelled())
        settle();
    if (context_.cancelled())
        fail(RunStatus::interrupted, "interrupted");
    else
        finish();
    log_.publish();
    return {log_.report(), finest(), surface()};
}

} // namespace

RunResult run_multiscale(const SubdivisionModel& model, const RunOptions& options, Recorder& recorder,
                         Context& context) {
    return MultiscaleDriver(model, options, recorder, context).run();
}

} // namespace plisse
