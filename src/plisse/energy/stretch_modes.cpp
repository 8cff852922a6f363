#include <plisse/energy/stretch_modes.h>

#include <cmath>

#include <Eigen/Geometry>

namespace plisse {

namespace {

/// Rotation whose first column is the direction in the sheet that is stretched most. From C - I, which is exact near
/// rest.
Mat2 right_singular_vectors(const Mat32& F) {
    const double d = ((F.col(0).squaredNorm() - 1) - (F.col(1).squaredNorm() - 1)) / 2;
    const double c = F.col(0).dot(F.col(1));
    const double radius = std::sqrt(d * d + c * c);
    double cosine = 1;
    double sine = 0;
    if (radius > 0 && d >= 0) {
        cosine = std::sqrt((1 + d / radius) / 2);
        sine = c / radius / (2 * cosine);
    } else if (radius > 0) {
        sine = std::sqrt((1 - d / radius) / 2);
        cosine = c / radius / (2 * sine);
    }
    Mat2 right;
    right << cosine, -sine, sine, cosine;
    return right;
}

/// d2w / (dF g_k) (dF g_l) for two directions g in the sheet, given in the basis (v1, v2).
Mat3 block(const StretchModes& modes, const Vec2& k, const Vec2& l) {
    const double same = (modes.flip + modes.twist) / 2;
    const double crossed = (modes.flip - modes.twist) / 2;
    const double aa = k[0] * l[0];
    const double ab = k[0] * l[1];
    const double ba = k[1] * l[0];
    const double bb = k[1] * l[1];
    const auto u1 = modes.frame.left.col(0);
    const auto u2 = modes.frame.left.col(1);
    const auto n = modes.frame.left.col(2);
    const Vec3 row1 = (modes.stretch(0, 0) * aa + same * bb) * u1 + (modes.stretch(0, 1) * ab + crossed * ba) * u2;
    const Vec3 row2 = (modes.stretch(1, 0) * ba + crossed * ab) * u1 + (modes.stretch(1, 1) * bb + same * aa) * u2;
    const Vec3 row3 = (modes.lift[0] * aa + modes.lift[1] * bb) * n;
    return u1 * row1.transpose() + u2 * row2.transpose() + n * row3.transpose();
}

} // namespace

Vec2 principal_stretches(const Mat32& F) {
    const double trace = F.squaredNorm();
    const double J = F.col(0).cross(F.col(1)).norm();
    // (s1 +- s2)^2 = tr C +- 2 J
    const double sum = std::sqrt(trace + 2 * J);
    const double d = (F.col(0).squaredNorm() - F.col(1).squaredNorm()) / 2;
    const double difference = 2 * std::hypot(d, F.col(0).dot(F.col(1))) / sum;
    const double largest = (sum + difference) / 2;
    return {largest, J / largest};
}

PrincipalFrame principal_frame(const Mat32& F) {
    const Vec3 normal = F.col(0).cross(F.col(1));
    const double J = normal.norm();
    PrincipalFrame frame;
    frame.right = right_singular_vectors(F);
    const Vec3 image = F * frame.right.col(0);
    const double s1 = image.norm();
    frame.stretches = {s1, J / s1};
    frame.left.col(0) = image / s1;
    frame.left.col(2) = normal / J;
    frame.left.col(1) = frame.left.col(2).cross(frame.left.col(0));
    return frame;
}

Mat6 hessian(const StretchModes& modes) {
    const Mat2 axes = modes.frame.right.transpose();
    Mat6 hessian;
    for (int l = 0; l < 2; ++l)
        for (int k = 0; k < 2; ++k)
            hessian.block<3, 3>(3 * k, 3 * l) = block(modes, axes.col(k), axes.col(l));
    return hessian;
}

Mat9 pull_back(const StretchModes& modes, const Mat2& inverse, double scale) {
    // Corner k moves F by dx_k g_k^T with g_1, g_2 the rows of `inverse` and g_0 = -g_1 - g_2: rows add up to zero.
    const Mat2 axes = modes.frame.right.transpose() * inverse.transpose();
    const Mat3 h11 = scale * block(modes, axes.col(0), axes.col(0));
    const Mat3 h12 = scale * block(modes, axes.col(0), axes.col(1));
    const Mat3 h22 = scale * block(modes, axes.col(1), axes.col(1));
    const Mat3 h10 = -(h11 + h12);
    const Mat3 h20 = -(h12.transpose() + h22);
    Mat9 hessian;
    hessian << -(h10 + h20), h10.transpose(), h20.transpose(), //
        h10, h11, h12,                                         //
        h20, h12.transpose(), h22;
    return hessian;
}

} // namespace plisse
