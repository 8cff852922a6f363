#include <plisse/picture/camera.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace plisse {

namespace {

constexpr double fit_margin = 1.08;

/// Largest value over the finite points of p.side - slope p.forward: how far a side of the viewing pyramid must open.
double support(const ConstPositions& points, const Vec3& side, const Vec3& forward, double slope) {
    double largest = -std::numeric_limits<double>::infinity();
    const Vec3 direction = side - slope * forward;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const double value = direction.dot(points.col(i));
        if (std::isfinite(value))
            largest = std::max(largest, value);
    }
    return largest;
}

} // namespace

std::optional<View> parse_view(std::string_view text) {
    std::array<double, 3> numbers = {0, 0, 1};
    const char* place = text.data();
    const char* const end = place + text.size();
    std::size_t count = 0;
    while (count < 3) {
        const auto [next, error] = std::from_chars(place, end, numbers[count]);
        if (error != std::errc{} || !std::isfinite(numbers[count]))
            return std::nullopt;
        ++count;
        place = next;
        if (place == end)
            break;
        if (count == 3 || *place++ != ',')
            return std::nullopt;
    }
    if (count < 2 || place != end || std::abs(numbers[1]) > 90 || numbers[2] <= 0)
        return std::nullopt;
    return View{numbers[0], numbers[1], numbers[2]};
}

Camera fit_camera(const ConstPositions& points, const View& view, double aspect) {
    const double azimuth = view.azimuth_deg * std::numbers::pi / 180;
    const double elevation = view.elevation_deg * std::numbers::pi / 180;
    Camera camera;
    camera.forward =
        -Vec3{std::cos(elevation) * std::sin(azimuth), std::sin(elevation), std::cos(elevation) * std::cos(azimuth)};
    camera.right = {std::cos(azimuth), 0, -std::sin(azimuth)};
    camera.up = camera.right.cross(camera.forward);

    // The four sides of the pyramid touch the points: two linear equations for the eye in each of two planes, and the
    // farther eye serves both.
    const double slope_up = camera.half_height / fit_margin;
    const double slope_right = slope_up * aspect;
    const double right = support(points, camera.right, camera.forward, slope_right);
    const double left = support(points, -camera.right, camera.forward, slope_right);
    const double top = support(points, camera.up, camera.forward, slope_up);
    const double bottom = support(points, -camera.up, camera.forward, slope_up);
    if (std::isfinite(right + left + top + bottom)) {
        const double depth = std::min(-(right + left) / (2 * slope_right), -(top + bottom) / (2 * slope_up));
        camera.eye = 0.5 * (right - left) * camera.right + 0.5 * (top - bottom) * camera.up + depth * camera.forward;
        const double nearest = -support(points, Vec3::Zero(), camera.forward, 1) - depth;
        const double farthest = support(points, Vec3::Zero(), camera.forward, -1) - depth;
        if (farthest <= 1e-9 * std::max(1.0, std::abs(depth))) // a single point
            camera.eye -= camera.forward;
        camera.near = std::max(1e-3 * nearest, 1e-4 * std::max(farthest, 1e-6));
    }
    camera.half_height /= view.zoom;
    return camera;
}

} // namespace plisse
