#include <plisse/contact/contact.h>

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include <plisse/base/parallel.h>
#include <plisse/contact/candidates.h>
#include <plisse/contact/pair_energy.h>
#include <plisse/geometry/barrier.h>
#include <plisse/spatial/intersections.h>

#include "contact/every_place.h"
#include "contact/sheets.h"
#include "linalg/dense_system.h"

namespace plisse {
namespace {

constexpr auto pt = StencilKind::point_triangle;
constexpr auto ee = StencilKind::edge_edge;

/// Two sheets of one body each, the first folded over itself, above an obstacle of its own two parts.
Scene folded_scene(double gap) {
    Scene scene;
    scene.append(Positions::Zero(3, 1), {}, false); // a vertex that no face uses
    const auto fold = [=](double u, double v) {
        const double angle = M_PI * std::clamp((u - 0.4) / 0.2, 0.0, 1.0), radius = 0.2 / M_PI;
        const double x = u < 0.4 ? u : u > 0.6 ? 1 - u : 0.4 + radius * std::sin(angle);
        return Vec3(x, u < 0.4 ? 0 : u > 0.6 ? 2 * radius : radius * (1 - std::cos(angle)), v);
    };
    scene.append_sheet(6, [&](double u, double v) -> Vec3 { return fold(u, v).cwiseProduct(Vec3(1, gap / .12, 1)); });
    scene.append_sheet(
        4, [=](double u, double v) { return Vec3(u * .7 + .1, 2.2 * gap + .1 * gap * std::sin(9 * u), .9 * v); });
    scene.append_sheet(
        2, [=](double u, double v) { return Vec3(1.2 * u - .2, -gap, 1.2 * v); }, true);
    scene.append_sheet(
        2, [=](double u, double v) { return Vec3(1.2 * u - .2, -1.4 * gap, 1.1 * v); }, true);
    return scene;
}

struct BruteForce {
    double value = 0, least_gap = std::numeric_limits<double>::infinity();
    int active = 0;
    Positions gradient;
    Eigen::MatrixXd hessian;
};

/// Whether it is one of the pairs that are looked for: not an edge or a vertex by itself.
bool is_pair(const Place& place) {
    return std::set(place.vertices.begin(), place.vertices.end()).size() == 4;
}

/// Of the place's own points, by one formula for all.
Separation separation_of(const Place& place, const Stencil& x) {
    if (place.kind == ee)
        return separate_edges(x);
    if (place.vertices[1] == place.vertices[2])
        return separate_points(x.col(0), x.col(1));
    if (place.vertices[2] == place.vertices[3])
        return separate_point_edge(x.col(0), x.col(1), x.col(2));
    return separate_point_triangle(x);
}

PairParameters parameters_of(const Place& place, const ContactOptions& options) {
    PairParameters p;
    p.scale = place.count * place.area * options.stiffness * place.range.activation;
    p.activation_squared = place.range.activation * place.range.activation;
    for (const int end : place.ends)
        p.ends |= static_cast<std::uint8_t>(1U << end);
    return p;
}

BruteForce evaluate_all(const CollisionMesh& mesh, const ContactOptions& options, const Positions& x) {
    BruteForce result;
    result.gradient = Positions::Zero(3, x.cols());
    result.hessian = Eigen::MatrixXd::Zero(x.size(), x.size());
    EveryPlace(mesh, options).visit(x, [&](const Place& place) {
        const Stencil s = points_of(x, place.vertices);
        const Separation separation = separation_of(place, s);
        const PairParameters p = parameters_of(place, options);
        const double distance = std::sqrt(separation.squared_distance);
        if (place.counts_as_gap && distance < options.distance)
            result.least_gap = std::min(result.least_gap, distance);
        if (separation.squared_distance >= p.activation_squared)
            return;
        ++result.active;
        result.value += pair_energy(p, separation, s);
        const Vec12 gradient = pair_gradient(p, separation, s);
        const Mat12 hessian = pair_hessian(p, separation, s);
        for (int i = 0; i < 4; ++i) {
            const int v = place.vertices[static_cast<std::size_t>(i)];
            result.gradient.col(v) += gradient.segment<3>(3 * i);
            for (int j = 0; j < 4; ++j)
                result.hessian.block<3, 3>(3 * v, 3 * place.vertices[static_cast<std::size_t>(j)]) +=
                    hessian.block<3, 3>(3 * i, 3 * j);
        }
    });
    return result;
}

NewtonSystem system_of(Contact& contact, const Positions& x, bool project = true) {
    NewtonSystem system(std::vector<std::uint8_t>(static_cast<std::size_t>(x.size()), 0), contact.mesh().edges);
    system.set_prescribed_step(VecX::Zero(x.size()));
    system.begin(contact.coupled_pairs(x));
    contact.add_hessian(x, system, project);
    return system;
}

Positions gradient_of(Contact& contact, const Positions& x) {
    Positions gradient = Positions::Zero(3, x.cols());
    contact.add_gradient(x, gradient);
    return gradient;
}

TEST(Contact, AgreesWithEveryPlace) {
    constexpr double gap = 0.05;
    const Scene scene = folded_scene(gap);
    Random random(1);
    Positions rest = jittered(scene.x, random, 0.3 * gap); // apart, but not all out of each other's reach
    rest.row(1) *= 3;
    for (const bool self : {true, false}) {
        ContactOptions options;
        options.distance = gap;
        options.stiffness = 1e3;
        options.self = self;
        Contact contact(scene.mesh(rest), options);
        int active = 0;
        for (int trial = 0; trial < 30; ++trial) {
            // Now and then a leap that leaves the regions, otherwise a small move within them.
            const Positions x = jittered(scene.x, random, trial % 3 ? 0.02 * gap : 0.5 * gap);
            const BruteForce expected = evaluate_all(contact.mesh(), options, x);
            active += expected.active;
            EXPECT_LE(contact.active_pair_count(x), expected.active);
            EXPECT_NEAR(contact.value(x), expected.value, 1e-12 * expected.value);
            EXPECT_LE((gradient_of(contact, x) - expected.gradient).norm(), 1e-12 * expected.gradient.norm());
            EXPECT_LE((dense(system_of(contact, x, false)) - expected.hessian).norm(), 1e-12 * expected.hessian.norm());
            EXPECT_DOUBLE_EQ(contact.min_gap(x), expected.least_gap);
        }
        EXPECT_GT(active, 300);
    }
}

TEST(Contact, GradientIsTheDerivativeOfTheValue) {
    constexpr double gap = 0.05;
    const Scene scene = folded_scene(gap);
    Random random(2);
    ContactOptions options;
    options.distance = gap;
    Positions rest = scene.x;
    rest.row(1) *= 3;
    Contact contact(scene.mesh(rest), options);
    for (int trial = 0; trial < 5; ++trial) {
        const Positions x = jittered(scene.x, random, 0.05 * gap), d = jittered(0 * x, random, 1);
        ASSERT_GT(contact.value(x), 0);
        constexpr double step = 1e-8;
        const double difference = (contact.value(x + step * d) - contact.value(x - step * d)) / (2 * step);
        const double slope = gradient_of(contact, x).cwiseProduct(d).sum();
        EXPECT_NEAR(slope, difference, 1e-5 * gradient_of(contact, x).norm());
    }
}

TEST(Candidates, HoldEveryNearPairWhileVerticesStayInTheirRegions) {
    constexpr double gap = 0.05;
    const Scene scene = folded_scene(gap);
    const CollisionMesh mesh = scene.mesh();
    Random random(3);
    Candidates candidates(mesh, gap, true);
    EXPECT_FALSE(candidates.contain(scene.x));
    const EveryPlace every_place(mesh, {.distance = gap});
    for (int trial = 0; trial < 20; ++trial) {
        const Positions x = jittered(scene.x, random, gap), d = jittered(0 * x, random, 3 * gap);
        const double share = candidates.find_along(x, d, 1);
        std::set<std::pair<StencilKind, std::array<int, 4>>> found;
        for (const auto kind : {pt, ee})
            for (int i = 0; i < candidates.size(kind); ++i) {
                auto v = candidates.vertices(kind, i);
                if (kind == ee && v > std::array<int, 4>{v[2], v[3], v[0], v[1]})
                    v = {v[2], v[3], v[0], v[1]};
                EXPECT_TRUE(found.insert({kind, v}).second);
            }
        for (const double t : {0.0, 0.37, 1.0}) {
            const Positions at = jittered(x + t * share * d, random, 0.4 * gap);
            ASSERT_TRUE(candidates.contain(at));
            int near = 0;
            every_place.visit(at, [&](const Place& place) {
                if (is_pair(place) && separate(place.kind, gather(at, place.vertices)).squared_distance < gap * gap) {
                    ++near;
                    EXPECT_TRUE(found.contains({place.kind, place.vertices}));
                }
            });
            EXPECT_GT(near, 20);
        }
        EXPECT_FALSE(candidates.contain(x + 3 * share * d));
    }
}

bool skips_obstacles(const Scene& scene, int f, int g) {
    const auto on_obstacle = [&](int face) {
        return scene.obstacle[static_cast<std::size_t>(
                   scene.part[static_cast<std::size_t>(scene.faces[static_cast<std::size_t>(face)][0])])] != 0;
    };
    return on_obstacle(f) && on_obstacle(g);
}

bool intersects(const Scene& scene, const Positions& x) {
    return !intersecting_pairs(
                x, scene.faces, [&](int f, int g) { return skips_obstacles(scene, f, g); }, 1)
                .empty();
}

TEST(Contact, StepsUpToTheLimitMakeNoIntersection) {
    constexpr double gap = 0.05;
    const Scene scene = folded_scene(gap);
    Random random(4);
    ContactOptions options;
    options.distance = gap;
    Contact contact(scene.mesh(), options);
    const EveryPlace all(contact.mesh(), options);
    int limited = 0, blocked = 0;
    for (int trial = 0; trial < 40; ++trial) {
        const double speed = gap * std::pow(10.0, random.uniform(-1, 2));
        const Positions x = jittered(scene.x, random, 0.02 * gap), d = jittered(0 * x, random, speed);
        ASSERT_FALSE(intersects(scene, x));
        const double alpha = contact.max_step(x, d);
        ASSERT_GT(alpha, 0);
        limited += alpha < 1;
        for (int k = 1; k <= 40; ++k)
            ASSERT_FALSE(intersects(scene, x + alpha * k / 40 * d)) << trial;
        const Positions end = x + alpha * d;
        all.visit(end, [&](const Place& place) {
            const double before = std::sqrt(separate(place.kind, gather(x, place.vertices)).squared_distance);
            const double after = std::sqrt(separate(place.kind, gather(end, place.vertices)).squared_distance);
            ASSERT_GE(after, std::min(options.ccd_ratio * before, gap) * (1 - 1e-12));
        });
        for (int k = 1; alpha < 1 && k <= 20; ++k)
            if (intersects(scene, x + std::min(1.0, alpha * (1 + 0.1 * k)) * d)) {
                ++blocked; // the limit was there for a reason
                break;
            }
    }
    EXPECT_GT(limited, 20);
    EXPECT_GT(blocked, 5);
}

TEST(Contact, LongFallsInPiecesAreCheckedAllTheWay) {
    Scene scene;
    scene.append_sheet(24, [](double u, double v) { return Vec3(u, v, 1e-3 * std::sin(40 * u * v)); });
    scene.append_sheet(
        1, [](double u, double v) { return Vec3(20 * u - 5, -1.2, 20 * v - 5); }, true);
    ContactOptions options;
    options.distance = 1e-3;
    Contact contact(scene.mesh(), options);
    Positions d = Positions::Zero(3, scene.x.cols());
    d.leftCols(25 * 25).colwise() = Vec3(0.3, -3, 0.2); // within its own plane, so all boxes overlap along the way
    const double alpha = contact.max_step(scene.x, d);
    EXPECT_NEAR(3 * alpha, 1.2 - options.distance, 1e-7); // as near as the contact distance, a share of the way there
    EXPECT_FALSE(intersects(scene, scene.x + alpha * d));
    d *= 0.3;
    EXPECT_EQ(contact.max_step(scene.x, d), 1);
    Candidates candidates(contact.mesh(), options.distance, true);
    EXPECT_LT(candidates.find_along(scene.x, d, 1), 1);
    EXPECT_LE(candidates.size(pt), 100 * scene.x.cols());
    EXPECT_LE(candidates.size(ee), 100 * scene.x.cols());
}

TEST(Contact, NamesThePairThatLimitsAStep) {
    Scene scene;
    scene.append_sheet(4, [](double u, double v) { return Vec3(u, 0, v); });
    scene.append_sheet(
        1, [](double u, double v) { return Vec3(20 * u - 7, -1, 20 * v - 5); }, true);
    ContactOptions options;
    Contact contact(scene.mesh(), options);
    Positions d = Positions::Zero(3, scene.x.cols());
    d.col(7) = Vec3(0, -2, 0);
    const auto pair = contact.limiting_pair(scene.x, d);
    ASSERT_TRUE(pair.has_value());
    EXPECT_EQ(pair->kind, pt);
    EXPECT_EQ(pair->primitives[0], 7);
    EXPECT_GE(pair->primitives[1], 32); // of the plane
    EXPECT_EQ(pair->step, contact.max_step(scene.x, d));
    EXPECT_LT(pair->step, 0.5);
    EXPECT_NEAR(pair->gap, 1, 1e-12);
    EXPECT_LT((pair->place - (scene.x.col(7) - Vec3(0, 0.5, 0))).norm(), 1e-12);
    EXPECT_FALSE(contact.limiting_pair(scene.x, 0.1 * d).has_value());
}

TEST(Contact, FollowsThePointsThroughManySteps) {
    // Candidates found earlier are reused: a long walk must stay free of intersections with one object for all steps.
    constexpr double gap = 0.05;
    const Scene scene = folded_scene(gap);
    Random random(5);
    ContactOptions options;
    options.distance = gap;
    Contact contact(scene.mesh(), options);
    Positions x = scene.x;
    for (int step = 0; step < 150; ++step) {
        const Positions d = jittered(0 * x, random, (step % 7 ? 0.1 : 2) * gap);
        x += contact.max_step(x, d) * d;
        ASSERT_FALSE(intersects(scene, x)) << step;
        ASSERT_TRUE(std::isfinite(contact.value(x)));
    }
}

TEST(Contact, ResultsDoNotDependOnThreads) {
    Scene scene;
    for (int k = 0; k < 4; ++k)
        scene.append_sheet(20, [=](double u, double v) { return Vec3(u, 0.8e-3 * k, v); });
    Random random(6);
    const Positions x = jittered(scene.x, random, 1e-4), d = jittered(0 * x, random, 0.01);
    ContactOptions options;
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        Positions rest = scene.x;
        rest.row(1) *= 10;
        Contact contact(scene.mesh(rest), options);
        return std::tuple(contact.value(x), gradient_of(contact, x), system_of(contact, x).blocks(),
                          contact.max_step(x, d), contact.limiting_pair(x, d)->primitives, contact.coupled_pairs(x));
    };
    const auto one = run(1), two = run(2);
    EXPECT_GT(std::get<0>(one), 0);
    EXPECT_LT(std::get<3>(one), 1);
    EXPECT_EQ(one, two);
}

TEST(Contact, SilentAtRestHoweverCrumpled) {
    constexpr double gap = 0.05;
    const Scene scene = folded_scene(0.3 * gap);
    Random random(7);
    const Positions rest = jittered(scene.x, random, 0.02 * gap);
    ContactOptions options;
    options.distance = gap;
    Contact contact(scene.mesh(rest), options);
    int near = 0;
    EveryPlace(contact.mesh(), options).visit(rest, [&](const Place& place) {
        near += is_pair(place) && separate(place.kind, gather(rest, place.vertices)).squared_distance < gap * gap;
    });
    ASSERT_GT(near, 100);
    EXPECT_EQ(contact.value(rest), 0);
    EXPECT_EQ(gradient_of(contact, rest), Positions::Zero(3, rest.cols()));
    EXPECT_EQ(contact.active_pair_count(rest), 0);
    EXPECT_EQ(contact.active_pair_count(jittered(rest, random, 0.001 * gap)), 0); // and a little around it
}

/// Pressure that a sheet of n/2 cells, turned within its plane, feels over a larger one of n cells, relative to the
/// slope of one barrier. The contact distance is `share` of a cell, the height `height` of that distance.
double relative_pressure(int n, double share, double height) {
    ContactOptions options;
    options.distance = share / n;
    options.stiffness = 7;
    Scene scene;
    scene.append_sheet(n, [](double u, double v) { return Vec3(u, 0, v); });
    const double c = std::cos(0.5), s = std::sin(0.5), y = height * options.distance;
    scene.append_sheet(
        n / 2, [=](double u, double v) { return Vec3(.5 * (c * u - s * v) + .4, y, .5 * (s * u + c * v) + .2); });
    Positions apart = scene.x;
    apart.row(1) *= 1000;
    Contact contact(scene.mesh(apart), options);
    const double force = -gradient_of(contact, scene.x).row(1).tail((n / 2 + 1) * (n / 2 + 1)).sum();
    const double slope = 2 * height * std::abs(barrier(height * height).first);
    return force / (0.25 * options.stiffness * slope);
}

TEST(Contact, PressureBetweenSheetsIsThatOfOneBarrierHoweverFineTheyAre) {
    for (const double height : {0.3, 0.6, 0.9})
        for (const double share : {0.1, 0.33}) {
            const double coarse = relative_pressure(12, share, height), fine = relative_pressure(48, share, height);
            EXPECT_NEAR(coarse, fine, 0.03 * fine); // the rim of the coarse sheet weighs more
            EXPECT_GT(fine, share == 0.1 ? 0.95 : 0.85);
            EXPECT_LT(fine, 1.1);
        }
}

TEST(Contact, BodiesFarApartFeelNothing) {
    Scene scene;
    scene.append_sheet(3, [](double u, double v) { return Vec3(u, 0, v); });
    scene.append_sheet(
        3, [](double u, double v) { return Vec3(u, 1, v); }, true);
    Contact contact(scene.mesh(), {});
    EXPECT_EQ(contact.value(scene.x), 0);
    EXPECT_TRUE(contact.coupled_pairs(scene.x).empty());
    EXPECT_EQ(contact.min_gap(scene.x), std::numeric_limits<double>::infinity());
    EXPECT_EQ(contact.max_step(scene.x, Positions::Ones(3, scene.x.cols())), 1);
}

TEST(Contact, ObstaclesNeverMeetEachOther) {
    Scene scene;
    scene.append_sheet(
        3, [](double u, double v) { return Vec3(u, 0, v); }, true);
    scene.append_sheet(
        3, [](double u, double v) { return Vec3(u, 1e-4, v); }, true);
    Positions apart = scene.x;
    apart.row(1) *= 1e5;
    Contact contact(scene.mesh(apart), {});
    EXPECT_EQ(contact.value(scene.x), 0);
    EXPECT_EQ(contact.max_step(scene.x, Positions::Random(3, scene.x.cols())), 1);
}

} // namespace
} // namespace plisse
