#pragma once

#include <optional>
#include <string_view>

#include <plisse/base/types.h>

namespace plisse {

/// From where a subject is seen. Azimuth 0 looks from +z, 90 from +x; elevation 90 looks straight down.
struct View {
    double azimuth_deg = 35;
    double elevation_deg = 18;
    double zoom = 1; ///< above 1 shows less, larger
};

/// Reads "azimuth,elevation" or "azimuth,elevation,zoom": degrees, elevation within [-90, 90], zoom above 0. Nothing
/// when the text is not of that form.
std::optional<View> parse_view(std::string_view text);

/// A perspective camera. right, up and forward are orthonormal.
struct Camera {
    Vec3 eye{0, 0, 10};
    Vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
    double half_height = 0.25; ///< of the picture, at distance 1
    double near = 1e-3;        ///< m along forward; what is nearer is not drawn

    /// World direction through a place of a picture, in pixels from its top left corner; its part along forward is 1.
    Vec3 ray(double x, double y, int width, int height) const {
        const double scale = 2 * half_height / height;
        return forward + scale * (x - 0.5 * width) * right + scale * (0.5 * height - y) * up;
    }
};

/// The nearest camera of the view's direction that sees all points, with a small margin. Points that are not finite
/// are passed over. aspect: width over height.
Camera fit_camera(const ConstPositions& points, const View& view, double aspect);

} // namespace plisse
