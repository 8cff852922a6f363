#include <gtest/gtest.h>

#include <plisse/base/parallel.h>
#include <plisse/drive/multiscale.h>
#include <plisse/drive/surface_stepper.h>

#include "../model/cloth_models.h"
#include "small_models.h"
#include "witness.h"

namespace plisse {
namespace {

RunResult run_cloth(const SubdivisionModel& model, const RunOptions& options = {}) {
    Context context;
    Recorder recorder;
    return run_multiscale(model, options, recorder, context);
}

double energy_of(const SubdivisionModel& model, SurfaceOutcome* outcome = nullptr) {
    Context context;
    SurfaceStepper stepper(model, context);
    SurfaceStep step;
    step.t = step.time_step = 1;
    step.inertial = model.levels.rest(model.levels.level_count() - 1);
    VecX x = as_vector(step.inertial);
    const SurfaceOutcome end = stepper.solve(step, x);
    EXPECT_TRUE(is_converged(end.end)) << end.message;
    if (outcome)
        *outcome = end;
    return stepper.finest().value(x);
}

/// Where the middle of the sheet ends.
double height_of_middle(const SubdivisionModel& model, const Positions& surface) {
    Eigen::Index middle = 0;
    model.surface.positions.colwise().squaredNorm().minCoeff(&middle);
    return surface(1, middle);
}

/// Acceptance 8 of the specification.
TEST(Multiscale, TrampolinesSagAsTheirSpecificationSays) {
    const std::array table{-0.05641, -0.03021, -0.02735};
    for (int levels = 1; levels <= 3; ++levels) {
        SubdivisionModel model = square_metre(levels, MaterialLaw::denim_table, anywhere);
        model.solve.rmtr.solver = SurfaceSolver::trust_region;
        const RunResult result = run_cloth(model);
        EXPECT_NEAR(height_of_middle(model, result.positions), table[static_cast<std::size_t>(levels - 1)], 1e-5);
        EXPECT_TRUE(result.report.levels.front().equilibrium);
        EXPECT_LE(result.report.levels.front().newton_iterations, 20);
        if (levels == 3) {
            EXPECT_NEAR(energy_of(model), -0.0390126, 1e-7);
        }
    }
    const SubdivisionModel stable = square_metre(3, MaterialLaw::denim_stable, anywhere);
    EXPECT_NEAR(height_of_middle(stable, run_cloth(stable).positions), -0.029235, 1e-5);
}

/// The rest of acceptance 8.
TEST(Multiscale, FineTrampolinesSagAsTheirSpecificationSays) {
    for (int levels = 4; levels <= 5; ++levels) {
        const SubdivisionModel model = square_metre(levels, MaterialLaw::denim_table, anywhere);
        EXPECT_NEAR(height_of_middle(model, run_cloth(model).positions), -0.02724, 1e-5);
    }
}

/// Acceptance 9.
TEST(Multiscale, DroopingSheetsHaveTheEnergyOfTheirSpecification) {
    const std::array energies{-0.48347, -0.46276};
    for (int levels = 1; levels <= 2; ++levels) {
        SubdivisionModel model = square_metre(levels, MaterialLaw::denim_stable, on_two_sides);
        model.solve.rmtr.solver = SurfaceSolver::trust_region;
        SurfaceOutcome outcome;
        EXPECT_NEAR(energy_of(model, &outcome), energies[static_cast<std::size_t>(levels - 1)], 1e-4);
        EXPECT_LE(outcome.iterations, 200);
        EXPECT_LT(run_cloth(model).report.levels.front().max_stretch, std::sqrt(1 + 2 * 0.05));
    }
}

/// Acceptance 10, in part: the smoother of the specification on all levels.
TEST(Multiscale, BlockJacobiTakesFewCyclesOnEveryLevel) {
    for (int levels = 2; levels <= 4; ++levels) {
        SubdivisionModel model = square_metre(levels, MaterialLaw::denim_table, anywhere);
        model.solve.rmtr.finest_smoother = SurfaceSmoother::block_jacobi;
        SurfaceOutcome outcome;
        energy_of(model, &outcome);
        EXPECT_LE(outcome.iterations, 15);
    }
}

TEST(Multiscale, AllLevelsTogetherFindTheMinimumOfTheFinestAlone) {
    for (int levels = 2; levels <= 3; ++levels) {
        SubdivisionModel model = square_metre(levels, MaterialLaw::denim_table, anywhere);
        SurfaceOutcome cycles;
        const double by_levels = energy_of(model, &cycles);
        EXPECT_LE(cycles.iterations, 15);
        model.solve.rmtr.solver = SurfaceSolver::trust_region;
        EXPECT_NEAR(by_levels, energy_of(model), 1e-8);
    }
}

/// A sheet that turns down by a right angle; the paper takes 4,671 and 645 cycles.
TEST(Multiscale, LargeRotationsTakeFewCycles) {
    for (int levels = 2; levels <= 3; ++levels) {
        SurfaceOutcome cycles;
        const double energy = energy_of(square_metre(levels, MaterialLaw::denim_stable, on_two_sides), &cycles);
        EXPECT_LE(cycles.iterations, 60);
        EXPECT_LT(cycles.gradient_norm, 1e-7);
        if (levels == 2) {
            EXPECT_NEAR(energy, -0.46276, 1e-4);
        }
    }
}

TEST(Multiscale, HandlesCarryTheWeight) {
    SubdivisionModel model = square_metre(3, MaterialLaw::denim_stable, anywhere);
    model.solve.dynamics = false;
    const RunResult result = run_cloth(model);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    ASSERT_EQ(result.report.reactions.size(), 1u);
    EXPECT_LT((result.report.reactions[0].force - Vec3(0, 0.4 * 9.81, 0)).norm(), 1e-6);
    EXPECT_LT(result.report.levels.front().residual, 1e-6);
}

TEST(Multiscale, ClothLiesOnTheGroundWithoutTouchingIt) {
    for (const double thickness : {0.0, 3e-3}) {
        SubdivisionModel model = square_metre(2, MaterialLaw::denim_stable, anywhere);
        model.contact.self = true;
        model.contact.distance = 4e-3;
        model.contact.thickness = thickness;
        model.solve.rmtr.penalty = 1e6;
        add_ground(model, -0.01);
        Context context;
        Witness witness;
        const RunResult result = run_multiscale(model, {}, witness, context);
        EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        EXPECT_EQ(witness.intersections, 0);
        EXPECT_GT(result.report.levels.front().energy.contact, 0);
        EXPECT_GT(result.report.levels.front().min_gap, 0);
        EXPECT_GT(height_of_middle(model, result.positions), -0.01 + thickness);
        EXPECT_LT(height_of_middle(model, result.positions), -0.01 + thickness + 4e-3);
        EXPECT_LT(result.report.levels.front().residual, 1e-5);
    }
}

TEST(Multiscale, NoSolverLeadsThroughTheGround) {
    for (const SurfaceSolver solver : {SurfaceSolver::rmtr, SurfaceSolver::trust_region, SurfaceSolver::newton,
                                       SurfaceSolver::damped_newton, SurfaceSolver::linearised}) {
        SubdivisionModel model = square_metre(2, MaterialLaw::denim_stable, on_two_sides);
        model.contact.distance = 4e-3;
        model.solve.rmtr.solver = solver;
        model.solve.rmtr.max_cycles = 20;
        add_ground(model, -0.01);
        Context context;
        Witness witness;
        const RunResult result = run_multiscale(model, {}, witness, context);
        EXPECT_EQ(witness.intersections, 0);
        EXPECT_GT(height_of_middle(model, result.positions), -0.01);
    }
}

/// A loose sheet on a slope, of which gravity's direction makes one.
SubdivisionModel sheet_on_a_slope(double friction, double slope) {
    SubdivisionModel model = square_metre(1, MaterialLaw::denim_stable, nowhere);
    model.contact.distance = 2e-3;
    model.contact.friction = friction;
    model.contact.friction_velocity = 1e-4;
    add_ground(model, -1e-3, 5);
    model.gravity.keys = {{0, Vec3(0, -9.81, 0)}, {0.25, Vec3(0, -9.81, 0)}, {0.2501, 9.81 * Vec3(slope, -1, 0)}};
    model.solve.time_step = 0.05;
    model.solve.duration = 0.5;
    return model;
}

/// Coulomb's law: a sheet whose friction is less than the slope falls with the rest of gravity, others stay.
TEST(Multiscale, SheetsSlideDownSlopesThatAreTooSteepForTheirFriction) {
    constexpr double slope = 0.3;
    for (const double friction : {0.2, 0.4}) {
        const SubdivisionModel model = sheet_on_a_slope(friction, slope);
        Context context;
        Witness witness;
        const RunResult result = run_multiscale(model, {}, witness, context);
        EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        EXPECT_EQ(witness.intersections, 0);
        const Positions moved = result.positions.leftCols(model.surface.vertex_count()) - model.surface.positions;
        const double h = model.solve.time_step, acceleration = 9.81 * std::max(0.0, slope - friction);
        const double steps = 5; // that it slides: implicit Euler's way is h^2 a (1 + 2 + ... )
        EXPECT_NEAR(moved.row(0).mean(), h * h * acceleration * steps * (steps + 1) / 2, 5e-4);
    }
}

TEST(Multiscale, ClothGivesWayToGroundThatRises) {
    SubdivisionModel model = square_metre(2, MaterialLaw::denim_stable, anywhere);
    model.contact.distance = 4e-3;
    model.solve.rmtr.penalty = 1e6;
    model.solve.time_step = 0.5;
    add_ground(model, -0.05);
    model.obstacle_motions[0].translate.keys = {{0, Vec3::Zero()}, {1, Vec3(0, 0.1, 0)}};
    Context context;
    Witness witness;
    const RunResult result = run_multiscale(model, {}, witness, context);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    EXPECT_EQ(witness.intersections, 0);
    EXPECT_EQ(result.positions.rightCols(3), model.obstacles_at(1));
    EXPECT_GT(height_of_middle(model, result.positions), 0.05);
}

TEST(Multiscale, SaysWhichObstacleIsHeldUp) {
    SubdivisionModel model = square_metre(1, MaterialLaw::denim_stable, anywhere);
    model.contact.distance = 4e-3;
    add_ground(model, 0.05);
    add_ground(model, -0.05);
    model.obstacle_names = {"ceiling", "floor"};
    model.obstacle_motions[1].translate.keys = {{0, Vec3::Zero()}, {1, Vec3(0, 0.2, 0)}};
    Context context;
    Witness witness;
    const RunResult result = run_multiscale(model, {}, witness, context);
    EXPECT_EQ(result.report.status, RunStatus::not_converged);
    EXPECT_EQ(witness.intersections, 0);
    EXPECT_NE(result.report.message.find("is held up by the cloth at"), std::string::npos) << result.report.message;
    EXPECT_LT(result.positions(1, result.positions.cols() - 1), 0.05);
}

/// Where a coarse level led the sheet around a ball, the straight way from its place at rest leads through it.
TEST(Multiscale, NestedIterationGoesOnFromWhereACoarseLevelEnded) {
    SubdivisionModel model = square_metre(2, MaterialLaw::denim_stable, nowhere);
    for (const double side : {-0.5, 0.5}) {
        BoundaryHandle corner;
        Eigen::Index nearest = 0;
        (model.surface.positions.colwise() - Vec3(side, 0, -0.5)).colwise().norm().minCoeff(&nearest);
        corner.points = {static_cast<int>(nearest)};
        corner.motion.translate = Track<Vec3>(Vec3(-0.4 * side, 0, 0));
        model.handles.push_back(corner);
    }
    model.contact.distance = 4e-3;
    model.solve.rmtr.max_cycles = 50; // of each level; it then slides over the ball
    add_ball(model, {0, -0.25, 0}, 0.2);
    Context context;
    SurfaceStepper stepper(model, context);
    SurfaceStep step;
    step.t = step.time_step = 1;
    step.inertial = model.levels.rest(1);
    VecX x = as_vector(step.inertial);
    std::vector<SurfaceIteration> first, last; // of each level
    stepper.solve(step, x, [&](const SurfaceIteration& iteration) {
        if (first.empty() || first.back().level != iteration.level) {
            first.push_back(iteration);
            last.emplace_back();
        }
        last.back() = iteration;
    });
    ASSERT_EQ(first.size(), 2u);
    EXPECT_LT(first[1].value, last[0].value + 0.1 * std::abs(last[0].value));
}

/// The method's smooth sheet and a mesh of triangles, hung by one side.
TEST(Multiscale, HungSheetsAgreeWithTriangles) {
    Material material;
    material.bending = BendingModel::koiter;
    const auto on_left = [](const Vec3& p) { return p.x() < -0.499; };

    SubdivisionModel smooth = square_metre(3, MaterialLaw::isotropic, on_left);
    smooth.material = material;
    smooth.solve.duration = 0;
    smooth.solve.settle = true;
    const RunResult by_surface = run_cloth(smooth);
    EXPECT_EQ(by_surface.report.status, RunStatus::converged) << by_surface.report.message;

    Model triangles = empty_model("hung");
    add_body(triangles, "cloth", material, sheet_mesh(1, 0.06));
    Handle left;
    left.name = "left";
    for (int v = 0; v < triangles.mesh.vertex_count(); ++v)
        if (on_left(triangles.mesh.positions.col(v)))
            left.vertices.push_back(v);
    triangles.handles.push_back(left);
    triangles.hierarchy.levels = 1;
    triangles.contact.self = false;
    triangles.solve.duration = 0;
    Witness witness;
    const RunResult by_triangles = run_to_end(triangles, witness);
    EXPECT_EQ(by_triangles.report.status, RunStatus::converged);

    const double lowest = by_surface.positions.row(1).minCoeff();
    EXPECT_LT(lowest, -1.001) << "its weight stretches it";
    EXPECT_NEAR(lowest, by_triangles.positions.row(1).minCoeff(), 0.005 * std::abs(lowest));
}

TEST(Multiscale, GivesTheSameBitsForAnyNumberOfThreads) {
    const SubdivisionModel model = square_metre(3, MaterialLaw::denim_stable, anywhere);
    Positions one, two;
    {
        const ThreadLimit limit(1);
        one = run_cloth(model).positions;
    }
    {
        const ThreadLimit limit(2);
        two = run_cloth(model).positions;
    }
    EXPECT_EQ(one, two);
}

TEST(Multiscale, ResumesToTheSameBits) {
    SubdivisionModel model = square_metre(2, MaterialLaw::denim_stable, anywhere);
    model.solve.duration = 0.4;
    model.solve.time_step = 0.1;
    model.solve.settle = true;
    model.solve.rmtr.penalty = 1e6;
    model.contact.distance = 4e-3;
    model.contact.friction = 0.4;
    add_ground(model, -0.01);
    model.obstacle_motions[0].translate.keys = {{0, Vec3::Zero()}, {0.4, Vec3(0.01, 2e-3, 0)}};
    const RunResult uninterrupted = run_cloth(model);
    EXPECT_EQ(uninterrupted.report.status, RunStatus::converged) << uninterrupted.report.message;
    Context context;
    Witness cut(&context, 2);
    EXPECT_EQ(run_multiscale(model, {}, cut, context).report.status, RunStatus::interrupted);
    ASSERT_TRUE(cut.last);
    EXPECT_EQ(cut.last->step, 2);
    RunOptions options;
    options.resume = &*cut.last;
    const RunResult resumed = run_cloth(model, options);
    EXPECT_EQ(resumed.positions, uninterrupted.positions);
    EXPECT_EQ(resumed.report.levels.front().steps, 5);
}

TEST(Multiscale, ResumesWhereNothingIsLeftToSolve) {
    SubdivisionModel model = square_metre(2, MaterialLaw::denim_stable, anywhere);
    model.solve.rmtr.penalty = 1e6;
    model.handles[0].motion.translate.keys = {{0, Vec3::Zero()}, {1, Vec3(0, 0.1, 0)}};
    Context context;
    Witness witness;
    const RunResult whole = run_multiscale(model, {}, witness, context);
    EXPECT_EQ(whole.report.status, RunStatus::converged) << whole.report.message;
    RunOptions options;
    options.resume = &*witness.last;
    const RunResult resumed = run_cloth(model, options);
    EXPECT_EQ(resumed.report.status, RunStatus::converged) << resumed.report.message;
    EXPECT_EQ(resumed.positions, whole.positions);
    EXPECT_EQ(resumed.report.reactions[0].force, whole.report.reactions[0].force);
    EXPECT_EQ(resumed.report.levels[0].residual, whole.report.levels[0].residual);
}

TEST(Multiscale, SaysWhenAHandleIsTooSoftToFollow) {
    SubdivisionModel model = square_metre(1, MaterialLaw::denim_stable, anywhere);
    model.solve.rmtr.penalty = 1e3;
    const RunResult result = run_cloth(model);
    EXPECT_EQ(result.report.status, RunStatus::not_converged);
    ASSERT_EQ(result.report.lagging.size(), 1u);
    EXPECT_GT(result.report.lagging[0].distance, 1.4e-4);
}

TEST(Multiscale, NeverCallsACapConverged) {
    SubdivisionModel model = square_metre(2, MaterialLaw::denim_stable, on_two_sides);
    model.solve.rmtr.max_cycles = 2;
    const RunResult result = run_cloth(model);
    EXPECT_EQ(result.report.status, RunStatus::not_converged);
    EXPECT_FALSE(result.report.levels.front().equilibrium);
    EXPECT_NE(result.report.message.find("iteration cap"), std::string::npos) << result.report.message;
}

} // namespace
} // namespace plisse
