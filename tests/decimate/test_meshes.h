#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <plisse/base/random.h>
#include <plisse/decimate/decimate.h>

namespace plisse::test {

/// A small mesh with everything decimation asks for.
struct TestMesh {
    std::vector<Vec3> points;
    std::vector<Face> faces;
    std::vector<int> part, label;
    std::vector<std::uint8_t> frozen;
    Positions rest;

    int count() const { return static_cast<int>(points.size()); }
    DecimationInput input() const { return {rest, faces, part, label, frozen}; }

    /// To be called after points and faces are complete.
    TestMesh& finish() {
        rest.resize(3, count());
        for (int v = 0; v < count(); ++v)
            rest.col(v) = points[v];
        part.resize(points.size(), 0);
        label.resize(points.size(), -1);
        return *this;
    }

    /// Leaves out the points that no face uses.
    void drop_unused() {
        std::vector<int> number(points.size(), -1);
        std::vector<Vec3> kept;
        for (const Face& face : faces)
            for (int v : face)
                number[v] = 0;
        for (std::size_t v = 0; v < points.size(); ++v)
            if (number[v] == 0) {
                number[v] = static_cast<int>(kept.size());
                kept.push_back(points[v]);
            }
        for (Face& face : faces)
            for (int& v : face)
                v = number[v];
        points = kept;
    }

    /// Makes points at the same place one.
    void weld() {
        std::vector<int> number;
        std::vector<Vec3> kept;
        for (const Vec3& point : points) {
            const auto same = std::find_if(kept.begin(), kept.end(),
                                           [&](const Vec3& other) { return (other - point).norm() < 1e-9; });
            number.push_back(static_cast<int>(same - kept.begin()));
            if (same == kept.end())
                kept.push_back(point);
        }
        for (Face& face : faces)
            for (int& v : face)
                v = number[v];
        points = kept;
    }

    /// Adds a sheet of n x m cells spanned by two directions; points at the same place become one.
    TestMesh& add_wall(const Vec3& origin, const Vec3& along, const Vec3& up, int n, int m) {
        const int first = count();
        for (int b = 0; b <= m; ++b)
            for (int a = 0; a <= n; ++a)
                points.push_back(origin + along * a / n + up * b / m);
        const auto at = [&](int a, int b) { return first + b * (n + 1) + a; };
        for (int b = 0; b < m; ++b)
            for (int a = 0; a < n; ++a) {
                const bool turned = (a + b) % 2 != 0;
                faces.push_back({at(a, b), at(a + 1, b), at(a + (turned ? 0 : 1), b + 1)});
                faces.push_back({at(turned ? a + 1 : a, b), at(a + 1, b + 1), at(a, b + 1)});
            }
        weld();
        return *this;
    }

    /// Turns every face of the part that a predicate of the face's middle picks the other way.
    void turn(const std::function<bool(const Vec3&)>& picks) {
        for (Face& face : faces)
            if (picks((points[face[0]] + points[face[1]] + points[face[2]]) / 3))
                std::swap(face[1], face[2]);
    }

    /// Adds another mesh as the next part, moved.
    TestMesh& append(const TestMesh& other, const Vec3& offset) {
        const int first = count();
        const int next_part = part.empty() ? 0 : part.back() + 1;
        for (const Vec3& point : other.points)
            points.push_back(point + offset);
        for (const Face& face : other.faces)
            faces.push_back({face[0] + first, face[1] + first, face[2] + first});
        part.resize(points.size(), next_part);
        label.insert(label.end(), other.label.begin(), other.label.end());
        return finish();
    }
};

using Height = std::function<double(double, double)>;

/// The unit square of n x n cells, inner vertices moved by up to `jitter` cells, cells for which hole(x, y) left out.
inline TestMesh square(int n, double jitter = 0, const Height& height = {},
                       const std::function<bool(int, int)>& hole = {}) {
    TestMesh mesh;
    Random random(5);
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) {
            const bool inside = x > 0 && y > 0 && x < n && y < n;
            const double u = (x + (inside ? jitter * random.uniform(-1, 1) : 0)) / n;
            const double v = (y + (inside ? jitter * random.uniform(-1, 1) : 0)) / n;
            mesh.points.push_back({u, v, height ? height(u, v) : 0});
        }
    const auto at = [n](int x, int y) { return y * (n + 1) + x; };
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            if (hole && hole(x, y))
                continue;
            if ((x + y) % 2 == 0) {
                mesh.faces.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
                mesh.faces.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
            } else {
                mesh.faces.push_back({at(x, y), at(x + 1, y), at(x, y + 1)});
                mesh.faces.push_back({at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
            }
        }
    mesh.drop_unused();
    return mesh.finish();
}

inline TestMesh curved_square(int n) {
    return square(n, 0.25, [](double u, double v) { return 0.15 * std::sin(4 * u + 1) * std::cos(3 * v); });
}

/// n x m points wrapped around in the first direction, and in the second where `closed`.
inline TestMesh wrapped(int n, int m, bool closed, const std::function<Vec3(double, double)>& surface) {
    TestMesh mesh;
    for (int b = 0; b < m; ++b)
        for (int a = 0; a < n; ++a)
            mesh.points.push_back(surface(2 * std::numbers::pi * a / n, closed ? 1.0 * b / m : 1.0 * b / (m - 1)));
    const auto at = [&](int a, int b) { return (b % m) * n + a % n; };
    for (int b = 0; b < (closed ? m : m - 1); ++b)
        for (int a = 0; a < n; ++a) {
            mesh.faces.push_back({at(a, b), at(a + 1, b), at(a + 1, b + 1)});
            mesh.faces.push_back({at(a, b), at(a + 1, b + 1), at(a, b + 1)});
        }
    return mesh.finish();
}

inline TestMesh torus(int n, int m) {
    return wrapped(n, m, true, [](double around, double t) {
        const double tube = 2 * std::numbers::pi * t;
        const double r = 1 + 0.4 * std::cos(tube);
        return Vec3(r * std::cos(around), r * std::sin(around), 0.4 * std::sin(tube));
    });
}

inline TestMesh annulus(int n, int m) {
    return wrapped(n, m, false, [](double around, double t) {
        return Vec3((1 - 0.6 * t) * std::cos(around), (1 - 0.6 * t) * std::sin(around), 0.1 * std::sin(3 * around));
    });
}

/// A sphere of rings between two poles.
inline TestMesh sphere(int n, int rings) {
    TestMesh mesh = wrapped(n, rings, false, [&](double around, double t) {
        const double polar = std::numbers::pi * (1 + t * (rings - 1)) / (rings + 1);
        return Vec3(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), -std::cos(polar));
    });
    const int south = mesh.count(), north = south + 1, last = (rings - 1) * n;
    mesh.points.push_back({0, 0, -1});
    mesh.points.push_back({0, 0, 1});
    for (int a = 0; a < n; ++a) {
        mesh.faces.push_back({(a + 1) % n, a, south});
        mesh.faces.push_back({last + a, last + (a + 1) % n, north});
    }
    return mesh.finish();
}

