#include <plisse/spatial/intersections.h>

#include <gtest/gtest.h>

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>

#include <plisse/base/random.h>

namespace plisse {
namespace {

using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;

Positions points(std::initializer_list<Vec3> list) {
    Positions result(3, static_cast<int>(list.size()));
    int i = 0;
    for (const Vec3& p : list)
        result.col(i++) = p;
    return result;
}

/// Holds in either order and for every rotation of the corners.
bool meet(const Positions& x, const Face& a, const Face& b) {
    const bool answer = faces_intersect(x, a, b);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const Face turned_a = {a[i], a[(i + 1) % 3], a[(i + 2) % 3]};
            const Face turned_b = {b[(j + 2) % 3], b[(j + 1) % 3], b[j]};
            EXPECT_EQ(faces_intersect(x, turned_a, turned_b), answer);
            EXPECT_EQ(faces_intersect(x, turned_b, turned_a), answer);
        }
    return answer;
}

Exact::Point_3 exact_point(const Vec3& p) {
    return {p.x(), p.y(), p.z()};
}
Exact::Triangle_3 exact_triangle(const Positions& x, const Face& f) {
    return {exact_point(x.col(f[0])), exact_point(x.col(f[1])), exact_point(x.col(f[2]))};
}

bool is_degenerate(const Positions& x, const Face& f) {
    return exact_triangle(x, f).is_degenerate();
}

/// By constructing the intersection in rational numbers.
bool meet_beyond_shared(const Positions& x, const Face& a, const Face& b, const std::vector<int>& shared) {
    const auto result = CGAL::intersection(exact_triangle(x, a), exact_triangle(x, b));
    if (!result)
        return false;
    if (shared.empty())
        return true;
    if (shared.size() == 1) {
        const auto* point = boost::get<Exact::Point_3>(&*result);
        return !(point && *point == exact_point(x.col(shared[0])));
    }
    const auto* segment = boost::get<Exact::Segment_3>(&*result);
    const Exact::Segment_3 edge(exact_point(x.col(shared[0])), exact_point(x.col(shared[1])));
    return !(segment && (*segment == edge || *segment == edge.opposite()));
}

Positions lattice_points(Random& random, int count, int cells) {
    Positions x(3, count);
    for (int i = 0; i < x.size(); ++i)
        x(i) = random.below(cells + 1);
    return x;
}

void compare_with_construction(const Face& a, const Face& b, const std::vector<int>& shared, int cells, bool flat) {
    Random random(7);
    int met = 0, apart = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        Positions x = lattice_points(random, 6, cells);
        if (flat)
            x.row(1) = x.row(0) + 2 * x.row(2);
        if (is_degenerate(x, a) || is_degenerate(x, b))
            continue;
        const bool expected = meet_beyond_shared(x, a, b, shared);
        ASSERT_EQ(faces_intersect(x, a, b), expected) << x;
        ASSERT_EQ(faces_intersect(x, b, a), expected) << x;
        (expected ? met : apart)++;
    }
    EXPECT_GT(met, 100);
    EXPECT_GT(apart, 100);
}

TEST(FacesIntersect, AgreesWithConstructionForUnconnectedFaces) {
    compare_with_construction({0, 1, 2}, {3, 4, 5}, {}, 3, false);
    compare_with_construction({0, 1, 2}, {3, 4, 5}, {}, 40, false);
    compare_with_construction({0, 1, 2}, {3, 4, 5}, {}, 7, true);
}

TEST(FacesIntersect, AgreesWithConstructionForVertexNeighbours) {
    compare_with_construction({0, 1, 2}, {3, 1, 4}, {1}, 3, false);
    compare_with_construction({0, 1, 2}, {3, 1, 4}, {1}, 7, true);
}

TEST(FacesIntersect, AgreesWithConstructionForEdgeNeighbours) {
    compare_with_construction({0, 1, 2}, {2, 1, 3}, {1, 2}, 1, false);
    compare_with_construction({0, 1, 2}, {2, 1, 3}, {1, 2}, 6, true);
}

TEST(FacesIntersect, CrossingAndApart) {
    const Positions x =
        points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.2, .2, -1}, {.2, .2, 1}, {2, 2, 0}, {.2, .2, 1e-300}});
    EXPECT_TRUE(meet(x, {0, 1, 2}, {3, 4, 5}));
    EXPECT_FALSE(meet(x, {0, 1, 2}, {6, 4, 5}));
    const Positions lifted = points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.2, .2, 1e-300}, {.2, .2, 1}, {.3, .2, 1}});
    EXPECT_FALSE(meet(lifted, {0, 1, 2}, {3, 4, 5}));
}

TEST(FacesIntersect, TouchingCountsAsMeeting) {
    Positions x = points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.25, .25, 0}, {.2, .2, 1}, {.3, .2, 1}});
    EXPECT_TRUE(meet(x, {0, 1, 2}, {3, 4, 5})); // corner on the inside
    x.col(3) = Vec3(.5, .5, 0);
    EXPECT_TRUE(meet(x, {0, 1, 2}, {3, 4, 5})); // corner on an edge
    x.col(3) = Vec3(1, 0, 0);
    EXPECT_TRUE(meet(x, {0, 1, 2}, {3, 4, 5})); // corner on a corner that is another vertex
    x.col(3) = Vec3(std::nextafter(1.0, 2.0), 0, 0);
    EXPECT_FALSE(meet(x, {0, 1, 2}, {3, 4, 5})); // one unit in the last place beyond it
}

