#pragma once

#include <memory>
#include <vector>

#include <plisse/solve/objective.h>
#include <plisse/solve/rmtr.h>

#include "linalg/spline_grid.h"

namespace plisse {

/// A heavy elastic net over the unit square, of cubic B-splines: per area
///   k/2 |E|^2 + b/2 (|x_uu|^2 + 2 |x_uv|^2 + |x_vv|^2) + g z + c/2 |x - x_rest|^2,   E = (x_a . x_b - delta)/2,
/// and along the two sides u = 0 and u = 1, p/2 |x - side|^2, the sides having come nearer to each other.
struct NetLaw {
    double membrane = 100, bending = 0.01, gravity = 1, foundation = 0.1, penalty = 1000;
    double approach = 0; ///< of the sides, as a share of the width
};

class SplineNet : public Objective {
public:
    SplineNet(int faces, const NetLaw& law)
        : n_(faces), law_(law), system_(std::vector<std::uint8_t>(3 * static_cast<std::size_t>((n_ + 3) * (n_ + 3)), 0),
                                        spline::face_pairs(n_)) {
        const double h = 1.0 / n_;
        for (std::size_t q = 0; q < 3; ++q)
            along_[q] = spline::basis(spline::gauss_points[q], h);
        sides_ = {spline::basis(0, h), spline::basis(1, h)};
    }

    /// Flat, with a slight arch so that it knows which way to go.
    VecX start(double arch) const {
        VecX x(3 * (n_ + 3) * (n_ + 3));
        for (int j = 0; j < n_ + 3; ++j)
            for (int i = 0; i < n_ + 3; ++i) {
                const double u = (i - 1.0) / n_, v = (j - 1.0) / n_;
                x.segment<3>(3 * vertex(i, j)) = Vec3(u, v, arch * u * (1 - u));
            }
        return x;
    }

    double value(const VecX& x) override {
        double sum = 0;
        for_each_point([&](const Point& point) {
            const Frame f = frame(x, point);
            const Eigen::Matrix2d e = strain(f);
            sum += point.weight *
                   (0.5 * law_.membrane * e.squaredNorm() +
                    0.5 * law_.bending * (f.uu.squaredNorm() + 2 * f.uv.squaredNorm() + f.vv.squaredNorm()) +
                    law_.gravity * f.x.z() + 0.5 * law_.foundation * (f.x - rest(point)).squaredNorm());
        });
        for_each_side_point(
            [&](const Point& point) { sum += 0.5 * law_.penalty * point.weight * gap(x, point).squaredNorm(); });
        return sum;
    }

    void gradient(const VecX& x, VecX& gradient) override {
        gradient.setZero(x.size());
        for_each_point([&](const Point& point) {
            const Frame f = frame(x, point);
            const Eigen::Matrix2d e = strain(f);
            const Vec3 along_u = law_.membrane * (e(0, 0) * f.u + e(0, 1) * f.v);
            const Vec3 along_v = law_.membrane * (e(0, 1) * f.u + e(1, 1) * f.v);
            const Vec3 load = Vec3(0, 0, law_.gravity) + law_.foundation * (f.x - rest(point));
            for (int k = 0; k < 16; ++k)
                gradient.segment<3>(3 * control(point, k)) +=
                    point.weight *
                    (w(point, k, 1, 0) * along_u + w(point, k, 0, 1) * along_v + w(point, k, 0, 0) * load +
                     law_.bending *
                         (w(point, k, 2, 0) * f.uu + 2 * w(point, k, 1, 1) * f.uv + w(point, k, 0, 2) * f.vv));
        });
        for_each_side_point([&](const Point& point) {
            const Vec3 pull = law_.penalty * point.weight * gap(x, point);
            for (int k = 0; k < 16; ++k)
                gradient.segment<3>(3 * control(point, k)) += w(point, k, 0, 0) * pull;
        });
    }

    void assemble(const VecX& x, NewtonSystem& system, bool /*project*/) override {
        system.begin({});
        Eigen::Matrix<double, 48, 48> element = Eigen::Matrix<double, 48, 48>::Zero();
        int corner = -1;
        Point last{};
        const auto flush = [&] {
            for (int k = 0; k < 16 && corner >= 0; ++k)
                for (int l = 0; l <= k; ++l)
                    system.add_block(control(last, k), control(last, l), element.block<3, 3>(3 * k, 3 * l));
            element.setZero();
        };
        for_each_point([&](const Point& point) {
            if (point.i + n_ * point.j != corner)
                flush();
            corner = point.i + n_ * point.j;
            last = point;
            add_element(frame(x, point), point, element);
        });
        flush();
        for_each_side_point([&](const Point& point) {
            for (int k = 0; k < 16; ++k)
                for (int l = 0; l <= k; ++l) {
                    const double entry = law_.penalty * point.weight * w(point, k, 0, 0) * w(point, l, 0, 0);
                    if (entry != 0)
                        system.add_block(control(point, k), control(point, l), entry * Mat3::Identity());
                }
        });
    }

    NewtonSystem& system() override { return system_; }
    const VecX& targets() const override { return targets_; }
    double max_step(const VecX&, const VecX& d) override {
        const double longest = d.cwiseAbs().maxCoeff();
        return longest > largest_move ? largest_move / longest : 1;
    }
    double largest_move = std::numeric_limits<double>::infinity(); ///< of an unknown, by one step

private:
    using Weights = std::array<std::array<double, 4>, 3>;
    struct Point {
        int i, j;
        const Weights *u, *v;
        double weight;
        double s, t; ///< place in the unit square
    };
    struct Frame {
        Vec3 x, u, v, uu, uv, vv;
    };

