#include <plisse/energy/kirchhoff_love.h>

#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

constexpr int group_size = 8; // of faces: groups enough for many threads on a grid of 16 x 16
constexpr int grain = 8;
constexpr int regular_size = 16; ///< control points of a face away from extraordinary vertices

template <int K>
using FacePositions = Eigen::Matrix<double, 3, K>;

template <int K>
FacePositions<K> gather(const Positions& x, std::span<const int> control) {
    FacePositions<K> local(3, static_cast<Eigen::Index>(control.size()));
    for (std::size_t i = 0; i < control.size(); ++i)
        local.col(static_cast<Eigen::Index>(i)) = x.col(control[i]);
    return local;
}

/// The unit vector in the tangent plane nearest to `direction`, or to the axes after it where that stands upright.
Vec3 tangent_direction(Vec3 direction, const Vec3& normal) {
    constexpr double least_sine = 1e-3;
    for (;;) {
        const Vec3 tangent = direction - direction.dot(normal) * normal;
        if (tangent.norm() > least_sine * direction.norm())
            return tangent.normalized();
        direction = Vec3(direction.z(), direction.x(), direction.y());
    }
}

/// (alpha, i): a^alpha . o_i, o_1 along warp, of a surface with derivatives a_1, a_2.
Mat2 material_frame(const Vec3& a1, const Vec3& a2, const Vec3& warp) {
    const Vec3 normal = a1.cross(a2).normalized();
    Mat32 o;
    o.col(0) = tangent_direction(warp, normal);
    o.col(1) = normal.cross(o.col(0));
    Mat32 a;
    a << a1, a2;
    return (o.transpose() * a).inverse();
}

/// Calls function(std::integral_constant<int, K>) with K the number of control points when it is the usual one.
template <typename Function>
auto with_size(std::size_t size, const Function& function) {
    if (size == regular_size)
        return function(std::integral_constant<int, regular_size>{});
    return function(std::integral_constant<int, Eigen::Dynamic>{});
}

} // namespace

KirchhoffLoveShell::KirchhoffLoveShell(const SurfaceBasis& basis, const Positions& rest, ShellSection section,
                                       std::span<const Vec3> warp)
    : basis_(basis), section_(std::move(section)),
      elements_(basis.face_count(), basis.vertex_count(), group_size,
                [&basis](int face) { return basis.control_points(face); }) {
    assert(warp.size() == 1 || warp.size() == static_cast<std::size_t>(basis.face_count()));
    assert(basis.point_count() <= most_points);
    for (int face = 0; face < basis.face_count(); ++face) {
        const Vec3& direction = warp[warp.size() == 1 ? 0 : static_cast<std::size_t>(face)];
        const auto local = gather<Eigen::Dynamic>(rest, basis.control_points(face));
        const FaceStencil& stencil = basis.stencil(face);
        for (int p = 0; p < basis.point_count(); ++p) {
            const Vec3 a1 = local * stencil.du.col(p), a2 = local * stencil.dv.col(p);
            const Vec3 cross = a1.cross(a2);
            assert(cross.norm() > 0 && "a regular rest surface");
            const Vec3 normal = cross.normalized();
            const double mixed = normal.dot(local * stencil.duv.col(p));
            Mat2 b;
            b << normal.dot(local * stencil.duu.col(p)), mixed, mixed, normal.dot(local * stencil.dvv.col(p));
            const Mat2 frame = material_frame(a1, a2, direction);
            const Mat2 curvature = frame.transpose() * b * frame;
            points_.push_back(
                {frame, Vec3(curvature(0, 0), curvature(1, 1), curvature(0, 1)), basis.weight(p) * cross.norm()});
        }
    }
}

template <int K>
void KirchhoffLoveShell::jet_weights(int face, JetWeights<K>& weights) const {
    const FaceStencil& stencil = basis_.stencil(face);
    weights.resize(stencil.du.rows(), 5 * basis_.point_count());
    for (int p = 0; p < basis_.point_count(); ++p) {
        const Mat2& A = rest_point(face, p).frame;
        const auto du = stencil.du.col(p), dv = stencil.dv.col(p);
        const auto duu = stencil.duu.col(p), duv = stencil.duv.col(p), dvv = stencil.dvv.col(p);
        weights.col(5 * p) = A(0, 0) * du + A(1, 0) * dv;
        weights.col(5 * p + 1) = A(0, 1) * du + A(1, 1) * dv;
        const auto second = [&](int i, int j) {
            return A(0, i) * A(0, j) * duu + (A(0, i) * A(1, j) + A(1, i) * A(0, j)) * duv + A(1, i) * A(1, j) * dvv;
        };
        weights.col(5 * p + 2) = second(0, 0);
        weights.col(5 * p + 3) = second(0, 1);
        weights.col(5 * p + 4) = second(1, 1);
    }
}

