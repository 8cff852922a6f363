#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <plisse/base/random.h>
#include <plisse/model/subdivision_problem.h>

#include "cloth_models.h"

namespace plisse {
namespace {

/// Level `level` of a model in its first step.
struct Posed {
    Posed(const SubdivisionModel& of, int level)
        : model(of),
          problem(of, level, held_places(of)[static_cast<std::size_t>(level)], boundary_penalty(of), context) {
        SurfaceStep step;
        step.t = step.time_step = 1;
        problem.begin_step(step, of.levels.rest(level));
        rest = as_vector(of.levels.rest(level));
    }
    /// Bent and stretched, the same smooth map on every level.
    VecX bent() const {
        VecX x = rest;
        for (Eigen::Index v = 0; v < x.size() / 3; ++v) {
            const Vec3 p = x.segment<3>(3 * v);
            x.segment<3>(3 * v) =
                p + Vec3(0.05 * p.x() * p.z(), 0.2 * std::sin(3 * p.x()) * std::cos(2 * p.z()), 0.04 * p.z() * p.z());
        }
        return x;
    }
    Eigen::MatrixXd hessian(const VecX& x) {
        NewtonSystem& system = problem.system();
        problem.assemble(x, system, false);
        Eigen::MatrixXd h(x.size(), x.size());
        for (Eigen::Index i = 0; i < x.size(); ++i)
            h.col(i) = system.multiply(VecX::Unit(x.size(), i));
        return h;
    }
    const SubdivisionModel& model;
    Context context;
    SubdivisionProblem problem;
    VecX rest;
};

TEST(SubdivisionProblem, DerivativesAgreeWithDifferences) {
    const SubdivisionModel model = square_metre(1, MaterialLaw::denim_stable, on_two_sides);
    Posed posed(model, 0);
    const VecX x = posed.bent();
    VecX gradient, before, after;
    posed.problem.gradient(x, gradient);
    const Eigen::MatrixXd h = posed.hessian(x);
    constexpr double step = 1e-6;
    VecX slopes(x.size());
    Eigen::MatrixXd curvatures(x.size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        const VecX d = step * VecX::Unit(x.size(), i);
        slopes[i] = (posed.problem.value(x + d) - posed.problem.value(x - d)) / (2 * step);
        posed.problem.gradient(x + d, after);
        posed.problem.gradient(x - d, before);
        curvatures.col(i) = (after - before) / (2 * step);
    }
    EXPECT_LT((slopes - gradient).norm(), 1e-7 * gradient.norm());
    EXPECT_LT((curvatures - h).norm(), 1e-6 * h.norm());
    EXPECT_LT((h - h.transpose()).norm(), 1e-12 * h.norm());
}

TEST(SubdivisionProblem, SubdividedStatesHaveTheSameEnergyOnBothLevels) {
    const SubdivisionModel model = square_metre(2, MaterialLaw::denim_stable, on_two_sides);
    Posed coarse(model, 0), fine(model, 1);
    const VecX x = coarse.bent();
    const Positions on_fine = as_positions(x) * model.levels.subdivision(0).transpose();
    const auto a = coarse.problem.energies(x), b = fine.problem.energies(as_vector(on_fine));
    EXPECT_NEAR(a.gravity, b.gravity, 1e-12);
    EXPECT_NEAR(a.inertia, b.inertia, 1e-12);
    EXPECT_NEAR(a.held, b.held, 1e-9 * b.held) << "the penalty of the finest level is to act on every level alike";
    EXPECT_NEAR(a.elastic, b.elastic, 0.02 * b.elastic) << "integrated at other points";
}

TEST(SubdivisionProblem, HoldingForcesBalanceTheRest) {
    const SubdivisionModel model = square_metre(1, MaterialLaw::denim_stable, on_two_sides);
    Posed posed(model, 0);
    const VecX x = posed.bent();
    VecX gradient;
    posed.problem.gradient(x, gradient);
    const Vec3 held = posed.problem.holding(x).forces.rowwise().sum();
    // Moving everything changes the energies of gravity, inertia and holding alone, at rates that are their forces.
    const double mass = 0.4;
    const SurfaceSamples samples = surface_samples(model.levels.surface_basis(0, 4), model.levels.rest(0));
    const Positions moved = as_positions(x) - as_positions(posed.rest);
    const Eigen::SparseMatrix<double> areas = consistent_matrix(samples, static_cast<int>(moved.cols()));
    const Vec3 mean = moved * (areas * VecX::Ones(areas.cols())); // over a square metre
    const Vec3 total = as_positions(gradient).rowwise().sum();
    EXPECT_LT((total - (mass * mean - mass * Vec3(0, -9.81, 0) - held)).norm(), 1e-9 * held.norm());
}

/// Acceptance 7 of the specification: the condition number of a held sheet at rest.
TEST(SubdivisionProblem, HasTheConditionNumbersOfItsSpecification) {
    SubdivisionModel model = square_metre(3, MaterialLaw::denim_table, anywhere, SurfaceVariables::control_points);
    const auto condition = [&](std::optional<double> penalty) {
        model.solve.rmtr.penalty = penalty;
        Posed posed(model, 2);
        const VecX values =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(posed.hessian(posed.rest), Eigen::EigenvaluesOnly)
                .eigenvalues();
        return values.maxCoeff() / values.minCoeff();
    };
    EXPECT_NEAR(condition(std::nullopt) / 1.4e8, 1, 0.2);
    EXPECT_NEAR(condition(1e5) / 2.5e7, 1, 0.2);
    EXPECT_NEAR(condition(1e8) / 1.3e10, 1, 0.2);
}

} // namespace
} // namespace plisse
