#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>

#include "linalg/dense_system.h"
#include "linalg/grid_system.h"
#include "linalg/spline_grid.h"
#include <plisse/solve/conjugate_gradient_step.h>

using namespace plisse;

namespace {

double model(const Eigen::MatrixXd& h, const VecX& g, const VecX& s) {
    return g.dot(s) + 0.5 * s.dot(h * s);
}

/// Minimum of the model within the radius from the eigen-decomposition: the secular equation by bisection, and the hard
/// case by the lowest eigenvector.
double brute_force(const Eigen::MatrixXd& h, const VecX& g, double radius) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(h);
    const VecX lambda = eigen.eigenvalues(), c = eigen.eigenvectors().transpose() * g;
    const auto step = [&](double shift) {
        VecX s(c.size());
        for (int i = 0; i < c.size(); ++i)
            s[i] = std::abs(lambda[i] + shift) > 1e-13 * lambda.cwiseAbs().maxCoeff() ? -c[i] / (lambda[i] + shift) : 0;
        return s;
    };
    const auto value = [&](const VecX& s) { return c.dot(s) + 0.5 * s.dot(lambda.cwiseProduct(s)); };
    if (lambda[0] > 0 && step(0).norm() <= radius)
        return value(step(0));
    double low = std::max(0.0, -lambda[0]), high = low + g.norm() / radius + 1;
    if (step(low).norm() < radius && std::abs(c[0]) < 1e-12 * g.norm()) { // hard case
        VecX s = step(low);
        s[0] = std::sqrt(radius * radius - s.squaredNorm());
        return value(s);
    }
    for (int k = 0; k < 200; ++k) {
        const double middle = 0.5 * (low + high);
        (step(middle).norm() > radius ? low : high) = middle;
    }
    return value(step(high));
}

double cauchy(const Eigen::MatrixXd& h, const VecX& g, double radius) {
    const VecX d = -g.normalized();
    const double curvature = d.dot(h * d);
    const double tau = curvature > 0 ? std::min(radius, g.norm() / curvature) : radius;
    return model(h, g, tau * d);
}

struct Method {
    std::string name;
    QuadraticOptions options;
};

std::vector<Method> all_methods() {
    std::vector<Method> methods;
    QuadraticOptions options;
    options.max_iterations = 400;
    options.tolerance = 1e-8;
    options.method = QuadraticMethod::dogleg;
    methods.push_back({"dogleg", options});
    options.method = QuadraticMethod::exact;
    methods.push_back({"exact", options});
    options.method = QuadraticMethod::conjugate_gradients;
    for (const auto& [name, preconditioning] : {std::pair{"none", Preconditioning::none},
                                                {"block_jacobi", Preconditioning::block_jacobi},
                                                {"block_gauss_seidel", Preconditioning::block_gauss_seidel},
                                                {"multigrid", Preconditioning::multigrid}}) {
        options.preconditioning = preconditioning;
        methods.push_back({name, options});
    }
    return methods;
}

/// Springs on a grid, made indefinite by a negative multiple of the unit matrix.
NewtonSystem springs(int side, double shift, std::uint64_t seed) {
    const Grid grid(side, 0, seed);
    NewtonSystem system = grid.system();
    grid.assemble(system, seed);
    for (int v = 0; v < grid.vertex_count(); ++v)
        system.add_block(v, v, shift * Mat3::Identity());
    return system;
}

/// One weight of 1 a row: aggregates of neighbours.
ScalarTransfer aggregates(int rows) {
    spline::Triplets entries;
    for (int i = 0; i < rows; ++i)
        entries.emplace_back(i, i / 4, 1.0);
    return spline::table(rows, (rows + 3) / 4, entries);
}

TEST(QuadraticStep, StaysInsideAndBeatsTheCauchyPoint) {
    const ScalarTransfer s = aggregates(25);
    const ScalarTransfer* const tables[] = {&s};
    for (const Method& method : all_methods())
        for (double shift : {0.0, -0.3, -4.0})
            for (std::uint64_t seed : {1, 2, 3})
                for (double radius : {1e-3, 0.1, 1.0, 30.0, 1e4}) {
                    SCOPED_TRACE(method.name + ", shift " + std::to_string(shift) + ", radius " +
                                 std::to_string(radius));
                    const NewtonSystem system = springs(5, shift, seed);
                    const Eigen::MatrixXd h = dense(system);
                    const VecX g = random_vector(h.rows(), seed + 10);
                    const auto solver = make_quadratic_solver(method.options, tables);
                    solver->set_matrix(system);
                    const QuadraticStep step = solver->minimize(g, radius);
                    EXPECT_LE(step.s.norm(), radius * (1 + 1e-9));
                    EXPECT_NEAR(step.norm, step.s.norm(), 1e-9 * radius);
                    const double value = model(h, g, step.s);
                    EXPECT_NEAR(step.decrease(), -value, 1e-9 * std::abs(value));
                    EXPECT_LE(value, cauchy(h, g, radius) * (1 - 1e-9));
                    const double least = brute_force(h, g, radius);
                    EXPECT_GE(value, least - 1e-6 * std::abs(least));
                    if (method.options.method == QuadraticMethod::exact) {
                        EXPECT_LE(value, 0.97 * least);
                    }
                    if (shift == 0 && !step.on_boundary && method.name != "multigrid") { // the Newton point
                        EXPECT_LE(value, least * (1 - 1e-6));
                    }
                }
}

