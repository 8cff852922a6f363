#pragma once

#include <vector>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// Texture coordinates as points of their own: a vertex on a seam has several.
struct TextureMap {
    std::vector<Vec2> points;
    std::vector<int> vertices; ///< of each point: the one vertex it belongs to
    std::vector<Face> faces;   ///< of each face: its corners' points

    bool empty() const { return points.empty(); }
};

/// From the attribute "uv" of vertices or corners; empty where the mesh has none.
TextureMap texture_map(const TriangleMesh& mesh);

} // namespace plisse
