#pragma once

#include <array>
#include <string>
#include <vector>

#include <plisse/exports/animation.h>
#include <plisse/exports/texture_map.h>

namespace plisse {

/// The faces of one part as a mesh of its own. Vertices that no face uses are in no part.
struct PartMesh {
    std::string name;
    std::vector<int> vertices;    ///< their numbers in the whole mesh, ascending
    std::vector<Face> faces;      ///< of numbers within `vertices`
    TextureMap texture;           ///< its vertices are numbers within `vertices`
    std::array<float, 3> color{}; ///< linear; that of the part wherever it is shown

    /// The part's points out of those of the whole mesh, as most formats hold them.
    Eigen::Matrix3Xf points_of(const Positions& positions) const;
};

/// The parts that have faces, in their order. `first` is any state of the animation.
std::vector<PartMesh> split_parts(const Animation& animation, const TriangleMesh& first);

/// For each part: whether one of its points ever moves. Reads states until all are known to.
std::vector<bool> find_moving_parts(const Animation& animation, const std::vector<PartMesh>& parts);

} // namespace plisse
