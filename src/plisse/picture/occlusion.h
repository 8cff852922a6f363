#pragma once

#include <vector>

#include <Eigen/Core>

#include <plisse/picture/camera.h>

namespace plisse {

/// The surface seen at each pixel, rows from the top.
struct SurfaceBuffer {
    int width = 0, height = 0;
    std::vector<float> depth;             ///< m along forward; infinity where nothing is seen
    std::vector<Eigen::Vector3f> normals; ///< unit, towards the viewer

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// Share of the surrounding light that reaches each pixel's surface, in [0, 1]: ambient obscurance by what stands
/// within `radius` (m), estimated from the buffer itself (McGuire, Mara, Luebke 2012).
std::vector<float> ambient_openness(const SurfaceBuffer& buffer, const Camera& camera, double radius);

} // namespace plisse
