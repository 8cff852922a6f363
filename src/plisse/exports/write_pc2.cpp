#include <plisse/exports/write_pc2.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <plisse/exports/unfinished_files.h>
#include <plisse/exports/write_obj.h>
#include <plisse/mesh/binary_bytes.h>

namespace plisse {

namespace {

std::string header(int points, std::size_t samples) {
    std::string out("POINTCACHE2\0", 12);
    put_little_endian(out, std::int32_t{1}); // version
    put_little_endian(out, static_cast<std::int32_t>(points));
    put_little_endian(out, 0.0F); // first frame
    put_little_endian(out, 1.0F); // frames from sample to sample
    put_little_endian(out, static_cast<std::int32_t>(samples));
    return out;
}

std::string sample(const Positions& positions, const std::vector<int>& vertices) {
    std::string out;
    for (int v : vertices)
        for (double coordinate : positions.col(v))
            put_little_endian(out, static_cast<float>(coordinate));
    return out;
}

/// The vertices that faces use, ascending.
std::vector<int> used_vertices(const TriangleMesh& mesh) {
    std::vector<int> used;
    for (const Face& face : mesh.faces)
        used.insert(used.end(), face.begin(), face.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    return used;
}

/// The mesh of these vertices, ascending, which are all that its faces use.
TriangleMesh with_vertices(const TriangleMesh& mesh, const std::vector<int>& vertices) {
    TriangleMesh part;
    part.positions = mesh.positions(Eigen::all, vertices);
    part.faces = mesh.faces;
    for (Face& face : part.faces)
        for (int& v : face)
            v = static_cast<int>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
    part.attributes = mesh.attributes;
    for (MeshAttribute& attribute : part.attributes) {
        if (attribute.domain != MeshAttribute::Domain::vertex)
            continue;
        const std::vector<double> all = std::exchange(attribute.values, {});
        for (int v : vertices) {
            const auto begin = all.begin() + std::ptrdiff_t{v} * attribute.width;
            attribute.values.insert(attribute.values.end(), begin, begin + attribute.width);
        }
    }
    return part;
}

} // namespace

std::filesystem::path pc2_mesh_file(const std::filesystem::path& path) {
    return std::filesystem::path(path).replace_extension(".obj");
}

void write_pc2(const std::filesystem::path& path, const Animation& animation) {
    UnfinishedFiles unfinished;
    const TriangleMesh first = animation.state(0);
    const std::vector<int> vertices = used_vertices(first);
    write_obj(unfinished.add_file(pc2_mesh_file(path)), with_vertices(first, vertices), animation.face_part,
              animation.parts);
    OutputFile file(unfinished.add_file(path));
    file.write(header(static_cast<int>(vertices.size()), animation.size()));
    for (std::size_t k = 0; k < animation.size(); ++k)
        file.write(sample(animation.state(k).positions, vertices));
    file.close();
    unfinished.finish();
}

} // namespace plisse
