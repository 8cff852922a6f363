#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include <plisse/base/types.h>
#include <plisse/picture/camera.h>

namespace plisse {

/// A triangle on the picture plane. x and y in pixels from the top left corner; nearness, the third coordinate, is
/// affine over the plane, larger towards the viewer.
struct ScreenTriangle {
    std::array<Vec3, 3> corners;
    int face = 0; ///< of the mesh it is a part of
};

/// What a camera sees of a mesh: nearness is 1/distance along forward. Faces that cross the near plane are cut there;
/// faces with a corner that is not finite are passed over.
std::vector<ScreenTriangle> project(const ConstPositions& positions, std::span<const Face> faces, const Camera& camera,
                                    int width, int height);

/// The samples of some rows of pixels: samples_per_axis squared for each pixel, on a grid.
struct SampleBand {
    int first_row = 0, row_count = 0, width = 0, samples_per_axis = 1;
    std::vector<int> face; ///< nearest at each sample, -1 where there is none; rows of samples from the top
    std::vector<float> nearness;

    int sample_width() const { return width * samples_per_axis; }
    std::size_t index(int sample_x, int sample_row) const {
        return static_cast<std::size_t>(sample_row) * static_cast<std::size_t>(sample_width()) +
               static_cast<std::size_t>(sample_x);
    }
};

/// Finds the nearest triangle at every sample; of two equally near ones the earlier. Triangles that share an edge leave
/// no hole between them. Hands over the picture in bands of rows, in any order and from several threads.
void rasterise(std::span<const ScreenTriangle> triangles, int width, int height, int samples_per_axis,
               const std::function<void(const SampleBand&)>& receive);

} // namespace plisse
