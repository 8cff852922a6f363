#include <plisse/decimate/affine_weights.h>

#include <gtest/gtest.h>

#include <plisse/decimate/decimate.h>
#include <plisse/decimate/level_prolongation.h>

#include <decimate/test_meshes.h>

namespace plisse {
namespace {

Hierarchy hierarchy_of(const test::TestMesh& mesh) {
    DecimationOptions options;
    options.levels = 3;
    options.coarsest_vertices = 60;
    return decimate(mesh.input(), options);
}

Mat3 some_map() {
    Mat3 map;
    map << 1.2, 0.1, -0.3, 0.2, 0.9, 0.4, -0.1, 0.3, 1.1;
    return map;
}

/// What a best-fit affine map is right for.
TEST(AffineWeights, carry_any_affine_motion_of_a_curved_shape) {
    const Hierarchy hierarchy = hierarchy_of(test::sphere(30, 21));
    const Mat3 map = some_map();
    const Vec3 shift(1, 2, 3);
    for (int level : {0, 1}) {
        const Prolongation p = prolongation_to_finest(hierarchy, level, ProlongationOperator::affine);
        const Positions coarse = (map * hierarchy.levels[static_cast<std::size_t>(level)].rest).colwise() + shift;
        const Positions expected = (map * hierarchy.finest().rest).colwise() + shift;
        EXPECT_LT((p.apply(coarse) - expected).cwiseAbs().maxCoeff(), 1e-9);
    }
}

TEST(AffineWeights, sum_to_one_and_grow_dense) {
    const Hierarchy hierarchy = hierarchy_of(test::sphere(30, 21));
    const ProlongationWeights far = affine_weights(hierarchy, 0, 2), near = affine_weights(hierarchy, 1, 2);
    EXPECT_LT((far * VecX::Ones(far.cols()) - VecX::Ones(far.rows())).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(far.rows(), hierarchy.finest().rest.cols());
    EXPECT_EQ(far.cols(), hierarchy.levels[0].rest.cols());
    const auto per_row = [](const ProlongationWeights& w) {
        return static_cast<double>(w.nonZeros()) / static_cast<double>(w.rows());
    };
    EXPECT_GT(per_row(near), 20); // where barycentric weights are three
    EXPECT_GT(per_row(far), 0.9 * static_cast<double>(far.cols()));
}

TEST(AffineWeights, of_two_levels_multiply) {
    const Hierarchy hierarchy = hierarchy_of(test::sphere(30, 21));
    const ProlongationWeights once = affine_weights(hierarchy, 0, 2);
    const ProlongationWeights twice = affine_weights(hierarchy, 1, 2) * affine_weights(hierarchy, 0, 1);
    EXPECT_LT((Eigen::MatrixXd(once) - Eigen::MatrixXd(twice)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(AffineWeights, pull_back_is_the_transpose_and_values_stay_positive) {
    const Hierarchy hierarchy = hierarchy_of(test::sphere(30, 21));
    const Prolongation p = prolongation_to_next(hierarchy, 0, ProlongationOperator::affine);
    const Eigen::MatrixXd weights = affine_weights(hierarchy, 0, 1);
    Positions g(3, p.fine_count());
    for (int i = 0; i < p.fine_count(); ++i)
        g.col(i) = Vec3(std::sin(i), std::cos(3 * i), std::sin(2 * i));
    const Positions expected = g * weights;
    EXPECT_LT((p.pull_back(hierarchy.levels[0].rest, g) - expected).cwiseAbs().maxCoeff(), 1e-10);
    const VecX masses = p.pull_back_values(VecX::Ones(p.fine_count()));
    EXPECT_GT(masses.minCoeff(), 0);
    EXPECT_NEAR(masses.sum(), p.fine_count(), 1e-9);
}

} // namespace
} // namespace plisse
