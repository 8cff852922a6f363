#include <cstdio>

#include <plisse/mesh/connectivity.h>
#include <plisse/mesh/generate.h>
#include <plisse/picture/scalars.h>

int main() {
    plisse::GeneratorOptions options;
    options.shape = plisse::GeneratorShape::sheet;
    options.edge_length = 0.1;
    const plisse::TriangleMesh mesh = plisse::generate_mesh(options);
    const plisse::Connectivity connectivity(mesh.vertex_count(), mesh.faces);
    const auto stretches = plisse::largest_stretches(mesh.positions, mesh.positions, mesh.faces);
    std::printf("%d vertices, %d edges, %d faces\n", mesh.vertex_count(), connectivity.edge_count(), mesh.face_count());
    const bool sound = mesh.vertex_count() - connectivity.edge_count() + mesh.face_count() == 1;
    return sound && static_cast<int>(stretches.size()) == mesh.face_count() ? 0 : 1;
}
