#include <plisse/contact/friction.h>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "contact/sheets.h"
#include "linalg/dense_system.h"

namespace plisse {
namespace {

constexpr double slip = 1e-3;

/// A small sheet over a large fixed one, near enough to press, both bent so that normals differ.
struct Rub {
    Rub() {
        const auto bent = [](double x, double y, double z) { return Vec3(x, y + 0.02 * x * z, z); };
        scene.append_sheet(3, [=](double u, double v) { return bent(u - .5, .008, v - .5); });
        scene.append_sheet(
            4, [=](double u, double v) { return bent(2 * u - 1, 0, 2 * v - 1); }, true);
        Positions rest = scene.x; // far apart at rest
        for (int v = 0; v < rest.cols(); ++v)
            if (scene.part[static_cast<std::size_t>(v)] == 1)
                rest(1, v) -= 1;
        mesh = scene.mesh(rest);
        ContactOptions options;
        options.distance = 0.02;
        options.stiffness = 1e4;
        contact = std::make_unique<Contact>(mesh, options);
    }
    Friction friction(double mu, double other = 0) const { return {mesh, {slip, {other, mu, mu, other}}}; }
    Friction lagged(double mu, const Positions& reference) {
        Friction result = friction(mu);
        result.begin({reference, {}});
        result.lag(contact->active_pairs(scene.x), scene.x);
        return result;
    }
    Positions shifted(const Vec3& by) const {
        Positions x = scene.x;
        for (int v = 0; v < x.cols(); ++v)
            if (scene.part[static_cast<std::size_t>(v)] == 0)
                x.col(v) += by;
        return x;
    }

