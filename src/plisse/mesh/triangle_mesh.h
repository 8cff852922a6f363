#pragma once

#include <string>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// Values a mesh file carries beside positions: kept so that they reach the output again.
struct MeshAttribute {
    enum class Domain { vertex, face, corner };
    enum class Number { real, int32, uint8 };
    std::string name; ///< as in the file ("uv" for texture coordinates)
    Domain domain = Domain::vertex;
    int width = 1;                ///< numbers per element
    std::vector<double> values;   ///< width numbers per element; corners are ordered by face, then corner
    Number number = Number::real; ///< how files store the values
};

/// A triangle mesh as index arrays. Vertices that no face uses keep their numbers and take no part.
struct TriangleMesh {
    Positions positions; ///< m
    std::vector<Face> faces;
    std::vector<MeshAttribute> attributes;

    int vertex_count() const { return static_cast<int>(positions.cols()); }
    int face_count() const { return static_cast<int>(faces.size()); }
};

} // namespace plisse
