#include <plisse/picture/camera.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <plisse/base/random.h>

namespace plisse {
namespace {

Positions random_points(int count) {
    Random random(7);
    Positions points(3, count);
    for (double& value : points.reshaped())
        value = random.uniform(-2, 3);
    return points;
}

/// Where a point appears, from -1 to 1 in both directions when within the picture.
Vec2 place_in_picture(const Camera& camera, const Vec3& point, double aspect) {
    const Vec3 seen = point - camera.eye;
    const double depth = seen.dot(camera.forward);
    return {seen.dot(camera.right) / (depth * camera.half_height * aspect),
            seen.dot(camera.up) / (depth * camera.half_height)};
}

TEST(Camera, SeesAllPointsAndTouchesTwoOppositeSides) {
    const Positions points = random_points(200);
    for (const View& view : {View{}, View{-120, 80, 1}, View{0, 90, 1}, View{10, -90, 1}, View{200, 0, 1}}) {
        for (double aspect : {0.5, 1.0, 1.5}) {
            const Camera camera = fit_camera(points, view, aspect);
            Vec2 low{1, 1}, high{-1, -1};
            for (Eigen::Index i = 0; i < points.cols(); ++i) {
                EXPECT_GT((points.col(i) - camera.eye).dot(camera.forward), camera.near);
                const Vec2 place = place_in_picture(camera, points.col(i), aspect);
                low = low.cwiseMin(place);
                high = high.cwiseMax(place);
            }
            const Vec2 reach = high.cwiseMax(-low);
            EXPECT_LE(reach.maxCoeff(), 0.95);
            EXPECT_NEAR(reach.maxCoeff(), 1 / 1.08, 1e-9);
            // The tighter direction is centred.
            const int tight = reach.x() > reach.y() ? 0 : 1;
            EXPECT_NEAR(high[tight], -low[tight], 1e-9);
        }
    }
}

TEST(Camera, LooksAlongTheGivenDirectionWithAnOrthonormalFrame) {
    const Camera front = fit_camera(random_points(9), {0, 0, 1}, 1);
    EXPECT_TRUE(front.forward.isApprox(Vec3{0, 0, -1}));
    EXPECT_TRUE(front.up.isApprox(Vec3{0, 1, 0}));
    const Camera side = fit_camera(random_points(9), {90, 0, 1}, 1);
    EXPECT_TRUE(side.forward.isApprox(Vec3{-1, 0, 0}));
    const Camera above = fit_camera(random_points(9), {0, 90, 1}, 1);
    EXPECT_TRUE(above.forward.isApprox(Vec3{0, -1, 0}));
    EXPECT_NEAR(above.right.dot(above.up), 0, 1e-15);
    EXPECT_NEAR(above.up.norm(), 1, 1e-15);
}

TEST(Camera, RayPassesThroughThePointItShows) {
    const Positions points = random_points(20);
    const Camera camera = fit_camera(points, {}, 1.5);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Vec2 place = place_in_picture(camera, points.col(i), 1.5);
        const Vec3 ray = camera.ray(300 * 0.5 * (1 + place.x()), 200 * 0.5 * (1 - place.y()), 300, 200);
        const Vec3 seen = points.col(i) - camera.eye;
        EXPECT_LT((ray * seen.dot(camera.forward) - seen).norm(), 1e-9);
    }
}

TEST(Camera, PassesOverPointsThatAreNotFinite) {
    Positions points = random_points(50);
    const Camera clean = fit_camera(points, {}, 1);
    Positions spoilt(3, 52);
    spoilt << points, Vec3::Constant(std::nan("")), Vec3{0, std::numeric_limits<double>::infinity(), 0};
    EXPECT_TRUE(fit_camera(spoilt, {}, 1).eye.isApprox(clean.eye));
}

TEST(Camera, StandsSomewhereSensibleForOnePointOrNone) {
    Positions point(3, 1);
    point << 3, 4, 5;
    const Camera camera = fit_camera(point, {}, 1);
    EXPECT_GT((point.col(0) - camera.eye).dot(camera.forward), camera.near);
    EXPECT_TRUE(fit_camera(Positions(3, 0), {}, 1).eye.allFinite());
}

TEST(Camera, ZoomEnlarges) {
    const Positions points = random_points(20);
    const Camera once = fit_camera(points, {35, 18, 1}, 1);
    const Camera twice = fit_camera(points, {35, 18, 2}, 1);
    EXPECT_DOUBLE_EQ(once.half_height, 2 * twice.half_height);
    EXPECT_EQ(once.eye, twice.eye);
}

TEST(ParseView, ReadsTwoOrThreeNumbers) {
    const auto view = parse_view("-30,12.5");
    ASSERT_TRUE(view);
    EXPECT_EQ(view->azimuth_deg, -30);
    EXPECT_EQ(view->elevation_deg, 12.5);
    EXPECT_EQ(view->zoom, 1);
    const auto zoomed = parse_view("90,-90,2.5");
    ASSERT_TRUE(zoomed);
    EXPECT_EQ(zoomed->zoom, 2.5);
}

TEST(ParseView, RefusesEverythingElse) {
    for (const char* text : {"", "1", "1,", "1,2,", "1,2,3,", "1,2,3,4", "a,b", "1;2", "1,91", "1,2,0", "1,2,-1",
                             "nan,0", "inf,0", "1,2x", " 1,2"})
        EXPECT_FALSE(parse_view(text)) << text;
}

} // namespace
} // namespace plisse
