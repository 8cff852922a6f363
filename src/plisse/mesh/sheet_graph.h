#pragma once

#include <plisse/mesh/connectivity.h>

namespace plisse {

/// How sheets, the pieces into which the edges of one face and of more than two cut a surface, hang together. Of a
/// manifold: its components, its boundary loops, and no corners.
struct SheetGraph {
    int sheets = 0;  ///< connected across edges of two faces
    int curves = 0;  ///< chains of edges of one face, or of more than two, between corners, or closed
    int corners = 0; ///< vertices where curves end or meet

    bool operator==(const SheetGraph&) const = default;
};
SheetGraph sheet_graph(const Connectivity& connectivity);

} // namespace plisse
