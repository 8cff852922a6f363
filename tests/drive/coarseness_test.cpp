#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <plisse/drive/coarseness.h>

#include "small_models.h"

using namespace plisse;

namespace {

/// A flat strip along x with a line of vertices across it at x = 0.
TriangleMesh strip(int cells_along) {
    GeneratorOptions options;
    options.size = Vec3(2, 0.4, 0);
    options.pattern = Pattern::regular;
    options.cells = {cells_along, cells_along / 5};
    return generate_mesh(options);
}

/// The part with x > 0, turned about the z axis.
Positions folded(const Positions& flat, double angle) {
    Positions x = flat;
    const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
    for (int v = 0; v < x.cols(); ++v)
        if (x(0, v) > 1e-9)
            x.col(v) = turn * x.col(v);
    return x;
}

Positions rolled(const Positions& flat, double radius) {
    Positions x = flat;
    for (int v = 0; v < x.cols(); ++v)
        x.col(v) = Vec3(radius * std::sin(flat(0, v) / radius), radius * (1 - std::cos(flat(0, v) / radius)), x(2, v));
    return x;
}

TEST(Coarseness, IsNothingAtRestAndAfterARigidMotion) {
    const TriangleMesh ball = sphere_mesh(0.1, 0.03);
    EXPECT_EQ(coarseness(ball.positions, ball.positions, ball.faces).maxCoeff(), 0);
    const Mat3 turn = Eigen::AngleAxisd(2.5, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const Positions moved = (turn * ball.positions).colwise() + Vec3(1, -2, 0.5);
    EXPECT_LT(coarseness(ball.positions, moved, ball.faces).maxCoeff(), 1e-12);
    EXPECT_EQ(find_too_coarse(ball.positions, moved, ball.faces).share, 0);
}

TEST(Coarseness, OfOneHingeIsItsTurnFromRest) {
    Positions rest(3, 4);
    rest << 0, 0, -1, 1, /**/ 0, 0, 0, 0, /**/ -0.5, 0.5, 0, 0;
    const std::vector<Face> faces{{0, 1, 2}, {1, 0, 3}};
    for (double start : {0.0, 0.9, -3.0})
        for (double turn : {0.2, -1.0, 3.0}) {
            const VecX values = coarseness(folded(rest, start), folded(rest, start + turn), faces);
            for (int v = 0; v < 4; ++v)
                EXPECT_NEAR(values[v], std::abs(std::remainder(turn, 2 * std::numbers::pi)) / most_turn, 1e-12);
        }
}

TEST(Coarseness, OfAFoldedStripIsHighestAtTheFold) {
    const TriangleMesh mesh = strip(20);
    const Positions x = folded(mesh.positions, 1.2);
    const VecX values = coarseness(mesh.positions, x, mesh.faces);
    for (int v = 0; v < x.cols(); ++v) {
        const double away = std::abs(mesh.positions(0, v));
        if (away > 0.15) { // further than a face
            EXPECT_LT(values[v], 1e-12);
        }
        if (away < 1e-9) {
            EXPECT_GT(values[v], 1);
        }
    }
    const TooCoarse found = find_too_coarse(mesh.positions, x, mesh.faces);
    EXPECT_NEAR(found.place.x(), 0, 1e-9);
    EXPECT_EQ(found.worst, values.maxCoeff());
    EXPECT_NEAR(found.turn, most_turn * found.worst, 1e-15);
    EXPECT_GE(found.share, 0.05) << "a row of vertices, a tenth of a metre wide each";
    EXPECT_LE(found.share, 0.15);
    EXPECT_NEAR(found.edge, 0.11, 0.02);
}

TEST(Coarseness, OfABendFallsWithTheEdges) {
    double last = 0;
    for (int cells : {10, 20, 40}) {
        const TriangleMesh mesh = strip(cells);
        const TooCoarse found = find_too_coarse(mesh.positions, rolled(mesh.positions, 0.4), mesh.faces);
        if (last > 0) {
            EXPECT_NEAR(found.worst / last, 0.5, 0.05);
        }
        last = found.worst;
    }
    const TriangleMesh coarse = strip(10), fine = strip(40);
    EXPECT_GT(find_too_coarse(coarse.positions, rolled(coarse.positions, 0.4), coarse.faces).share, 0.5);
    EXPECT_EQ(find_too_coarse(fine.positions, rolled(fine.positions, 0.4), fine.faces).share, 0);
}

} // namespace
