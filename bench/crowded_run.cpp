#include "crowded_run.h"

#include <ctime>

#include <plisse/base/parallel.h>
#include <plisse/model/shell_problem.h>
#include <plisse/scene/build_model.h>
#include <plisse/solve/newton.h>

#include "bench_scenes.h"

namespace plisse {

namespace {

/// A problem that notes in a run what the solver asks of it.
class RecordedProblem : public Objective {
public:
    RecordedProblem(ShellProblem& problem, CrowdedRun& run) : problem_(problem), run_(run) {}

    double value(const VecX& x) override {
        if (!run_.queries.empty())
            run_.queries.back().trials.push_back(as_positions(x));
        return problem_.value(x);
    }
    double round_off() const override { return problem_.round_off(); }
    void gradient(const VecX& x, VecX& gradient) override { problem_.gradient(x, gradient); }
    void assemble(const VecX& x, NewtonSystem& system, bool project) override {
        ++(project ? run_.projected_hessians : run_.exact_hessians);
        problem_.assemble(x, system, project);
    }
    NewtonSystem& system() override { return problem_.system(); }
    const VecX& targets() const override { return problem_.targets(); }
    double max_step(const VecX& x, const VecX& d) override {
        run_.queries.push_back({as_positions(x), as_positions(d), {}});
        return problem_.max_step(x, d);
    }

private:
    ShellProblem& problem_;
    CrowdedRun& run_;
};

/// Adds one step to time t to the run.
void record_step(ShellProblem& problem, VecX& x, double t, double h, CrowdedRun& run, Context& context) {
    const Positions start = as_positions(x);
    problem.begin_step(start, start, t, h);
    NewtonOptions options;
    options.tolerance = 1e-3 * h;
    RecordedProblem recorded(problem, run);
    LinearSolver solver;
    run.iterations += minimize(recorded, solver, x, options, context).iterations;
}

CrowdedRun record_run() {
    const ThreadLimit one_thread(1);
    Context context;
    Scene scene = bench_scene("twist", true);
    scene.bodies.front().mesh.generator.edge_length = 0.03;
    const Model model = build_model(scene, context);
    const Discretization discretization(model, 1, context);
    ShellProblem problem(discretization, 0, EnergiesOf::level, context);
    VecX x = as_vector(discretization.start(0));

    CrowdedRun run;
    const HierarchyLevel& mesh = discretization.mesh(0);
    run.mesh = CollisionMesh(mesh.rest, mesh.faces, mesh.part, {0});
    run.options.distance = model.contact.distance;
    const double h = 2 * model.solve.time_step;
    const int steps = static_cast<int>(model.solve.duration / h + 0.5), first_recorded = 3 * steps / 4;
    std::clock_t start = 0;
    for (int step = 0; step < steps; ++step) {
        if (step == first_recorded) {
            run.queries.clear();
            run.iterations = run.projected_hessians = run.exact_hessians = 0;
            context.times = {};
            start = std::clock();
        }
        record_step(problem, x, (step + 1) * h, h, run, context);
    }
    run.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / run.iterations;
    run.phases = context.times;
    return run;
}

} // namespace

const CrowdedRun& crowded_run() {
    static const CrowdedRun recorded = record_run();
    return recorded;
}

} // namespace plisse
