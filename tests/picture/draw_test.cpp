#include <plisse/picture/draw.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <plisse/base/parallel.h>

#include "shapes.h"

namespace plisse {
namespace {

constexpr int size = 120;

DrawOptions small(double azimuth, double elevation) {
    DrawOptions options;
    options.width = options.height = size;
    options.view = {azimuth, elevation, 1};
    return options;
}

bool same(const Image& a, const Image& b) {
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            if (!(a.at(x, y) == b.at(x, y)))
                return false;
    return a.width() == b.width() && a.height() == b.height();
}

Image background_only(const DrawOptions& options) {
    // A single far point beside the picture: everything but the words for an empty one.
    const TriangleMesh mesh = shapes::square(1);
    const Positions frame = mesh.positions.array() + 100;
    DrawOptions aside = options;
    aside.frame = &frame;
    aside.scalars = nullptr;
    return draw({mesh.positions, mesh.faces, {}, 1}, aside);
}

int difference(const Pixel& a, const Pixel& b) {
    return std::abs(a.red - b.red) + std::abs(a.green - b.green) + std::abs(a.blue - b.blue);
}

int covered_pixels(const Image& image, const Image& empty) {
    int count = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            count += difference(image.at(x, y), empty.at(x, y)) > 30;
    return count;
}

TEST(Draw, ASphereFillsItsDisc) {
    const TriangleMesh mesh = shapes::sphere(3, 40);
    const Image image = draw({mesh.positions, mesh.faces, {}, 1}, small(35, 18));
    const double radius = 0.5 * size / 1.08;
    EXPECT_NEAR(covered_pixels(image, background_only(small(35, 18))), std::numbers::pi * radius * radius,
                0.03 * size * size);
}

TEST(Draw, IsTheSameForAnyNumberOfThreads) {
    TriangleMesh mesh = shapes::sphere(1, 30);
    shapes::append(mesh, shapes::cube());
    DrawOptions options;
    options.edges = true;
    std::vector<Image> images;
    for (int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        images.push_back(draw({mesh.positions, mesh.faces, {}, 1}, options));
    }
    EXPECT_TRUE(same(images[0], images[1]));
    EXPECT_TRUE(same(images[0], images[2]));
}

TEST(Draw, TellsTheBackOfASheetFromItsFront) {
    const TriangleMesh mesh = shapes::square(4);
    const Subject subject{mesh.positions, mesh.faces, {}, 1};
    const Pixel front = draw(subject, small(0, 0)).at(size / 2, size / 2);
    const Pixel back = draw(subject, small(180, 0)).at(size / 2, size / 2);
    EXPECT_GT(front.red, back.red + 30);
}

TEST(Draw, ShowsObstaclesGreyAndBodiesInTheirColors) {
    TriangleMesh mesh;
    std::vector<int> body;
    for (int i = 0; i < 3; ++i) {
        TriangleMesh part = shapes::square(2);
        part.positions.row(0).array() += 2.5 * i;
        shapes::append(mesh, part);
        body.resize(mesh.faces.size(), i);
    }
    DrawOptions options = small(0, 0);
    options.width = 3 * size;
    const auto spread = [](const Pixel& p) {
        return std::max({p.red, p.green, p.blue}) - std::min({p.red, p.green, p.blue});
    };
    const Image image = draw({mesh.positions, mesh.faces, body, 2}, options);
    const Pixel first = image.at(size / 2, size / 2);
    const Pixel second = image.at(size * 3 / 2, size / 2);
    EXPECT_GT(difference(first, second), 80);
    EXPECT_GT(spread(first), 40);
    EXPECT_LT(spread(image.at(size * 5 / 2, size / 2)), 25);
    options.tell_bodies_apart = false;
    const Image plain = draw({mesh.positions, mesh.faces, body, 2}, options);
    EXPECT_LT(difference(plain.at(size / 2, size / 2), plain.at(size * 3 / 2, size / 2)), 12);
}

TEST(Draw, ShowsTheNearerOfTwoBodies) {
    TriangleMesh mesh = shapes::square(2);
    TriangleMesh nearer = shapes::square(2);
    nearer.positions.row(2).array() += 0.5;
    shapes::append(mesh, nearer);
    const std::vector<int> near_is_second = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};
    std::vector<int> near_is_first = near_is_second;
    for (int& b : near_is_first)
        b = 1 - b;
    const Pixel second = draw({mesh.positions, mesh.faces, near_is_second, 2}, small(0, 0)).at(size / 2, size / 2);
    const Pixel first = draw({mesh.positions, mesh.faces, near_is_first, 2}, small(0, 0)).at(size / 2, size / 2);
    EXPECT_GT(second.blue, second.red); // teal
    EXPECT_GT(first.red, first.blue);   // terracotta
}

TEST(Draw, EdgesDarkenOnlyLines) {
    const TriangleMesh mesh = shapes::square(4);
    const Subject subject{mesh.positions, mesh.faces, {}, 1};
    DrawOptions options = small(0, 0);
    const Image plain = draw(subject, options);
    options.edges = true;
    const Image lined = draw(subject, options);
    int darker = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            EXPECT_LE(lined.at(x, y).red, plain.at(x, y).red);
            darker += plain.at(x, y).red - lined.at(x, y).red > 20;
        }
    EXPECT_GT(darker, 13 * 80);
    EXPECT_LT(darker, size * size / 2);
}