inline TestMesh tetrahedron() {
    TestMesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    return mesh.finish();
}

inline TestMesh triangles(int count) {
    TestMesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.faces = {{0, 1, 2}};
    if (count == 2) {
        mesh.points.push_back({1, 1, 0});
        mesh.faces.push_back({1, 3, 2});
    }
    return mesh.finish();
}

/// A square panel of n x n cells with a rib on it, from y = begin to end (in cells) and n/4 cells high, that turns the
/// other way than the panel does on one of its sides, as it must.
inline TestMesh rib_panel(int n, int begin, int end, double jitter = 0) {
    TestMesh mesh;
    mesh.add_wall({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n);
    const double cell = 1.0 / n;
    mesh.add_wall({0.5, begin * cell, 0}, {0, (end - begin) * cell, 0}, {0, 0, 0.25}, end - begin, n / 4);
    Random random(7);
    for (Vec3& p : mesh.points) {
        const bool at_rib = p.x() == 0.5 && p.y() > begin * cell - 1e-9 && p.y() < end * cell + 1e-9;
        if (p.z() == 0 && !at_rib && p.x() > 0 && p.x() < 1 && p.y() > 0 && p.y() < 1)
            p += jitter * cell * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 0);
    }
    return mesh.finish();
}

/// A cell of a honeycomb: six walls around it, and six between its neighbours, with three walls at each of its edges.
inline TestMesh honeycomb(int n, int m) {
    TestMesh mesh;
    const auto corner = [](int k) {
        return Vec3(std::cos(k * std::numbers::pi / 3), std::sin(k * std::numbers::pi / 3), 0);
    };
    for (int k = 0; k < 6; ++k) {
        mesh.add_wall(corner(k), corner(k + 1) - corner(k), {0, 0, 1.5}, n, m);
        mesh.add_wall(corner(k), 0.5 * corner(k), {0, 0, 1.5}, n / 2, m);
    }
    return mesh.finish();
}

/// Four sheets at one line, the line curved, and the sheets wavy.
inline TestMesh crossed_sheets(int n) {
    TestMesh mesh;
    for (int k = 0; k < 4; ++k)
        mesh.add_wall({0, 0, 0}, {0, 0, 2}, {std::cos(k * 1.6), std::sin(k * 1.6), 0}, 2 * n, n);
    for (Vec3& p : mesh.points)
        p += Vec3(0.1 * std::sin(2 * p.z()), 0.1 * std::cos(3 * p.z()), 0.05 * std::sin(4 * p.x() + 3 * p.y()));
    return mesh.finish();
}

/// A sheet with two handles, a closed sphere, and a small torus: three parts.
inline TestMesh scene() {
    TestMesh mesh;
    mesh.append(curved_square(14), Vec3(0, 0, 0))
        .append(sphere(12, 9), Vec3(4, 0, 0))
        .append(torus(14, 8), Vec3(0, 4, 0));
    for (int v = 0; v < mesh.count(); ++v) {
        if (mesh.part[v] == 0 && mesh.points[v].x() < 0.15)
            mesh.label[v] = 0;
        if (mesh.part[v] == 0 && (mesh.points[v].head<2>() - Vec2(0.7, 0.5)).norm() < 0.15)
            mesh.label[v] = 1;
    }
    return mesh;
}

} // namespace plisse::test