    int vertex(int i, int j) const { return i + (n_ + 3) * j; }
    int control(const Point& point, int k) const { return vertex(point.i + k % 4, point.j + k / 4); }
    static double w(const Point& point, int k, std::size_t du, std::size_t dv) {
        return (*point.u)[du][static_cast<std::size_t>(k % 4)] * (*point.v)[dv][static_cast<std::size_t>(k / 4)];
    }

    template <typename Visit>
    void for_each_point(const Visit& visit) const {
        const double h = 1.0 / n_;
        for (int j = 0; j < n_; ++j)
            for (int i = 0; i < n_; ++i)
                for (std::size_t q = 0; q < 3; ++q)
                    for (std::size_t p = 0; p < 3; ++p)
                        visit(Point{i, j, &along_[p], &along_[q],
                                    h * h * spline::gauss_weights[p] * spline::gauss_weights[q],
                                    h * (i + spline::gauss_points[p]), h * (j + spline::gauss_points[q])});
    }
    template <typename Visit>
    void for_each_side_point(const Visit& visit) const {
        const double h = 1.0 / n_;
        for (int side : {0, 1})
            for (int j = 0; j < n_; ++j)
                for (std::size_t q = 0; q < 3; ++q)
                    visit(Point{side * (n_ - 1), j, &sides_[static_cast<std::size_t>(side)], &along_[q],
                                h * spline::gauss_weights[q], double(side), h * (j + spline::gauss_points[q])});
    }

    Frame frame(const VecX& x, const Point& point) const {
        Frame f{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
        for (int k = 0; k < 16; ++k) {
            const Vec3 c = x.segment<3>(3 * control(point, k));
            f.x += w(point, k, 0, 0) * c;
            f.u += w(point, k, 1, 0) * c;
            f.v += w(point, k, 0, 1) * c;
            f.uu += w(point, k, 2, 0) * c;
            f.uv += w(point, k, 1, 1) * c;
            f.vv += w(point, k, 0, 2) * c;
        }
        return f;
    }
    static Eigen::Matrix2d strain(const Frame& f) {
        const double shear = 0.5 * f.u.dot(f.v);
        Eigen::Matrix2d e;
        e << 0.5 * (f.u.squaredNorm() - 1), shear, shear, 0.5 * (f.v.squaredNorm() - 1);
        return e;
    }
    static Vec3 rest(const Point& point) { return Vec3(point.s, point.t, 0); }
    Vec3 gap(const VecX& x, const Point& point) const {
        return frame(x, point).x - Vec3(point.s + law_.approach * (0.5 - point.s), point.t, 0);
    }

    void add_element(const Frame& f, const Point& point, Eigen::Matrix<double, 48, 48>& element) const {
        const Eigen::Matrix2d e = strain(f);
        const Mat3 one = Mat3::Identity();
        const double k = law_.membrane * point.weight, b = law_.bending * point.weight;
        const Mat3 uu = k * (e(0, 0) * one + f.u * f.u.transpose() + 0.5 * f.v * f.v.transpose());
        const Mat3 vv = k * (e(1, 1) * one + f.v * f.v.transpose() + 0.5 * f.u * f.u.transpose());
        const Mat3 uv = k * (e(0, 1) * one + 0.5 * f.v * f.u.transpose());
        for (int p = 0; p < 16; ++p)
            for (int q = 0; q <= p; ++q) {
                const auto both = [&](std::size_t du, std::size_t dv) {
                    return w(point, p, du, dv) * w(point, q, du, dv);
                };
                const double simple =
                    b * (both(2, 0) + 2 * both(1, 1) + both(0, 2)) + law_.foundation * point.weight * both(0, 0);
                element.block<3, 3>(3 * p, 3 * q) += simple * one + both(1, 0) * uu + both(0, 1) * vv +
                                                     w(point, p, 1, 0) * w(point, q, 0, 1) * uv +
                                                     w(point, p, 0, 1) * w(point, q, 1, 0) * uv.transpose();
            }
    }

    int n_;
    NetLaw law_;
    std::array<Weights, 3> along_;
    std::array<Weights, 2> sides_;
    VecX targets_;
    NewtonSystem system_;
};

/// Nets from `coarsest` faces a side upwards, each of twice as many as the one before.
struct NetHierarchy {
    std::vector<std::unique_ptr<SplineNet>> nets;
    std::vector<std::unique_ptr<SparseTransfer>> transfers;
    std::vector<Objective*> levels;
    std::vector<const LevelTransfer*> between;
    std::vector<const ScalarTransfer*> prolongations;

    NetHierarchy(int coarsest, int level_count, const NetLaw& law) {
        for (int l = 0; l < level_count; ++l)
            nets.push_back(std::make_unique<SplineNet>(coarsest << l, law));
        for (int l = 0; l + 1 < level_count; ++l)
            transfers.push_back(std::make_unique<SparseTransfer>(spline::tensor(spline::subdivision_1d(coarsest << l)),
                                                                 spline::tensor(spline::projection_1d(coarsest << l))));
        for (const auto& net : nets)
            levels.push_back(net.get());
        for (const auto& transfer : transfers) {
            between.push_back(transfer.get());
            prolongations.push_back(&transfer->prolongation());
        }
    }
    SplineNet& finest() { return *nets.back(); }
};

} // namespace plisse
