#include "mesh_samples.h"

#include <limits>

#include <plisse/mesh/generate.h>
#include <plisse/mesh/write_ply.h>

namespace plisse {
namespace {

using Domain = MeshAttribute::Domain;
using Number = MeshAttribute::Number;

std::string file_bytes(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TriangleMesh mesh_with_attributes() {
    GeneratorOptions options;
    options.edge_length = 0.2;
    TriangleMesh mesh = generate_mesh(options);
    const auto fill = [&](const char* name, Domain domain, int width, Number number) {
        const int elements = domain == Domain::vertex ? mesh.vertex_count()
                             : domain == Domain::face ? mesh.face_count()
                                                      : 3 * mesh.face_count();
        MeshAttribute attribute{name, domain, width, {}, number};
        for (int k = 0; k < elements * width; ++k)
            attribute.values.push_back(number == Number::real ? 0.1 * k - 3 : k % 200);
        mesh.attributes.push_back(attribute);
    };
    fill("temperature", Domain::vertex, 1, Number::real);
    fill("uv", Domain::vertex, 2, Number::real);
    fill("frame", Domain::vertex, 9, Number::real);
    fill("red", Domain::vertex, 1, Number::uint8);
    fill("group", Domain::face, 1, Number::int32);
    fill("axis", Domain::face, 3, Number::real);
    fill("uv", Domain::corner, 2, Number::real);
    fill("wide", Domain::corner, 100, Number::int32);
    return mesh;
}

TEST(WritePly, RoundTripsExactly) {
    const TemporaryFolder folder;
    TriangleMesh mesh = mesh_with_attributes();
    mesh.positions(0, 0) = std::numeric_limits<double>::denorm_min();
    mesh.positions(1, 0) = -0.0;
    mesh.positions(2, 0) = 0.1 + 0.2;
    write_ply(folder.path() / "m.ply", mesh);
    const MeshFile read = read_mesh(folder.path() / "m.ply");
    EXPECT_TRUE(read.notes.empty());
    EXPECT_EQ(std::memcmp(read.mesh.positions.data(), mesh.positions.data(), sizeof(double) * mesh.positions.size()),
              0);
    EXPECT_EQ(read.mesh.faces, mesh.faces);
    ASSERT_EQ(read.mesh.attributes.size(), mesh.attributes.size());
    for (std::size_t k = 0; k < mesh.attributes.size(); ++k) {
        EXPECT_EQ(read.mesh.attributes[k].name, mesh.attributes[k].name);
        EXPECT_EQ(read.mesh.attributes[k].domain, mesh.attributes[k].domain);
        EXPECT_EQ(read.mesh.attributes[k].width, mesh.attributes[k].width);
        EXPECT_EQ(read.mesh.attributes[k].number, mesh.attributes[k].number);
        EXPECT_EQ(read.mesh.attributes[k].values, mesh.attributes[k].values);
    }
    write_ply(folder.path() / "again.ply", read.mesh);
    EXPECT_EQ(file_bytes(folder.path() / "again.ply"), file_bytes(folder.path() / "m.ply"));
}

TEST(WritePly, WritesThePromisedHeaderAndBodies) {
    const TemporaryFolder folder;
    TriangleMesh mesh = read_mesh(folder.write("t.off", tetrahedron_off())).mesh;
    mesh.attributes.push_back({"body", Domain::face, 1, {9, 9, 9, 9}, Number::int32});
    const std::vector<int> body = {0, 0, 1, 2};
    write_ply(folder.path() / "m.ply", mesh, body);
    const std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment units: m\nelement vertex 4\nproperty double x\n"
        "property double y\nproperty double z\nelement face 4\n"
        "property list uchar int vertex_indices\nproperty int body\nend_header\n";
    const std::string bytes = file_bytes(folder.path() / "m.ply");
    EXPECT_EQ(bytes.substr(0, header.size()), header);
    EXPECT_EQ(bytes.size(), header.size() + 4 * 24 + 4 * (1 + 12 + 4));
    const MeshFile read = read_mesh(folder.path() / "m.ply");
    ASSERT_EQ(read.mesh.attributes.size(), 1u);
    EXPECT_EQ(read.mesh.attributes[0].values, (std::vector<double>{0, 0, 1, 2}));
}

TEST(WritePly, ReplacesAnOlderFileAndLeavesNothingElse) {
    const TemporaryFolder folder;
    const auto path = folder.write("m.ply", "older");
    write_ply(path, read_mesh(folder.write("t.off", tetrahedron_off())).mesh);
    EXPECT_EQ(read_mesh(path).mesh.face_count(), 4);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

TEST(WritePly, ThrowsWhereItCannotWriteAndLeavesNothing) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = read_mesh(folder.write("t.off", tetrahedron_off())).mesh;
    EXPECT_THROW(write_ply(folder.path() / "absent" / "m.ply", mesh), std::runtime_error);
    std::filesystem::create_directories(folder.path() / "m.ply" / "inside");
    EXPECT_THROW(write_ply(folder.path() / "m.ply", mesh), std::runtime_error);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

} // namespace
} // namespace plisse
