#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>

#include <Eigen/Geometry>

#include <plisse/contact/candidates.h>
#include <plisse/contact/contact.h>

#include "contact/every_place.h"
#include "contact/sheets.h"
#include "geometry/reference_distance.h"

namespace plisse {
namespace {

constexpr auto pt = StencilKind::point_triangle;
constexpr auto ee = StencilKind::edge_edge;

using Pair = std::pair<StencilKind, std::array<int, 4>>;

/// One configuration: surfaces as they lie now and at rest, and how they move.
struct Configuration {
    std::string name;
    Scene scene;
    Positions rest, motion;
    double distance;
    bool self;

    CollisionMesh mesh() const { return scene.mesh(rest); }
};

Positions random_points(Random& random, int count, double size) {
    return jittered(Positions::Zero(3, count), random, size);
}

/// Triangles that cross each other as they like, in several parts, the last an obstacle.
void append_soup(Scene& scene, Random& random) {
    for (int part = 0; part < 4; ++part) {
        std::vector<Face> faces;
        const int count = 6 + random.below(12);
        while (faces.size() < static_cast<std::size_t>(count / 3)) { // some share corners, none an edge
            const int f = static_cast<int>(faces.size());
            faces.push_back({2 * f, 2 * f + 1, 2 * f + 2});
        }
        const int points = 2 * static_cast<int>(faces.size()) + 1;
        scene.append(random_points(random, points, 1), faces, part == 3);
    }
}

/// A sheet folded like a fan and crumpled, so that it is near itself in many places.
void append_crumpled(Scene& scene, Random& random) {
    const double folds = random.uniform(3, 9), width = random.uniform(0.05, 0.3);
    scene.append_sheet(7, [&](double u, double v) -> Vec3 {
        return Vec3(width * std::sin(folds * u), 0.1 * u, v) + 0.03 * random_points(random, 1, 1).col(0);
    });
}

/// Leaves at one spine, crumpled, so that they are near each other along it.
void append_book(Scene& scene, Random& random) {
    const double angle = random.uniform(0.1, 1);
    scene.append_book(3 + random.below(2), 3, [&](int leaf, double u, double v) -> Vec3 {
        return Vec3(0.4 * u * std::cos(angle * leaf), 0.4 * u * std::sin(angle * leaf), v) +
               0.03 * random_points(random, 1, 1).col(0);
    });
    scene.append_sheet(3, [&](double u, double v) { return Vec3(0.5 * u - 0.3, 0.02 - 0.1 * u, v); });
}

/// Layers on top of each other, exactly parallel to each other, some with the same grid, the lowest an obstacle.
void append_layers(Scene& scene, Random& random) {
    const double step = random.uniform(0.01, 0.1);
    for (int layer = 0; layer < 4; ++layer) {
        const double shift = random.below(2) == 0 ? 0 : random.uniform(-0.3, 0.3);
        scene.append_sheet(
            4, [&](double u, double v) { return Vec3(u + shift, step * layer, v - shift); }, layer == 0);
    }
}

Configuration configuration(int number) {
    Random random(static_cast<std::uint64_t>(number));
    constexpr std::array kinds = {std::pair("soup", &append_soup), std::pair("crumpled", &append_crumpled),
                                  std::pair("layers", &append_layers), std::pair("book", &append_book)};
    const auto& [name, append] = kinds[static_cast<std::size_t>(number) % kinds.size()];
    Configuration c{name + std::string(" ") + std::to_string(number), {}, {}, {}, random.uniform(0.01, 0.08), false};
    append(c.scene, random);
    c.self = random.below(4) > 0;
    c.rest = c.scene.x;
    c.rest.row(1) *= random.uniform(1, 10); // further apart at rest, some pairs not far enough to repel at once
    c.motion = random_points(random, static_cast<int>(c.scene.x.cols()), std::pow(10, random.uniform(-2, 0)));
    const double scale = number % 5 == 0 ? std::pow(10, random.uniform(-9, 9)) : 1;
    const double shift = number % 7 == 0 ? 50 * scale : 0;
    for (Positions* p : {&c.scene.x, &c.rest})
        *p = (scale * *p).colwise() + shift * Vec3::Ones();
    c.motion *= scale;
    c.distance *= scale;
    return c;
}

constexpr int configuration_count = 200;

bool may_meet(const Configuration& c, int v, int w) {
    const auto part = [&](int i) { return static_cast<std::size_t>(c.scene.part[static_cast<std::size_t>(i)]); };
    if (c.scene.obstacle[part(v)] != 0 && c.scene.obstacle[part(w)] != 0)
        return false;
    return part(v) != part(w) || c.self;
}

/// All pairs that may meet, in the order of their stencils.
template <typename Visit>
void visit_pairs(const Configuration& c, const CollisionMesh& mesh, const Visit& visit) {
    for (const int v : mesh.vertices)
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            const auto& [a, b, d] = mesh.faces[f];
            if (v != a && v != b && v != d && may_meet(c, v, a))
                visit(Pair{pt, {v, a, b, d}});
        }
    for (std::size_t i = 0; i < mesh.edges.size(); ++i)
        for (std::size_t j = i + 1; j < mesh.edges.size(); ++j) {
            const auto& [a, b] = mesh.edges[i];
            const auto& [d, e] = mesh.edges[j];
            if (std::set{a, b, d, e}.size() == 4 && may_meet(c, a, d))
                visit(Pair{ee, {a, b, d, e}});
        }
}

/// Distances below `beyond` of all pairs, which need not be found.
std::map<Pair, double> near_pairs(const Configuration& c, const CollisionMesh& mesh, const Positions& x,
                                  double beyond) {
    std::map<Pair, double> result;
    visit_pairs(c, mesh, [&](const Pair& pair) {
        const Stencil stencil = gather(x, pair.second);
        if (surely_beyond(beyond, pair.first, stencil))
            return;
        const double distance = reference_distance(pair.first, stencil);
        if (distance < beyond)
            result[pair] = distance;
    });
    return result;
}

std::map<Pair, double> found_pairs(const Candidates& candidates) {
    std::map<Pair, double> result;
    for (const auto kind : {pt, ee})
        for (int i = 0; i < candidates.size(kind); ++i) {
            auto v = candidates.vertices(kind, i);
            if (kind == ee && v > std::array{v[2], v[3], v[0], v[1]})
                v = {v[2], v[3], v[0], v[1]};
            EXPECT_TRUE(result.emplace(Pair{kind, v}, candidates.rest_distance(kind, i)).second) << "found twice";
        }
    return result;
}

TEST(BruteForce, CandidatesHoldEveryNearPairAndNoOther) {
    int near_count = 0, found_count = 0;
    for (int number = 0; number < configuration_count; ++number) {
        const Configuration c = configuration(number);
        SCOPED_TRACE(c.name);
        const CollisionMesh mesh = c.mesh();
        const Positions& x = c.scene.x;
        Candidates candidates(mesh, c.distance, c.self);
        std::set<Pair> allowed;
        visit_pairs(c, mesh, [&](const Pair& pair) { allowed.insert(pair); });
        std::map<Pair, double> found;
        const auto take_found = [&] {
            found = found_pairs(candidates);
            found_count += static_cast<int>(found.size());
            for (const auto& [pair, rest_distance] : found)
                ASSERT_TRUE(allowed.contains(pair));
        };
        const auto check = [&](const Positions& at) {
            ASSERT_TRUE(candidates.contain(at));
            for (const auto& [pair, distance] : near_pairs(c, mesh, at, c.distance)) {
                ++near_count;
                ASSERT_TRUE(found.contains(pair)) << distance;
                const double rest = reference_distance(pair.first, gather(c.rest, pair.second));
                ASSERT_NEAR(found.at(pair), std::min(rest, 2 * c.distance), 1e-9 * c.distance);
            }
        };
        candidates.find_around(x);
        take_found();
        check(x);
        const double share = candidates.find_along(x, c.motion, 1);
        take_found();
        for (const double t : {0.0, 0.4, 1.0})
            check(x + t * share * c.motion);
    }
    EXPECT_GT(near_count, 100'000);
    EXPECT_LT(found_count, 40 * near_count);
}

TEST(BruteForce, LeastDistancesAreNeverTooLarge) {
    for (int number = 0; number < configuration_count; ++number) {
        const Configuration c = configuration(number);
        SCOPED_TRACE(c.name);
        const CollisionMesh mesh = c.mesh();
        const Positions &x = c.scene.x, end = x + c.motion;
        Candidates candidates(mesh, c.distance, c.self);
        candidates.find_along(x, c.motion, 1);
        Candidates::Drift drift;
        candidates.find_drift(x, end, drift);
        for (const auto kind : {pt, ee})
            for (int i = number % 10; i < candidates.size(kind); i += 10)
                for (const Positions& at : {x, Positions(0.5 * (x + end)), end}) {
                    const double distance = reference_distance(kind, gather(at, candidates.vertices(kind, i)));
                    ASSERT_LE(candidates.least_distance(kind, i, drift), distance + 1e-12 * c.distance);
                }
    }
}

TEST(BruteForce, GapsAndEnergiesAgree) {
    int active_count = 0, gap_count = 0, taken_off = 0;
    for (int number = 0; number < configuration_count; ++number) {
        const Configuration c = configuration(number);
        SCOPED_TRACE(c.name);
        ContactOptions options;
        options.distance = c.distance;
        options.self = c.self;
        Contact contact(c.mesh(), options);
        const Positions& x = c.scene.x;

        double energy = 0, scale = 0, gap = std::numeric_limits<double>::infinity();
        EveryPlace(contact.mesh(), options).visit(x, [&](const Place& place) {
            const Stencil stencil = points_of(x, place.vertices);
            const double distance = reference_distance(place.kind, stencil);
            if (place.counts_as_gap && distance < c.distance &&
                (place.kind == pt || reference_mollifier(place, stencil) > 0))
                gap = std::min(gap, distance);
            const double one = reference_energy(place, stencil, options);
            energy += one;
            scale += std::abs(one);
            active_count += one > 0;
            taken_off += one < 0;
        });
        ASSERT_NEAR(contact.value(x), energy, 1e-9 * scale);
        if (std::isfinite(gap)) {
            ++gap_count;
            ASSERT_NEAR(contact.min_gap(x), gap, 1e-11 * c.distance);
        } else {
            ASSERT_EQ(contact.min_gap(x), gap);
        }
    }
    EXPECT_GT(active_count, 5'000);
    EXPECT_GT(taken_off, 500);
    EXPECT_GT(gap_count, 20);
}

} // namespace
} // namespace plisse
