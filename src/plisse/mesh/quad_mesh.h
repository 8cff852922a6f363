#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// Vertex indices of a quadrilateral, counter-clockwise seen from its front.
using Quad = std::array<int, 4>;

/// A mesh of quadrilaterals as index arrays.
struct QuadMesh {
    Positions positions; ///< m
    std::vector<Quad> faces;

    int vertex_count() const { return static_cast<int>(positions.cols()); }
    int face_count() const { return static_cast<int>(faces.size()); }
};

/// Reads an OBJ file of quadrilaterals; order of vertices and faces kept. Throws InputError that names the file, and
/// the line of a face that has not four different corners, or that makes the mesh unfit for subdivision:
/// - edges have one face or two, which run along them in opposite directions, and the faces around a vertex hang
///   together across its edges;
/// - every vertex has faces: one or more on the boundary, 3 to 8 within the surface.
QuadMesh read_quad_mesh(const std::filesystem::path& path);

/// read_quad_mesh on bytes in memory; the path tells the format and stands in messages.
QuadMesh parse_quad_mesh(std::string_view bytes, const std::filesystem::path& path);

/// A flat sheet of cells[0] x cells[1] equal faces over size[0] x size[1] metres in the xz-plane, centred at the
/// origin, normals +y: vertex j (cells[0] + 1) + i is number i along x and j along z. The first edge of every face runs
/// along +z, the second along +x. Sizes > 0, cells >= 1.
QuadMesh quad_sheet(const std::array<double, 2>& size, const std::array<int, 2>& cells);

} // namespace plisse