TEST(FacesIntersect, OneRoundingAboveATiltedPlaneIsApart) {
    Random random(3);
    for (int trial = 0; trial < 200; ++trial) {
        Positions x(3, 6);
        for (int i = 0; i < x.size(); ++i)
            x(i) = random.uniform(-1, 1);
        x.col(3) = (x.col(0) + x.col(1) + x.col(2)) / 3; // on the plane but for its rounding
        const Face a = {0, 1, 2}, b = {3, 4, 5};
        ASSERT_EQ(faces_intersect(x, a, b), meet_beyond_shared(x, a, b, {}));
    }
}

TEST(FacesIntersect, EdgeNeighbours) {
    const Positions x =
        points({{0, 0, 0}, {1, 0, 0}, {.5, 1, 0}, {.5, -1, 0}, {.4, 2, 0}, {.5, 1, 1e-200}, {.5, .5, 0}});
    EXPECT_FALSE(meet(x, {0, 1, 2}, {1, 0, 3})); // flat
    EXPECT_TRUE(meet(x, {0, 1, 2}, {1, 0, 4}));  // folded onto each other
    EXPECT_TRUE(meet(x, {0, 1, 2}, {1, 0, 6}));  // one inside the other
    EXPECT_FALSE(meet(x, {0, 1, 2}, {1, 0, 5})); // folded by all but a hair
    EXPECT_TRUE(meet(x, {0, 1, 2}, {2, 0, 1}));  // the same face twice
}

TEST(FacesIntersect, VertexNeighbours) {
    const Positions x =
        points({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {-1, 0, 0}, {-1, -1, 0}, {1, 1, 1}, {1, 1, -1}, {1, 0, 0}, {0, 0, 1}});
    EXPECT_FALSE(meet(x, {0, 1, 2}, {0, 3, 4})); // flat fan
    EXPECT_TRUE(meet(x, {0, 1, 2}, {0, 5, 6}));  // cuts through along the diagonal
    EXPECT_TRUE(meet(x, {0, 1, 2}, {0, 7, 8}));  // a corner on an edge
    EXPECT_FALSE(meet(x, {0, 1, 2}, {0, 3, 8}));
}

TEST(FacesIntersect, DegenerateFaces) {
    const Positions x = points({{0, 0, 0},
                                {2, 0, 0},
                                {0, 2, 0},
                                {.5, .5, -1},
                                {.5, .5, 0},
                                {.5, .5, 1},
                                {0, 0, 1},
                                {1, 0, 1},
                                {2, 0, 1},
                                {1, 0, 1},
                                {.5, .5, 0},
                                {1, -1, 1}});
    EXPECT_TRUE(meet(x, {0, 1, 2}, {3, 4, 5}));   // a segment through the face
    EXPECT_FALSE(meet(x, {0, 1, 2}, {6, 7, 8}));  // a segment beside it
    EXPECT_TRUE(meet(x, {6, 7, 8}, {9, 11, 3}));  // a corner on a segment
    EXPECT_FALSE(meet(x, {6, 7, 8}, {0, 1, 11})); // a segment and a face apart
    const Positions dots = points({{.5, .5, 0}, {.5, .5, 0}, {.5, .5, 0}, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {3, 3, 3}});
    EXPECT_TRUE(meet(dots, {0, 1, 2}, {3, 4, 5})); // a point on the face
    EXPECT_FALSE(meet(dots, {0, 1, 2}, {4, 5, 6}));
}

TEST(IntersectingPairs, AgreeWithAllPairs) {
    Random random(11);
    for (int trial = 0; trial < 20; ++trial) {
        const Positions x = lattice_points(random, 40, 12);
        std::vector<Face> faces;
        while (faces.size() < 60) {
            const Face f = {random.below(40), random.below(40), random.below(40)};
            if (f[0] != f[1] && f[1] != f[2] && f[2] != f[0])
                faces.push_back(f);
        }
        const auto skip = [](int a, int b) { return (a + b) % 5 == 0; };
        std::vector<std::array<int, 2>> expected;
        for (int a = 0; a < 60; ++a)
            for (int b = a + 1; b < 60; ++b)
                if (!skip(a, b) &&
                    faces_intersect(x, faces[static_cast<std::size_t>(a)], faces[static_cast<std::size_t>(b)]))
                    expected.push_back({a, b});
        EXPECT_EQ(intersecting_pairs(x, faces, skip), expected);
        ASSERT_GT(expected.size(), 10U);
        expected.resize(10);
        EXPECT_EQ(intersecting_pairs(x, faces, skip, 10), expected);
    }
}

TEST(IntersectingPairs, NoneOnATiltedFlatSheet) {
    constexpr int n = 40;
    Positions x(3, n * n);
    std::vector<Face> faces;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            x.col(i * n + j) = i * Vec3(.1, .03, .007) + j * Vec3(-.02, .09, .013) + Vec3(.3, .1, .7);
            if (i + 1 < n && j + 1 < n) {
                faces.push_back({i * n + j, i * n + n + j, i * n + j + 1});
                faces.push_back({i * n + n + j + 1, i * n + j + 1, i * n + n + j});
            }
        }
    EXPECT_TRUE(intersecting_pairs(x, faces).empty());
}

TEST(IntersectingPairs, OfNothing) {
    EXPECT_TRUE(intersecting_pairs(Positions(3, 0), {}).empty());
}

} // namespace
} // namespace plisse
