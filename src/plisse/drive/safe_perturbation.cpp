#include <plisse/drive/safe_perturbation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <plisse/base/random.h>
#include <plisse/decimate/triangle_distance.h>
#include <plisse/spatial/intersections.h>

namespace plisse {

namespace {

Triangle corners(const ExpandingMesh& mesh, int face) {
    const Face& f = mesh.faces().face(face);
    return {mesh.position(f[0]), mesh.position(f[1]), mesh.position(f[2])};
}

Box box_of(const Triangle& triangle) {
    Box box;
    for (const Vec3& corner : triangle)
        box.include(corner);
    return box;
}

void append_unique(std::vector<int>& list, const std::vector<int>& more) {
    list.insert(list.end(), more.begin(), more.end());
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

std::vector<int> faces_around(const ExpandingMesh& mesh, std::span<const int> vertices) {
    std::vector<int> faces;
    for (int v : vertices)
        faces.insert(faces.end(), mesh.faces().vertex_faces(v).begin(), mesh.faces().vertex_faces(v).end());
    append_unique(faces, {});
    return faces;
}

/// Points spread evenly over the sphere (Fibonacci lattice), turned by a seeded angle.
Vec3 sphere_direction(int index, int count, double turn) {
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    const double y = 1 - 2 * (index + 0.5) / count;
    const double r = std::sqrt(std::max(0.0, 1 - y * y));
    const double angle = golden * index + turn;
    return {r * std::cos(angle), y, r * std::sin(angle)};
}

} // namespace

double safe_radius(const ExpandingMesh& mesh, const Collapse& collapse) {
    constexpr double share_of_edge = 0.05;
    constexpr double share_of_gap = 0.2; // two patches of a batch may approach each other
    const Vec3 center = mesh.position(collapse.k);
    double shortest = std::numeric_limits<double>::infinity();
    for (int v : collapse.ring)
        shortest = std::min(shortest, (mesh.position(v) - center).norm());
    double radius = share_of_edge * shortest;

    std::vector<int> ring_and_center = collapse.ring;
    ring_and_center.push_back(collapse.k);
    const std::vector<int> touching = faces_around(mesh, ring_and_center);
    std::vector<int> near;
    for (int f : mesh.faces().vertex_faces(collapse.k)) {
        const Triangle own = corners(mesh, f);
        mesh.grid().query(box_of(own).inflated(radius / share_of_gap), near);
        for (int other : near) {
            if (std::binary_search(touching.begin(), touching.end(), other) ||
                (mesh.is_obstacle_face(f) && mesh.is_obstacle_face(other)))
                continue;
            const double gap = std::sqrt(triangle_distance_squared(own, corners(mesh, other)));
            radius = std::min(radius, share_of_gap * gap);
        }
    }
    return radius;
}

bool patch_intersects(const ExpandingMesh& mesh, const Collapse& collapse) {
    const std::array<int, 2> split = {collapse.i, collapse.j};
    const std::vector<int> own = faces_around(mesh, split);
    std::vector<int> around = collapse.ring;
    around.insert(around.end(), split.begin(), split.end());
    const std::vector<int> touching = faces_around(mesh, around);
    for (int f : own)
        for (int other : touching) {
            const bool twice = std::binary_search(own.begin(), own.end(), other) && other <= f;
            if (!twice && faces_intersect(mesh.positions(), mesh.faces().face(f), mesh.faces().face(other)))
                return true;
        }
    return false;
}

Rung perturb(ExpandingMesh& mesh, const Collapse& collapse, double radius, std::uint64_t seed) {
    const Vec3 origin = mesh.position(collapse.i);
    const auto try_places = [&](const Vec3& i, const Vec3& j) {
        mesh.set_position(collapse.i, origin + i);
        mesh.set_position(collapse.j, origin + j);
        return !patch_intersects(mesh, collapse);
    };
    const Vec3 to_i = mesh.targets().col(collapse.i) - origin;
    const Vec3 to_j = mesh.targets().col(collapse.j) - origin;
    const double farthest = std::max(to_i.norm(), to_j.norm());
    if (farthest > 0) {
        const double share = std::min(1.0, radius / farthest);
        if (try_places(share * to_i, share * to_j))
            return Rung::toward_target;
    }
    const Vec3 apart = to_j - to_i;
    if (apart.norm() > 0) {
        const Vec3 half = 0.5 * radius * apart.normalized();
        if (try_places(-half, half) || try_places(Vec3::Zero(), 2 * half) || try_places(-2 * half, Vec3::Zero()))
            return Rung::toward_target;
    }
    constexpr int samples = 128;
    const double turn = Random(seed).uniform(0, 2 * std::numbers::pi);
    for (int s = 0; s < samples; ++s) {
        const Vec3 direction = radius * sphere_direction(s, samples, turn);
        if (try_places(Vec3::Zero(), direction) || try_places(direction, Vec3::Zero()))
            return Rung::sampled;
    }
    mesh.set_position(collapse.i, origin);
    mesh.set_position(collapse.j, origin);
    return Rung::failed;
}

} // namespace plisse
