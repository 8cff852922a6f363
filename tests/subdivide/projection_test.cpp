#include <plisse/subdivide/projection.h>

#include <gtest/gtest.h>

#include <plisse/base/error.h>

#include "quad_samples.h"

namespace plisse {
namespace {

TEST(Projection, ReversesSubdivision) {
    for (const auto& [name, quads, ordinary] : quad_samples()) {
        ControlMesh mesh = with_ghost_ring(quads).mesh;
        for (int level = 0; level < 2; ++level) {
            const CatmullClarkStep step = catmull_clark_step(mesh);
            const VertexWeights p = reverse_subdivision(mesh, step);
            EXPECT_LT(largest(p * step.weights - identity(mesh.vertex_count)), 1e-12) << name;
            const LeastSquaresProjection nearest(step.weights);
            const Positions x = random_positions(mesh.vertex_count);
            EXPECT_LT((nearest.apply(x * step.weights.transpose()) - x).cwiseAbs().maxCoeff(), 1e-12) << name;
            mesh = step.fine;
        }
    }
}

TEST(Projection, OfLeastSquaresIsNearest) {
    const ControlMesh mesh = with_ghost_ring(fan(5)).mesh;
    const CatmullClarkStep step = catmull_clark_step(mesh);
    const Positions fine = random_positions(step.fine.vertex_count);
    const Positions miss = LeastSquaresProjection(step.weights).apply(fine) * step.weights.transpose() - fine;
    EXPECT_GT(miss.norm(), 0.1);
    EXPECT_LT((miss * step.weights).cwiseAbs().maxCoeff(), 1e-13);
}

/// Largest singular value by power iteration.
template <typename Apply, typename Transposed>
double norm(int size, const Apply& apply, const Transposed& transposed) {
    VecX x = VecX::LinSpaced(size, 0.3, 1.7).array().sin();
    double squared = 0;
    for (int i = 0; i < 300; ++i) {
        x = transposed(apply(x)).eval();
        squared = x.norm();
        x /= squared;
    }
    return std::sqrt(squared);
}

/// As measured on regular grids in another implementation.
TEST(Projection, HasTheNormsOfThePaper) {
    const ControlMesh mesh = with_ghost_ring(flat_grid(16, 16)).mesh;
    const CatmullClarkStep step = catmull_clark_step(mesh);
    const VertexWeights p = reverse_subdivision(mesh, step);
    const double reverse = norm(
        static_cast<int>(p.cols()), [&](const VecX& x) -> VecX { return p * x; },
        [&](const VecX& x) -> VecX { return p.transpose() * x; });
    RecordProperty("reverse", std::to_string(reverse));
    EXPECT_NEAR(reverse, 13.8, 0.1);
    // The norm of the pseudo-inverse is one over the least singular value of S.
    Eigen::SimplicialLLT<VertexWeights> normal(VertexWeights(step.weights.transpose() * step.weights));
    const double nearest = norm(
        static_cast<int>(p.rows()), [&](const VecX& x) -> VecX { return normal.solve(x); },
        [](const VecX& x) { return x; });
    RecordProperty("nearest", std::to_string(nearest));
    EXPECT_NEAR(nearest, 9.1, 0.1);
}

TEST(Projection, RefusesWhatCannotBeReversed) {
    const ControlMesh cube = with_ghost_ring(cubes({{0, 0, 0}})).mesh;
    const CatmullClarkStep step = catmull_clark_step(cube);
    EXPECT_THROW(reverse_subdivision(cube, step), InputError);
    const CatmullClarkStep second = catmull_clark_step(step.fine);
    EXPECT_LT(largest(reverse_subdivision(step.fine, second) * second.weights - identity(step.fine.vertex_count)),
              1e-12);
}

} // namespace
} // namespace plisse
