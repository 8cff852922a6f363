#pragma once

#include <plisse/base/context.h>
#include <plisse/mesh/quad_mesh.h>
#include <plisse/scene/scene.h>

namespace plisse {

/// The mesh a scene names at this JSON pointer, read or generated, scaled, turned and moved. Throws InputError when
/// there is none.
TriangleMesh load_mesh(const Scene& scene, const MeshSpec& spec, const TransformSpec& transform,
                       const std::string& pointer, Context& context);

/// The same for the method rmtr: an OBJ file of quads, or a sheet of the pattern quad.
QuadMesh load_quad_mesh(const Scene& scene, const MeshSpec& spec, const TransformSpec& transform,
                        const std::string& pointer);

/// Throws InputError with counts and the first places when a run could not use the mesh. allow_self_intersection: of an
/// obstacle, whose faces never meet each other.
void expect_usable(const Scene& scene, const TriangleMesh& mesh, const MeshSpec& spec, const std::string& pointer,
                   bool allow_self_intersection);

/// Throws InputError unless `other` has the faces and the vertex count of `mesh`.
void expect_same_connectivity(const Scene& scene, const TriangleMesh& mesh, const TriangleMesh& other,
                              const std::string& pointer);

/// Joins the part's vertices, faces and attributes to the end of `whole`. An attribute that one of them lacks is 0
/// there; attributes of the same name and different width are kept apart.
void append_mesh(TriangleMesh& whole, const TriangleMesh& part);

} // namespace plisse