template <int K>
double KirchhoffLoveShell::face_value(int face, const Positions& x) const {
    JetWeights<K> weights;
    jet_weights<K>(face, weights);
    const FacePositions<K> local = gather<K>(x, basis_.control_points(face));
    double sum = 0;
    for (int p = 0; p < basis_.point_count(); ++p) {
        const RestPoint& rest = rest_point(face, p);
        const ShellPoint point(local * weights.template middleCols<5>(5 * p), rest.curvature);
        if (!point.regular())
            return std::numeric_limits<double>::infinity();
        sum += rest.area * section_.energy(point.strain(), point.curvature());
    }
    return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

double KirchhoffLoveShell::value(const Positions& x) const {
    std::vector<double> values(static_cast<std::size_t>(basis_.face_count()));
    parallel_for(basis_.face_count(), grain, [&](int face) {
        values[static_cast<std::size_t>(face)] =
            with_size(basis_.control_points(face).size(), [&](auto k) { return face_value<k()>(face, x); });
    });
    double sum = 0;
    for (double value : values)
        sum += value;
    return sum;
}

template <int K>
void KirchhoffLoveShell::add_face_gradient(int face, const Positions& x, Positions& gradient) const {
    const std::span<const int> control = basis_.control_points(face);
    JetWeights<K> weights;
    jet_weights<K>(face, weights);
    const FacePositions<K> local = gather<K>(x, control);
    FacePositions<K> sum = FacePositions<K>::Zero(3, local.cols());
    for (int p = 0; p < basis_.point_count(); ++p) {
        const RestPoint& rest = rest_point(face, p);
        const auto at_point = weights.template middleCols<5>(5 * p);
        const ShellPoint point(local * at_point, rest.curvature);
        const SurfaceJet share = rest.area * point.gradient(section_.forces(point.strain(), point.curvature()));
        sum.noalias() += share.lazyProduct(at_point.transpose());
    }
    for (std::size_t i = 0; i < control.size(); ++i)
        gradient.col(control[i]) += sum.col(static_cast<Eigen::Index>(i));
}

void KirchhoffLoveShell::add_gradient(const Positions& x, Positions& gradient) const {
    elements_.for_each([&](int face) {
        with_size(basis_.control_points(face).size(), [&](auto k) { add_face_gradient<k()>(face, x, gradient); });
    });
}

/// With W_p the k x 5 weights of a sample point and H_p its Hessian, that of the face for coordinates a and b is
/// sum_p W_p H_p,ab W_p^T. The six products with a <= b are one: the W_p H_p,ab stand below one another, and side by
/// side over the points.
template <int K>
void KirchhoffLoveShell::add_face_hessian(int face, const Positions& x, NewtonSystem& system, bool project) const {
    constexpr int rows = K == Eigen::Dynamic ? Eigen::Dynamic : 6 * K;
    constexpr int most_columns = K == Eigen::Dynamic ? Eigen::Dynamic : 5 * most_points;
    const std::span<const int> control = basis_.control_points(face);
    const auto k = static_cast<Eigen::Index>(control.size());
    JetWeights<K> weights;
    jet_weights<K>(face, weights);
    const FacePositions<K> local = gather<K>(x, control);
    Eigen::Matrix<double, rows, Eigen::Dynamic, Eigen::ColMajor, rows, most_columns> half(6 * k, weights.cols());
    for (int p = 0; p < basis_.point_count(); ++p) {
        const RestPoint& rest = rest_point(face, p);
        const auto at_point = weights.template middleCols<5>(5 * p);
        const ShellPoint point(local * at_point, rest.curvature);
        const ShellPoint::Hessian hessian =
            rest.area * point.hessian(section_.tangent(point.strain(), point.curvature(), project), project);
        Eigen::Index row = 0;
        for (int a = 0; a < 3; ++a)
            for (int b = a; b < 3; ++b, row += k)
                half.template block<K, 5>(row, 5 * p, k, 5).noalias() =
                    at_point.lazyProduct(hessian.block<5, 5>(5 * a, 5 * b));
    }
    Eigen::Matrix<double, rows, K> products(6 * k, k);
    products.noalias() = half * weights.transpose();
    constexpr int first_row[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    system.add_blocks(control, elements_.block_numbers(face), [&](int i, int j) {
        Mat3 block;
        for (int b = 0; b < 3; ++b)
            for (int a = 0; a < 3; ++a)
                block(a, b) = a <= b ? products(first_row[a][b] * k + i, j) : products(first_row[a][b] * k + j, i);
        return block;
    });
}

void KirchhoffLoveShell::add_hessian(const Positions& x, NewtonSystem& system, bool project) const {
    elements_.for_each([&](int face) {
        with_size(basis_.control_points(face).size(), [&](auto k) { add_face_hessian<k()>(face, x, system, project); });
    });
}

double KirchhoffLoveShell::rest_area() const {
    double sum = 0;
    for (const RestPoint& point : points_)
        sum += point.area;
    return sum;
}

KirchhoffLoveShell::Deformation KirchhoffLoveShell::deformation(int face, int point, const Positions& x) const {
    JetWeights<Eigen::Dynamic> weights;
    jet_weights<Eigen::Dynamic>(face, weights);
    const auto local = gather<Eigen::Dynamic>(x, basis_.control_points(face));
    const ShellPoint at(local * weights.middleCols<5>(5 * point), rest_point(face, point).curvature);
    return {at.strain(), at.curvature()};
}

} // namespace plisse
