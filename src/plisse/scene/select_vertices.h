#pragma once

#include <plisse/scene/scene.h>

namespace plisse {

/// The vertices of a body's mesh, placed by its transform, that a selection takes; ascending. Vertices no face uses are
/// never taken. Throws InputError about the selection at this JSON pointer when it takes none or names what is not
/// there.
std::vector<int> select_vertices(const Scene& scene, const SelectSpec& select, const TriangleMesh& mesh,
                                 const std::string& pointer);

/// All vertices that some face uses; ascending.
std::vector<int> used_vertices(const TriangleMesh& mesh);

} // namespace plisse
