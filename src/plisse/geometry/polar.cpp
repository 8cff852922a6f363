#include <plisse/geometry/polar.h>

#include <Eigen/Geometry>

#include <cmath>

namespace plisse {

namespace {

/// Widens a (nearly) collapsed F to one whose columns span a plane, so that the closed form applies.
Mat32 regularized(const Mat32& f, double area, double trace) {
    const double size = trace > 0 ? std::sqrt(trace) : 1.0;
    const int major = f.col(0).squaredNorm() >= f.col(1).squaredNorm() ? 0 : 1;
    Mat32 g = f;
    if (trace <= 0)
        g.col(major) = Vec3::UnitX();
    const Vec3 along = g.col(major).normalized();
    Vec3 across = g.col(1 - major) - along * along.dot(g.col(1 - major));
    if (area <= 1e-150 || across.norm() <= 1e-12 * size)
        across = along.unitOrthogonal();
    g.col(1 - major) += across.normalized() * 1e-6 * size;
    return g;
}

} // namespace

PolarFrame polar_frame(const Mat32& deformation_gradient) {
    Mat32 f = deformation_gradient;
    Vec3 cross = f.col(0).cross(f.col(1));
    double area = cross.norm(); // sqrt(det C), computed without the cancellation in C
    double trace = f.squaredNorm();
    if (!(area > 1e-12 * trace)) {
        f = regularized(f, area, trace);
        cross = f.col(0).cross(f.col(1));
        area = cross.norm();
        trace = f.squaredNorm();
    }
    const double stretch_trace = std::sqrt(trace + 2 * area);
    const Mat2 stretch = (f.transpose() * f + area * Mat2::Identity()) / stretch_trace;
    PolarFrame frame;
    frame.stretch_trace = stretch_trace;
    frame.stretch_inverse << stretch(1, 1), -stretch(0, 1), -stretch(1, 0), stretch(0, 0);
    frame.stretch_inverse /= area; // det S = sqrt(det C)
    frame.rotation = f * frame.stretch_inverse;
    frame.normal = cross / area;
    return frame;
}

} // namespace plisse
