#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/LU>

#include <plisse/base/types.h>
#include <plisse/subdivide/surface_basis.h>

namespace plisse::testing {

/// The four uniform cubic B-splines of an interval at t in [0, 1]: values, first and second derivatives, one row each.
inline Eigen::Matrix<double, 3, 4> cubic_splines(double t) {
    const double s = 1 - t;
    Eigen::Matrix<double, 3, 4> b;
    b << s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (-3 * t * t * t + 3 * t * t + 3 * t + 1) / 6,
        t * t * t / 6, -s * s / 2, (3 * t * t - 4 * t) / 2, (-3 * t * t + 2 * t + 1) / 2, t * t / 2, s, 3 * t - 2,
        1 - 3 * t, t;
    return b;
}

/// Points and weights of Gauss's rule with 2, 3 or 4 points on [0, 1].
inline std::vector<std::array<double, 2>> gauss_rule(int points) {
    const auto mirrored = [](double a, double w) {
        return std::vector<std::array<double, 2>>{{(1 - a) / 2, w / 2}, {(1 + a) / 2, w / 2}};
    };
    if (points == 2)
        return mirrored(std::sqrt(1.0 / 3), 1);
    auto rule = points == 3 ? mirrored(std::sqrt(0.6), 5.0 / 9)
                            : mirrored(std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(1.2)), (18 + std::sqrt(30.0)) / 36);
    const auto others = mirrored(std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(1.2)), (18 - std::sqrt(30.0)) / 36);
    if (points == 3)
        rule.push_back({0.5, 4.0 / 9});
    else
        rule.insert(rule.end(), others.begin(), others.end());
    return rule;
}

/// How a face's own (u, v) = f(s, t) depend on other coordinates at a sample point.
struct Reparametrisation {
    Mat2 first = Mat2::Identity(); ///< (u, v) by (s, t)
    Mat2 u_second = Mat2::Zero(), v_second = Mat2::Zero();
};

/// Uniform bicubic B-splines on a grid of nx x ny faces with (nx + 3) x (ny + 3) control points, row by row.
struct SplineGrid {
    int nx, ny;

    int vertex_count() const { return (nx + 3) * (ny + 3); }
    int vertex(int i, int j) const { return j * (nx + 3) + i; }
    std::vector<int> control_points(int i, int j) const {
        std::vector<int> points;
        for (int b = 0; b < 4; ++b)
            for (int a = 0; a < 4; ++a)
                points.push_back(vertex(i + a, j + b));
        return points;
    }
    /// Control points from f(s, t) with s and t their places counted in faces: 0 .. nx on the sheet.
    Positions net(const std::function<Vec3(double, double)>& f) const {
        Positions x(3, vertex_count());
        for (int j = 0; j < ny + 3; ++j)
            for (int i = 0; i < nx + 3; ++i)
                x.col(vertex(i, j)) = f(i - 1, j - 1);
        return x;
    }
    Positions flat(double width, double height) const {
        return net([&](double s, double t) { return Vec3(width * s / nx, height * t / ny, 0); });
    }

    /// Sample points at Gauss's, each with coordinates of its own; the same quadrature of the same surface.
    SurfaceBasis basis(int gauss_points, const std::function<Reparametrisation(int point)>& coordinates = {}) const {
        const auto rule = gauss_rule(gauss_points);
        const int count = gauss_points * gauss_points;
        FaceStencil stencil;
        for (Eigen::MatrixXd* m : {&stencil.value, &stencil.du, &stencil.dv, &stencil.duu, &stencil.duv, &stencil.dvv})
            m->resize(16, count);
        std::vector<double> weights;
        for (const auto& [v, weight_v] : rule)
            for (const auto& [u, weight_u] : rule) {
                const auto p = static_cast<int>(weights.size());
                const Reparametrisation change = coordinates ? coordinates(p) : Reparametrisation{};
                weights.push_back(weight_u * weight_v / std::abs(change.first.determinant()));
                const auto bu = cubic_splines(u), bv = cubic_splines(v);
                for (int k = 0; k < 16; ++k) {
                    const auto product = [&](int du, int dv) { return bu(du, k % 4) * bv(dv, k / 4); };
                    const Vec2 first = change.first.transpose() * Vec2(product(1, 0), product(0, 1));
                    Mat2 second;
                    second << product(2, 0), product(1, 1), product(1, 1), product(0, 2);
                    second = (change.first.transpose() * second * change.first).eval() +
                             product(1, 0) * change.u_second + product(0, 1) * change.v_second;
                    stencil.value(k, p) = product(0, 0);
                    stencil.du(k, p) = first[0];
                    stencil.dv(k, p) = first[1];
                    stencil.duu(k, p) = second(0, 0);
                    stencil.duv(k, p) = second(0, 1);
                    stencil.dvv(k, p) = second(1, 1);
                }
            }
        SurfaceBasis basis(vertex_count(), weights);
        const int kind = basis.add_kind(stencil);
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i)
                basis.add_element(kind, control_points(i, j));
        return basis;
    }
};

} // namespace plisse::testing
