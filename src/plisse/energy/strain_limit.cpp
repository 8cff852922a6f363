#include <plisse/energy/strain_limit.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include <plisse/base/parallel.h>
#include <plisse/energy/stretch_modes.h>
#include <plisse/geometry/barrier.h>

namespace plisse {

namespace {

/// (b'(y) - b'(z)) / (y - z) for y <= z, without a difference of y and z where both are below 1.
double slope_quotient(double y, double z) {
    if (!(y < 1))
        return 0;
    if (!(z < 1))
        return barrier(y).first / (y - z);
    // b' = 2 ln y - 2 y ln y - 1/y + 2 - y, term by term
    const double ratio = (z - y) / y;
    const double log_quotient = (ratio > 0 ? std::log1p(ratio) / ratio : 1) / y;
    return 2 * (1 - z) * log_quotient - 2 * std::log(y) + 1 / (y * z) - 1;
}

} // namespace

StrainLimitEnergy::StrainLimitEnergy(const Positions& rest, std::vector<Face> faces, StrainLimits limits)
    : triangles_(rest, std::move(faces)), limits_(std::move(limits)) {
    assert(limits_.onset.size() == triangles_.areas().size());
    assert(limits_.limit.size() == triangles_.areas().size());
    assert(limits_.stiffness.size() == triangles_.areas().size());
}

double StrainLimitEnergy::width(int face) const {
    const auto f = static_cast<std::size_t>(face);
    return limits_.limit[f] - limits_.onset[f];
}

double StrainLimitEnergy::relative_room(int face, double stretch) const {
    return (limits_.limit[static_cast<std::size_t>(face)] - stretch) / width(face);
}

double StrainLimitEnergy::value(int face, const Positions& x) const {
    const Vec2 stretches = triangles_.principal_stretches(face, x);
    const double y1 = relative_room(face, stretches[0]);
    if (!(y1 > 0))
        return std::numeric_limits<double>::infinity();
    const double y2 = relative_room(face, stretches[1]);
    return triangles_.area(face) * limits_.stiffness[static_cast<std::size_t>(face)] *
           (barrier(y1).value + barrier(y2).value);
}

void StrainLimitEnergy::gradient(int face, const Positions& x, double* gradient) const {
    const Mat32 F = triangles_.deformation_gradient(face, x);
    Mat32 stress = Mat32::Zero();
    if (relative_room(face, plisse::principal_stretches(F)[0]) < 1) {
        const PrincipalFrame frame = principal_frame(F);
        const double scale = -triangles_.area(face) * limits_.stiffness[static_cast<std::size_t>(face)] / width(face);
        for (int i = 0; i < 2; ++i)
            stress += scale * barrier(relative_room(face, frame.stretches[i])).first * frame.left.col(i) *
                      frame.right.col(i).transpose();
    }
    triangles_.pull_back_gradient(face, stress, gradient);
}

void StrainLimitEnergy::hessian(int face, const Positions& x, bool, double* hessian) const {
    Eigen::Map<Mat9> result(hessian);
    const Mat32 F = triangles_.deformation_gradient(face, x);
    if (!(relative_room(face, plisse::principal_stretches(F)[0]) < 1)) {
        result.setZero();
        return;
    }
    StretchModes modes;
    modes.frame = principal_frame(F);
    const Vec2& s = modes.frame.stretches;
    const double y1 = relative_room(face, s[0]);
    const double y2 = relative_room(face, s[1]);
    const Barrier b1 = barrier(y1);
    const Barrier b2 = barrier(y2);
    const double w = width(face);
    modes.stretch << b1.second, 0, 0, b2.second;
    modes.flip = slope_quotient(y1, y2);
    modes.twist = -w * (b1.first + b2.first) / (s[0] + s[1]);
    modes.lift << -w * b1.first / s[0], -w * b2.first / s[1];
    const double scale = triangles_.area(face) * limits_.stiffness[static_cast<std::size_t>(face)] / (w * w);
    result = pull_back(modes, triangles_.inverse(face), scale);
}

double StrainLimitEnergy::max_step(const Positions& x, const Positions& d) const {
    constexpr int chunk_size = 512;
    std::vector<double> steps(static_cast<std::size_t>(chunk_count(element_count(), chunk_size)), 1.0);
    parallel_chunks(element_count(), chunk_size, [&](int chunk, int begin, int end) {
        double& step = steps[static_cast<std::size_t>(chunk)];
        for (int face = begin; face < end; ++face) {
            const Mat32 F = triangles_.deformation_gradient(face, x);
            const double stretch = plisse::principal_stretches(F)[0];
            const double limit = limits_.limit[static_cast<std::size_t>(face)];
            const double kept = std::max(kept_share * std::min(limit - stretch, width(face)), least_room * width(face));
            step = limited_step(F, triangles_.deformation_gradient(face, d), std::max(limit - kept, stretch), step);
        }
    });
    return steps.empty() ? 1.0 : *std::min_element(steps.begin(), steps.end());
}

// The largest singular value is convex along a line, so a chord lies above it: where a chord from a point below the
// bound to one above reaches the bound, the singular value has not. A bisection beside it closes the bracket from
// above.
double limited_step(const Mat32& F, const Mat32& d, double bound, double end) {
    constexpr double near_enough = 0.02;
    constexpr int most_rounds = 60;
    const auto excess = [&](double s) { return principal_stretches(Mat32(F + s * d))[0] - bound; };
    double low = 0, high = end;
    double at_high = excess(end);
    if (at_high <= 0)
        return end;
    double at_low = excess(0);
    for (int round = 0; round < most_rounds && high - low > near_enough * high; ++round) {
        const double chord = low + (high - low) * at_low / (at_low - at_high);
        for (double s : {chord, 0.5 * (chord + high)}) {
            const double at = excess(s);
            if (at <= 0 && s > low) {
                low = s;
                at_low = at;
            } else if (at > 0 && s < high) {
                high = s;
                at_high = at;
            }
        }
    }
    return low;
}

} // namespace plisse
