#include <plisse/picture/scalars.h>

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "shapes.h"

namespace plisse {
namespace {

TEST(LargestStretches, AreTheLargerSingularValueOfTheMap) {
    const TriangleMesh rest = shapes::square(3);
    Mat3 stretch = Vec3{1.3, 0.8, 1}.asDiagonal();
    const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3{1, 2, 3}.normalized()).toRotationMatrix();
    const Mat3 within = Eigen::AngleAxisd(0.4, Vec3::UnitZ()).toRotationMatrix();
    const Positions moved = turn * stretch * within * rest.positions;
    for (double value : largest_stretches(rest.positions, moved, rest.faces))
        EXPECT_NEAR(value, 1.3, 1e-12);
}

TEST(LargestStretches, AreOneAtRestAndUnknownWhereRestIsDegenerate) {
    TriangleMesh mesh = shapes::square(2);
    mesh.faces.push_back({0, 1, 2}); // on one line
    const std::vector<double> values = largest_stretches(mesh.positions, mesh.positions, mesh.faces);
    for (std::size_t f = 0; f + 1 < values.size(); ++f)
        EXPECT_NEAR(values[f], 1, 1e-12);
    EXPECT_TRUE(std::isnan(values.back()));
}

TEST(MeanCurvatures, OfASphereAreOneOverItsRadius) {
    const TriangleMesh mesh = shapes::sphere(0.25, 40);
    const std::vector<double> values = mean_curvatures(mesh.positions, mesh.faces);
    for (std::size_t v = 0; v < values.size(); ++v)
        if (std::abs(mesh.positions(1, static_cast<Eigen::Index>(v))) < 0.15) {
            EXPECT_NEAR(values[v], 4, 0.04);
        }
}

TEST(MeanCurvatures, OfACylinderAreHalfOneOverItsRadius) {
    const TriangleMesh mesh = shapes::grid(60, 20, [](double u, double v) {
        return Vec3{0.5 * std::sin(2 * u), v, 0.5 * std::cos(2 * u)};
    });
    for (double value : mean_curvatures(mesh.positions, mesh.faces))
        EXPECT_NEAR(value, 1, 0.01);
}

TEST(MeanCurvatures, OfAPlaneAreZeroAlsoAtItsRim) {
    TriangleMesh mesh = shapes::square(7);
    shapes::append(mesh, {Positions::Zero(3, 1), {}, {}}); // no face uses it
    const std::vector<double> values = mean_curvatures(mesh.positions, mesh.faces);
    for (std::size_t v = 0; v + 1 < values.size(); ++v)
        EXPECT_NEAR(values[v], 0, 1e-10);
    EXPECT_TRUE(std::isnan(values.back()));
}

TEST(FitRange, PassesOverPeaksAndWhatDoesNotCount) {
    Scalars scalars;
    for (int i = 0; i <= 100; ++i)
        scalars.values.push_back(i);
    scalars.values.push_back(std::nan(""));
    fit_range(scalars, {}, 0.1);
    EXPECT_EQ(scalars.low, 0);
    EXPECT_EQ(scalars.high, 90);
    std::vector<bool> counts(102, false);
    counts[20] = counts[30] = true;
    fit_range(scalars, counts, 0);
    EXPECT_EQ(scalars.low, 20);
    EXPECT_EQ(scalars.high, 30);
}

TEST(FitRange, NeverIsEmpty) {
    for (const std::vector<double>& values : {std::vector<double>{}, {std::nan("")}, {5, 5, 5}, {0}}) {
        Scalars scalars{"", MeshAttribute::Domain::vertex, values, 0, 0};
        fit_range(scalars, {}, 0);
        EXPECT_LT(scalars.low, scalars.high);
    }
}

} // namespace
} // namespace plisse