    Scene scene;
    CollisionMesh mesh;
    std::unique_ptr<Contact> contact;
};

Positions force_of(const Friction& friction, const Positions& x) {
    Positions gradient = Positions::Zero(3, x.cols());
    friction.add_gradient(x, gradient);
    return gradient;
}

double total_normal_force(Rub& rub) {
    double sum = 0;
    for (const ActivePair& pair : rub.contact->active_pairs(rub.scene.x))
        sum += pair_normal_force(pair.parameters, pair.separation, gather(rub.scene.x, pair.vertices));
    return sum;
}

TEST(Friction, NormalForceIsTheBarriersSlopeAlongTheNormal) {
    Rub rub;
    const auto& pairs = rub.contact->active_pairs(rub.scene.x);
    ASSERT_GT(pairs.size(), 20u);
    for (const ActivePair& pair : pairs) {
        const Stencil x = gather(rub.scene.x, pair.vertices);
        const Vec12 gradient = pair_gradient(pair.parameters, pair.separation, x);
        Vec3 on_first = gradient.head<3>();
        if (pair.kind == StencilKind::edge_edge)
            on_first += gradient.segment<3>(3);
        // The mollifier's own slope acts on the edges' directions only, and sums up to nothing.
        EXPECT_NEAR(-on_first.dot(pair.separation.offset.normalized()),
                    pair_normal_force(pair.parameters, pair.separation, x), 1e-9 * on_first.norm() + 1e-15);
    }
}

TEST(Friction, DerivativesMatchCentralDifferences) {
    Rub rub;
    Random random(3);
    for (double size : {0.1 * slip, 0.7 * slip, 5 * slip}) {
        const Friction friction = rub.lagged(0.4, jittered(rub.scene.x, random, size));
        const Positions x = rub.scene.x;
        Positions gradient = Positions::Zero(3, x.cols());
        friction.add_gradient(x, gradient);
        std::vector<Edge> pairs(rub.mesh.edges);
        friction.append_coupled_pairs(pairs);
        NewtonSystem system(std::vector<std::uint8_t>(static_cast<std::size_t>(x.size()), 0), {});
        for (int v = 0; v < x.cols(); ++v)
            pairs.push_back({v, v});
        system.begin(pairs);
        friction.add_hessian(x, system);
        const Eigen::MatrixXd hessian = dense(system);
        const Positions direction = jittered(Positions::Zero(3, x.cols()), random, 1);
        const double step = 1e-6 * slip;
        const double slope = (friction.value(x + step * direction) - friction.value(x - step * direction)) / (2 * step);
        EXPECT_NEAR(gradient.cwiseProduct(direction).sum(), slope, 1e-6 * gradient.norm() * direction.norm());
        Positions ahead = Positions::Zero(3, x.cols()), behind = ahead;
        friction.add_gradient(x + step * direction, ahead);
        friction.add_gradient(x - step * direction, behind);
        const VecX change = as_vector(Positions((ahead - behind) / (2 * step)));
        EXPECT_LT((hessian * as_vector(direction) - change).norm(), 1e-6 * change.norm());
        EXPECT_GT(hessian.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-9 * hessian.norm());
    }
}

TEST(Friction, OpposesTheSlipWithItsLimitBeyondIt) {
    Rub rub;
    const Vec3 motion = 10 * slip * Vec3(1, 0, 0);
    const Friction friction = rub.lagged(0.3, rub.shifted(-motion));
    Positions gradient = Positions::Zero(3, rub.scene.x.cols());
    friction.add_gradient(rub.scene.x, gradient);
    Vec3 on_body = Vec3::Zero();
    for (int v = 0; v < gradient.cols(); ++v)
        if (rub.scene.part[static_cast<std::size_t>(v)] == 0)
            on_body += gradient.col(v);
    const double limit = 0.3 * total_normal_force(rub);
    EXPECT_GT(on_body.x(), 0.98 * limit); // normals lean by 0.05 at most
    EXPECT_LE(on_body.norm(), limit * (1 + 1e-12));
    EXPECT_LT(gradient.rowwise().sum().norm(), 1e-12 * limit); // and as much on the obstacle
}

TEST(Friction, MixesForcesByTheirShares) {
    Rub rub;
    const Positions reference = rub.scene.x, lower = rub.shifted(Vec3(0, -1e-3, 0)), at = rub.shifted(Vec3(1e-4, 0, 0));
    const auto gradient = [&](const Friction& friction) { return force_of(friction, at); };
    const auto lagged_at = [&](const Positions& x) {
        Friction friction = rub.friction(0.5);
        friction.begin({reference, {}});
        friction.lag(rub.contact->active_pairs(x), x);
        return friction;
    };
    Friction mixed = lagged_at(reference);
    const Positions first = gradient(mixed), second = gradient(lagged_at(lower));
    EXPECT_GT((first - second).norm(), 0.1 * first.norm());
    mixed.lag(rub.contact->active_pairs(lower), lower, 1, 0.25);
    EXPECT_LT((gradient(mixed) - 0.75 * first - 0.25 * second).norm(), 1e-12 * first.norm());
    mixed.lag(rub.contact->active_pairs(lower), lower, 1, 1);
    EXPECT_EQ(gradient(mixed), second);
}

TEST(Friction, IsNotFeltWhereNoCoefficientSays) {
    Rub rub;
    EXPECT_FALSE(rub.friction(0).possible());
    EXPECT_TRUE(rub.friction(0.1).possible());
    Friction self_only = rub.friction(0, 0.5);
    self_only.begin({rub.shifted(Vec3(0.1, 0, 0)), {}});
    self_only.lag(rub.contact->active_pairs(rub.scene.x), rub.scene.x);
    EXPECT_EQ(self_only.value(rub.scene.x), 0);
}

TEST(Friction, RemembersWhereContactsStickOverSteps) {
    Rub rub;
    std::vector<ActivePair> pairs = rub.contact->active_pairs(rub.scene.x);
    // The force of two edges changes as they move along each other.
    std::erase_if(pairs, [](const ActivePair& pair) { return pair.kind == StencilKind::edge_edge; });
    Friction friction = rub.friction(0.3);
    friction.begin({rub.scene.x, {}});
    friction.lag(pairs, rub.scene.x);
    friction.remember(pairs, rub.scene.x);
    // A slip of five times e to a new place with the same contacts: what is beyond e is given up, the force stays.
    const Vec3 motion = 5 * slip * Vec3(0, 0, 1);
    const Positions before = force_of(friction, rub.shifted(motion));
    friction.remember(pairs, rub.shifted(motion));
    Friction next = rub.friction(0.3);
    next.begin(friction.memory());
    next.lag(pairs, rub.shifted(motion));
    const Positions after = force_of(next, rub.shifted(motion));
    EXPECT_LT((after - before).norm(), 1e-3 * before.norm()); // normal forces are of one shape of the surfaces
    // Back by half of e: a contact that had kept its first reference would still pull with all its force.
    const Positions back = force_of(next, rub.shifted(motion - 0.5 * slip * Vec3(0, 0, 1)));
    EXPECT_NEAR(back.norm() / after.norm(), 0.75, 0.02); // f1(e/2)
}

TEST(Friction, ForgetsTheWayOnWhichContactsHaveCome) {
    Rub rub;
    const Positions& x = rub.scene.x;
    Friction friction = rub.friction(0.3);
    friction.begin({rub.shifted(Vec3(-0.1, 0.3, -0.05)), {}});
    friction.remember(rub.contact->active_pairs(x), x);
    friction.lag(rub.contact->active_pairs(x), x);
    const Positions before = force_of(friction, x);
    // All turn a little together, and forces with them.
    const Mat3 turn = Eigen::AngleAxisd(0.02, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const Positions turned = turn * x;
    friction.lag(rub.contact->active_pairs(turned), turned);
    EXPECT_LT((force_of(friction, turned) - turn * before).norm(), 0.2 * before.norm()); // a gap's turn is a slip
}

ActivePair point_on_a_triangle(Rub& rub) {
    for (const ActivePair& pair : rub.contact->active_pairs(rub.scene.x))
        if (pair.kind == StencilKind::point_triangle && pair.parameters.scale > 0)
            return pair;
    ADD_FAILURE() << "no such pair";
    return {};
}

TEST(Friction, GoesOnWhereAContactSlidesToOtherPrimitives) {
    Rub rub;
    const ActivePair pair = point_on_a_triangle(rub);
    const auto [point, face] = pair.primitives;
    const auto force_with_memory = [&](StencilKind kind, int first, int second, const Vec3& elastic_slip) {
        Friction friction = rub.friction(0.3);
        friction.begin({rub.scene.x, {{kind, {first, second}, elastic_slip}}});
        friction.lag({&pair, 1}, rub.scene.x);
        return force_of(friction, rub.scene.x);
    };
    const Vec3 u(0.5 * slip, 0, 0.2 * slip);
    const Positions known = force_with_memory(StencilKind::point_triangle, point, face, u);
    EXPECT_GT(known.norm(), 0);
    int neighbours = 0, strangers = 0;
    for (int f = 0; f < static_cast<int>(rub.mesh.faces.size()); ++f) {
        if (f == face || rub.mesh.has_corner(f, point))
            continue;
        double shared = 0;
        for (int i = 1; i < 4; ++i)
            if (rub.mesh.has_corner(f, pair.vertices[static_cast<std::size_t>(i)]))
                shared -= pair.separation.weights[i];
        const Positions force = force_with_memory(StencilKind::point_triangle, point, f, u);
        if (shared > 0) {
            ++neighbours;
            EXPECT_EQ(force, known);
        } else {
            ++strangers;
            EXPECT_EQ(force.norm(), 0);
        }
    }
    EXPECT_GT(neighbours, 2);
    EXPECT_GT(strangers, 2);
    // The same place seen as two edges, of which the point's is the second: the motion is the other way round.
    int of_point = -1, of_face = -1;
    for (int e = 0; e < static_cast<int>(rub.mesh.edges.size()); ++e) {
        const Edge& edge = rub.mesh.edges[static_cast<std::size_t>(e)];
        if (edge[0] == point || edge[1] == point)
            of_point = e;
        if (rub.mesh.has_corner(face, edge[0]) && rub.mesh.has_corner(face, edge[1]))
            of_face = e;
    }
    EXPECT_EQ(force_with_memory(StencilKind::edge_edge, of_face, of_point, -u), known);
}

/// A point slides over the valley between two slopes, near the bottom on one and then the other: the slope that it is
/// far from begins to count, and the edge is counted off, without a jump of the force.
TEST(Friction, ChangesContinuouslyWhereFacesBeginToCount) {
    Scene scene;
    scene.append_sheet(
        2, [](double u, double v) { return Vec3(2 * u - 1, 0.3 * std::abs(2 * u - 1), 2 * v - 1); }, true);
    scene.append_sheet(1, [](double u, double v) { return Vec3(0.4 * u - 0.2, 0.05 + u + v, 0.3 + 0.2 * v); });
    // A face that lies across, over the same point: what is counted off in the valley is no business of its.
    scene.append_sheet(
        1, [](double u, double v) { return Vec3(2 * u - 1, 0.1 + 0.01 * u, 2 * v - 1); }, true);
    Positions rest = scene.x;
    for (int v = 0; v < rest.cols(); ++v)
        if (scene.part[static_cast<std::size_t>(v)] != 1)
            rest(1, v) -= 5 + scene.part[static_cast<std::size_t>(v)];
    const CollisionMesh mesh = scene.mesh(rest);
    ContactOptions options;
    options.distance = 0.1;
    options.stiffness = 1e4;
    Contact contact(mesh, options);
    int point = -1;
    for (int v = 0; v < scene.x.cols() && point < 0; ++v)
        if (scene.part[static_cast<std::size_t>(v)] == 1)
            point = v;
    const double e = 1e-3;
    std::vector<double> coefficients(9, 0.3);
    bool counted_off = false, none_counted_off = false;
    Positions last;
    constexpr int count = 400;
    double largest = 0, largest_change = 0;
    for (int i = 0; i <= count; ++i) {
        Positions x = scene.x;
        x.col(point).x() = 0.08 * (2.0 * i / count - 1);
        const auto& pairs = contact.active_pairs(x);
        std::vector<ActivePair> of_point;
        for (const ActivePair& pair : pairs)
            if (pair.kind == StencilKind::point_triangle && pair.primitives[0] == point)
                of_point.push_back(pair);
        const bool now =
            std::any_of(of_point.begin(), of_point.end(), [](const auto& p) { return p.parameters.scale < 0; });
        (now ? counted_off : none_counted_off) = true;
        Friction friction(mesh, {e, coefficients});
        Positions reference = x;
        reference.col(point) -= Vec3(0, 0, 5 * e);
        friction.begin({reference, {}});
        friction.lag(of_point, x);
        const Positions force = force_of(friction, x);
        if (i > 0)
            largest_change = std::max(largest_change, (force - last).norm());
        largest = std::max(largest, force.norm());
        last = force;
    }
    EXPECT_TRUE(counted_off);
    EXPECT_TRUE(none_counted_off);
    EXPECT_LT(largest_change, 0.01 * largest);
}

} // namespace
} // namespace plisse
