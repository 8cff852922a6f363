#pragma once

#include <array>
#include <span>
#include <vector>

#include <plisse/base/error.h>
#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// Surfaces that intersect where a run is to begin, with the faces that do.
class IntersectingSurfaces : public InputError {
public:
    /// pairs: of faces that intersect at x. face_part: the body or obstacle of each face.
    IntersectingSurfaces(const InputError& error, const Positions& x, std::span<const Face> faces,
                         std::span<const std::array<int, 2>> pairs, std::span<const int> face_part);

    /// The faces that meet others, as a mesh of its own without common vertices.
    const TriangleMesh& faces() const { return faces_; }
    /// The part of each.
    const std::vector<int>& parts() const { return parts_; }

private:
    TriangleMesh faces_;
    std::vector<int> parts_;
};

/// The middle of what the boxes of two intersecting faces have in common.
Vec3 meeting_place(const Positions& x, const Face& a, const Face& b);

} // namespace plisse