TEST(QuadraticStep, FindsTheMinimumInTheHardCase) {
    for (std::uint64_t seed : {1, 2, 3}) {
        const NewtonSystem system = springs(4, -2, seed);
        const Eigen::MatrixXd h = dense(system);
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(h);
        const VecX softest = eigen.eigenvectors().col(0);
        VecX g = random_vector(h.rows(), seed);
        g -= g.dot(softest) * softest;
        for (double radius : {20.0, 100.0, 1e5}) {
            const auto solver = make_quadratic_solver({});
            solver->set_matrix(system);
            const double least = brute_force(h, g, radius);
            const QuadraticStep step = solver->minimize(g, radius);
            EXPECT_LE(step.s.norm(), radius * (1 + 1e-9));
            EXPECT_LE(model(h, g, step.s), 0.97 * least);
            EXPECT_LE(step.iterations, 25);
        }
    }
}

TEST(QuadraticStep, ServesSmallerRadiiWithoutANewMatrix) {
    const NewtonSystem system = springs(5, -1, 4);
    const Eigen::MatrixXd h = dense(system);
    const VecX g = random_vector(h.rows(), 5);
    const auto solver = make_quadratic_solver({});
    solver->set_matrix(system);
    for (double radius = 100; radius > 1e-4; radius /= 7) {
        const QuadraticStep step = solver->minimize(g, radius);
        EXPECT_LE(model(h, g, step.s), 0.97 * brute_force(h, g, radius)) << radius;
    }
}

TEST(QuadraticStep, KeepsTheRadiusInThePreconditionersNorm) {
    for (double shift : {0.0, -2.0}) {
        const NewtonSystem system = springs(5, shift, 3);
        const Eigen::MatrixXd h = dense(system);
        const VecX g = random_vector(h.rows(), 5);
        BlockJacobi jacobi;
        jacobi.set_matrix(system);
        Eigen::MatrixXd inverse(h.rows(), h.rows());
        for (int j = 0; j < h.rows(); ++j)
            inverse.col(j) = jacobi.apply(VecX::Unit(h.rows(), j));
        const Eigen::MatrixXd m = inverse.inverse();
        QuadraticOptions options;
        options.method = QuadraticMethod::conjugate_gradients;
        options.preconditioning = Preconditioning::block_jacobi;
        options.norm = RadiusNorm::preconditioner;
        options.max_iterations = 200;
        const auto solver = make_quadratic_solver(options);
        solver->set_matrix(system);
        for (double radius : {0.1, 1.0, 5.0}) {
            const QuadraticStep step = solver->minimize(g, radius);
            const double norm = std::sqrt(step.s.dot(m * step.s));
            EXPECT_LE(norm, radius * (1 + 1e-8));
            EXPECT_NEAR(step.norm, norm, 1e-8 * radius);
            // Along the steepest descent of that norm.
            const VecX d = -inverse * g / std::sqrt(g.dot(inverse * g));
            const double slope = -g.dot(d), curvature = d.dot(h * d);
            const double tau = curvature > 0 ? std::min(radius, slope / curvature) : radius;
            EXPECT_LE(model(h, g, step.s), model(h, g, tau * d) * (1 - 1e-12));
        }
    }
}

/// What rounding may make of a preconditioner.
class Spoiled : public Preconditioner {
public:
    void set_matrix(const NewtonSystem&) override {}
    VecX apply(const VecX& residual) const override { return -residual; }
    double products() const override { return 3; }
};

TEST(QuadraticStep, GoesDownWithoutAPreconditionerThatShowsNoWay) {
    const NewtonSystem system = springs(5, -2, 3);
    const Eigen::MatrixXd h = dense(system);
    const VecX g = random_vector(h.rows(), 5);
    for (RadiusNorm norm : {RadiusNorm::euclidean, RadiusNorm::preconditioner}) {
        QuadraticOptions options;
        options.norm = norm;
        ConjugateGradientStep solver(options, std::make_unique<Spoiled>());
        solver.set_matrix(system);
        EXPECT_LE(model(h, g, solver.minimize(g, 1).s), cauchy(h, g, 1));
    }
}

TEST(QuadraticStep, MultigridNeedsFewIterationsWhateverTheSize) {
    std::vector<int> iterations;
    for (int levels : {1, 2, 3}) {
        std::vector<ScalarTransfer> tables;
        std::vector<const ScalarTransfer*> pointers;
        for (int l = 0; l < levels; ++l)
            tables.push_back(spline::tensor(spline::subdivision_1d(4 << l)));
        for (const ScalarTransfer& table : tables)
            pointers.push_back(&table);
        const NewtonSystem system = spline::plate(4 << levels, 1);
        QuadraticOptions options;
        options.method = QuadraticMethod::conjugate_gradients;
        options.preconditioning = Preconditioning::multigrid;
        options.max_iterations = 100;
        options.tolerance = 1e-6;
        const auto solver = make_quadratic_solver(options, pointers);
        solver->set_matrix(system);
        const QuadraticStep step = solver->minimize(random_vector(3 * system.row_count(), 1), 1e20);
        EXPECT_FALSE(step.on_boundary);
        iterations.push_back(step.iterations);
    }
    EXPECT_LE(iterations.back(), 15);
    EXPECT_LE(iterations.back(), iterations.front() + 3);
}

TEST(QuadraticStep, BoundaryStepsDoNotCancel) {
    const BoundarySteps far = steps_to_boundary(1e-20, 1e-10, 1, 1);
    EXPECT_NEAR(far.upper, 1, 1e-9);
    EXPECT_NEAR(far.lower, -1, 1e-9);
    const BoundarySteps near = steps_to_boundary(1 - 1e-12, 1, 1, 1);
    EXPECT_NEAR(near.upper, 5e-13, 1e-16);
    EXPECT_NEAR(near.lower, -2, 1e-11);
}

} // namespace
