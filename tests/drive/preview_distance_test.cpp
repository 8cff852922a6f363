#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <plisse/decimate/level_prolongation.h>
#include <plisse/drive/preview_distance.h>

#include "small_models.h"

using namespace plisse;

namespace {

/// The small drape's cloth, rolled up on level 0, and what that is on the finest level.
struct RolledUp {
    Context context;
    Discretization discretization{small_drape(), 3, context};
    Positions coarse = discretization.mesh(0).rest, fine;

    RolledUp() {
        for (int v = 0; v < coarse.cols(); ++v) {
            const double angle = 4 * coarse(0, v);
            coarse.col(v) = Vec3(std::sin(angle) / 4, coarse(1, v) + std::cos(angle) / 4, coarse(2, v));
        }
        fine = prolongation_to_finest(discretization.hierarchy(), 0, ProlongationOperator::shell).apply(coarse);
    }
};

TEST(PreviewDistance, IsNothingAfterARigidMotion) {
    const RolledUp cloth;
    const Mat3 turn = Eigen::AngleAxisd(2.5, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const Positions moved = (turn * cloth.fine).colwise() + Vec3(1, -2, 0.5);
    const PreviewDistance distance = preview_distance(cloth.discretization, 0, cloth.coarse, moved);
    EXPECT_LT(distance.largest, 1e-14);
}

TEST(PreviewDistance, IsThatOfWhatMovesOtherwise) {
    const RolledUp cloth;
    const Range bodies = cloth.discretization.model().bodies[0].vertices;
    Positions moved = cloth.fine;
    const double far = 1e-6;
    for (const int v : {bodies.begin + 5, bodies.begin + 90}) // to either side: hardly any of it is a rigid motion
        moved(1, v) += v == bodies.begin + 5 ? far : -far;
    const PreviewDistance distance = preview_distance(cloth.discretization, 0, cloth.coarse, moved);
    EXPECT_NEAR(distance.largest, far, 0.05 * far);
    EXPECT_GT(distance.mean, far / bodies.size());
    EXPECT_LT(distance.mean, 4 * far / bodies.size());
}

TEST(PreviewDistance, LeavesObstaclesOut) {
    const RolledUp cloth;
    Positions moved = cloth.fine;
    const Range ball = cloth.discretization.model().obstacles[0].vertices;
    moved.middleCols(ball.begin, ball.size()).colwise() += Vec3(7, 0, 0);
    EXPECT_LT(preview_distance(cloth.discretization, 0, cloth.coarse, moved).largest, 1e-14);
}

} // namespace
