#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <plisse/base/types.h>

namespace plisse::studio {

/// The binary messages to the page, little-endian; docs of the layout stand with encode_mesh and encode_positions.
/// Both begin with the header u32 kind, u32 level, u32 version, u32 vertices, f64 t (24 bytes).
using Bytes = std::vector<unsigned char>;

/// A mesh to be shown. `version` numbers it; positions refer to it.
struct MeshMessage {
    std::uint32_t level = 0, version = 0, vertices = 0;
    double t = 0; ///< s
    std::span<const Face> faces;
    std::span<const int> parts;  ///< of each face, from 0
    bool unusable = false;       ///< it is shown because it cannot be used
    std::span<const int> marked; ///< the faces where it shows; of an unusable mesh only
};

/// Kind 1: the header, u32 faces, u32 flags (1: unusable), u32 corners (3 a face), u32 parts (1 a face); of an unusable
/// mesh then u32 count and u32 marked faces.
Bytes encode_mesh(const MeshMessage& mesh);

/// Colours that come with positions.
struct ShownScalars {
    std::span<const double> values; ///< one a vertex; NaN: none
    double low = 0, high = 1;       ///< the ends of the colour map
};

struct PositionsMessage {
    std::uint32_t level = 0, version = 0, step = 0;
    double t = 0;             ///< s
    bool saved_frame = false; ///< not the running state
    bool prolonged = false;   ///< the finest mesh by prolongation alone
};

/// Kind 2: the header, u32 flags (1: scalars, 2: a saved frame, 4: prolonged), u32 step, f32 positions (3 a vertex);
/// where there are scalars then f32 low, f32 high, f32 scalars (1 a vertex).
/// positions: 3 x vertices, m. scalars: null: none.
Bytes encode_positions(const PositionsMessage& message, const ConstPositions& positions,
                       const ShownScalars* scalars = nullptr);

} // namespace plisse::studio