TEST(Draw, ColorsByScalarsOfVerticesAndFaces) {
    const TriangleMesh mesh = shapes::square(6);
    const Subject subject{mesh.positions, mesh.faces, {}, 1};
    Scalars by_vertex{"x", MeshAttribute::Domain::vertex, {}, -1, 1};
    for (Eigen::Index v = 0; v < mesh.positions.cols(); ++v)
        by_vertex.values.push_back(mesh.positions(0, v));
    Scalars by_face{"x", MeshAttribute::Domain::face, {}, -1, 1};
    for (const Face& face : mesh.faces)
        by_face.values.push_back(mesh.positions(0, face[0]));
    for (const Scalars& scalars : {by_vertex, by_face}) {
        DrawOptions options = small(0, 0);
        options.scalars = &scalars; // too narrow a picture for a legend
        const Image image = draw(subject, options);
        const Pixel low = image.at(size / 8, size / 2);
        const Pixel high = image.at(size * 7 / 8, size / 2);
        EXPECT_GT(low.blue, low.green);
        EXPECT_GT(high.green, high.blue + 40);
    }
}

TEST(Draw, KeepsTheSizeWithALegend) {
    const TriangleMesh mesh = shapes::sphere(1, 12);
    Scalars scalars{"curvature", MeshAttribute::Domain::vertex, mean_curvatures(mesh.positions, mesh.faces), 0, 2};
    DrawOptions options;
    options.scalars = &scalars;
    options.width = 700;
    options.height = 300;
    const Image image = draw({mesh.positions, mesh.faces, {}, 1}, options);
    EXPECT_EQ(image.width(), 700);
    EXPECT_EQ(image.height(), 300);
}

TEST(Draw, BearsEmptyAndSpoiltInput) {
    const TriangleMesh empty{Positions(3, 0), {}, {}};
    const Image nothing = draw({empty.positions, empty.faces, {}, 1}, DrawOptions{});
    EXPECT_GT(covered_pixels(nothing, background_only(DrawOptions{})), 100); // the words

    TriangleMesh mesh = shapes::sphere(1, 20);
    const Image whole = draw({mesh.positions, mesh.faces, {}, 1}, small(0, 0));
    mesh.positions(2, 210) = std::nan("");
    mesh.positions(0, 400) = std::numeric_limits<double>::infinity();
    mesh.faces.push_back({0, 0, 0});
    mesh.faces.push_back({1, 2, 1});
    const Image spoilt = draw({mesh.positions, mesh.faces, {}, 1}, small(0, 0));
    int different = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            different += difference(spoilt.at(x, y), whole.at(x, y)) > 40;
    EXPECT_LT(different, size * size / 10);

    mesh.positions.setConstant(std::nan(""));
    EXPECT_EQ(draw({mesh.positions, mesh.faces, {}, 1}, small(0, 0)).width(), size);
    DrawOptions pixel;
    pixel.width = pixel.height = 1;
    const TriangleMesh sheet = shapes::square(1);
    EXPECT_EQ(draw({sheet.positions, sheet.faces, {}, 1}, pixel).height(), 1);
}

TEST(FramingPoints, KeepAWideFloorFromShrinkingTheBodies) {
    TriangleMesh mesh = shapes::sphere(1, 10);
    std::vector<int> body(mesh.faces.size(), 0);
    TriangleMesh floor = shapes::square(1);
    floor.positions *= 1000;
    shapes::append(mesh, floor);
    body.resize(mesh.faces.size(), 1);
    const Positions points = framing_points({mesh.positions, mesh.faces, body, 1});
    EXPECT_LT(points.cwiseAbs().maxCoeff(), 2);
    const Positions alone = framing_points({mesh.positions, mesh.faces, body, 0}); // obstacles only
    EXPECT_EQ(alone.cwiseAbs().maxCoeff(), 1000);
}

TEST(FramingPoints, LeaveOutVerticesOfNoFace) {
    TriangleMesh mesh = shapes::square(1);
    shapes::append(mesh, {Positions::Constant(3, 1, 50), {}, {}});
    EXPECT_EQ(framing_points({mesh.positions, mesh.faces, {}, 1}).cols(), 4);
}

} // namespace
} // namespace plisse
