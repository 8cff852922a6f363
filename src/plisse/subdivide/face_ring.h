#pragma once

#include <array>
#include <vector>

#include <plisse/subdivide/control_mesh.h>

namespace plisse {

/// A domain face with the faces around it, in an order that depends on the valences of its corners alone. Its points
/// are the corners, then for every corner c those that go round it counter-clockwise from the face across side c - 1 to
/// the one across side c: edge neighbour, face's far corner, edge neighbour, ..., 2 valence[c] - 5 in number.
struct FaceRing {
    std::array<int, 4> valence;
    std::vector<int> points; ///< vertices; one may occur twice on a small mesh

    bool is_ordinary() const { return valence == std::array<int, 4>{4, 4, 4, 4}; }
};

FaceRing face_ring(const ControlMesh& mesh, const QuadConnectivity& connectivity, int face);

/// The control mesh of one domain face, its vertices numbered as the points of the ring. No boundary sides.
ControlMesh ring_mesh(const std::array<int, 4>& valence);

/// Of the 16 points of an ordinary ring: the place on the grid with the face between (0, 0) and (1, 1), -1 to 2.
extern const std::array<std::array<int, 2>, 16> ordinary_places;

} // namespace plisse
