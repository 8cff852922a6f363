#pragma once

#include <span>
#include <string>
#include <vector>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// Polygons of a mesh file turned into triangles that fan from the first corner, with what attributes need to follow.
class PolygonFan {
public:
    /// corners: at least 3 vertex numbers.
    void add(std::span<const int> corners);

    int polygon_count() const { return polygon_count_; }
    int corner_count() const { return corner_count_; }
    std::vector<Face>& faces() { return faces_; }

    /// Values a polygon, or a polygon corner, spread over the triangles. width numbers an element.
    MeshAttribute face_attribute(std::string name, int width, std::span<const double> values) const;
    MeshAttribute corner_attribute(std::string name, int width, std::span<const double> values) const;

    /// A sentence when polygons were cut up, else nothing is added.
    void add_note(std::vector<std::string>& notes) const;

private:
    std::vector<Face> faces_;
    std::vector<int> polygon_;       ///< of each triangle
    std::vector<Face> face_corners_; ///< of each triangle, counted over all polygons
    int polygon_count_ = 0;
    int corner_count_ = 0;
    int larger_ = 0; ///< polygons with more than three corners
};

} // namespace plisse
