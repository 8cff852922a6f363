#include "mesh_samples.h"

#include <limits>

namespace plisse {
namespace {

const std::vector<Face> tetrahedron_faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

void expect_tetrahedron(const TriangleMesh& mesh) {
    Positions expected(3, 4);
    expected << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    EXPECT_EQ(mesh.positions, expected);
    EXPECT_EQ(mesh.faces, tetrahedron_faces);
}

const MeshAttribute* find_attribute(const TriangleMesh& mesh, const std::string& name) {
    for (const MeshAttribute& attribute : mesh.attributes)
        if (attribute.name == name)
            return &attribute;
    return nullptr;
}

TEST(ReadMesh, ReadsObjWithTextureCoordinatesAtCorners) {
    const TemporaryFolder folder;
    const MeshFile file = read_mesh(folder.write("t.obj", tetrahedron_obj()));
    expect_tetrahedron(file.mesh);
    EXPECT_TRUE(file.notes.empty());
    const MeshAttribute* uv = find_attribute(file.mesh, "uv");
    ASSERT_NE(uv, nullptr);
    EXPECT_EQ(uv->domain, MeshAttribute::Domain::corner);
    ASSERT_EQ(uv->values.size(), 24u);
    EXPECT_EQ(std::vector<double>(uv->values.begin(), uv->values.begin() + 6),
              (std::vector<double>{0, 0, 1, 0, 0.5, 1}));
}

TEST(ReadMesh, ReadsObjTextureCoordinatesThatFollowTheVertices) {
    const TemporaryFolder folder;
    const MeshFile file =
        read_mesh(folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 3/3 1/1 2/2\n"));
    ASSERT_EQ(file.mesh.attributes.size(), 1u);
    EXPECT_EQ(file.mesh.attributes[0].domain, MeshAttribute::Domain::vertex);
    EXPECT_EQ(file.mesh.attributes[0].values, (std::vector<double>{0, 0, 1, 0, 0, 1}));
}

TEST(ReadMesh, ReadsWhatObjFilesReallyHold) {
    const TemporaryFolder folder;
    const MeshFile file = read_mesh(folder.write(
        "t.OBJ", "\xef\xbb\xbfmtllib a.mtl\r\no thing\r\nf 1//1 \\\r\n 2//1 3//1 # forward, continued\r\nvn 0 0 1\r\n"
                 "v +0.1 1e-400 2.5E-1 1.0\r\nv 1 0 0\r\nv 0 1 0\r\nseam 1 2\r\nf -3 -2 -1"));
    EXPECT_EQ(file.mesh.faces, (std::vector<Face>{{0, 1, 2}, {0, 1, 2}}));
    EXPECT_EQ(file.mesh.positions.col(0), Vec3(0.1, 0, 0.25));
    ASSERT_EQ(file.notes.size(), 1u);
    EXPECT_NE(file.notes[0].find("line 9"), std::string::npos) << file.notes[0];
}

TEST(ReadMesh, KeepsObjColours) {
    const TemporaryFolder folder;
    const MeshFile file =
        read_mesh(folder.write("t.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 1 0.25 0\nv 0 1 0 1 0 0\nf 1 2 3\n"));
    ASSERT_NE(find_attribute(file.mesh, "green"), nullptr);
    EXPECT_EQ(find_attribute(file.mesh, "green")->values, (std::vector<double>{0.5, 0.25, 0}));
}

TEST(ReadMesh, RoundsDecimalsCorrectly) {
    const TemporaryFolder folder;
    const MeshFile file = read_mesh(
        folder.write("t.obj", "v 0.30000000000000004 5e-324 1.7976931348623157e308\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    EXPECT_EQ(file.mesh.positions(0, 0), 0.1 + 0.2);
    EXPECT_EQ(file.mesh.positions(1, 0), std::numeric_limits<double>::denorm_min());
    EXPECT_EQ(file.mesh.positions(2, 0), std::numeric_limits<double>::max());
}

TEST(ReadMesh, FansLargerFacesFromTheFirstCornerAndTheAttributesFollow) {
    const TemporaryFolder folder;
    const MeshFile file = read_mesh(
        folder.write("p.ply", "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\n"
                              "property double z\nelement face 2\nproperty int tag\n"
                              "property list uchar uint vertex_index\nproperty list uchar float corner_w\n"
                              "end_header\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n"
                              "5 3 2 1 0 3 7 8 9\n6 5 0 1 2 3 4 5 10 11 12 13 14\n"));
    EXPECT_EQ(file.mesh.faces, (std::vector<Face>{{2, 1, 0}, {0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
    EXPECT_EQ(find_attribute(file.mesh, "tag")->values, (std::vector<double>{5, 6, 6, 6}));
    EXPECT_EQ(find_attribute(file.mesh, "w")->values,
              (std::vector<double>{7, 8, 9, 10, 11, 12, 10, 12, 13, 10, 13, 14}));
    ASSERT_EQ(file.notes.size(), 1u);
    EXPECT_EQ(file.notes[0].substr(0, 7), "1 face ");
}

TEST(ReadMesh, ReadsOffAndItsVariants) {
    const TemporaryFolder folder;
    expect_tetrahedron(read_mesh(folder.write("t.off", tetrahedron_off())).mesh);
    const std::string counts = " 3 1 0\n";
    const std::string face = "3 0 1 2\n";
    for (const std::string& text : {"NOFF" + counts + "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n" + face,
                                    "COFF" + counts + "0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n" + face,
                                    "OFF" + counts + "# points\n0 0 0\n\n1 0 0 # second\n0 1 0\n" + face}) {
        const MeshFile file = read_mesh(folder.write("v.off", text));
        EXPECT_EQ(file.mesh.positions.col(1), Vec3(1, 0, 0));
        EXPECT_EQ(file.mesh.faces, (std::vector<Face>{{0, 1, 2}}));
        EXPECT_TRUE(file.mesh.attributes.empty());
    }
    const MeshFile file = read_mesh(folder.write(
        "v.off",
        "STCNOFF" + counts + "0 0 0 0 0 1 1 1 1 1 .5 .25\n1 0 0 0 0 1 1 1 1 1 1 0\n0 1 0 0 0 1 1 1 1 1 0 1\n" + face));
    EXPECT_EQ(find_attribute(file.mesh, "uv")->values, (std::vector<double>{0.5, 0.25, 1, 0, 0, 1}));
}

TEST(ReadMesh, ReadsTextPlyWithUnknownElementsAndKeepsProperties) {
    const TemporaryFolder folder;
    const MeshFile file = read_mesh(folder.write("t.ply", tetrahedron_ply_text()));
    expect_tetrahedron(file.mesh);
    const MeshAttribute* red = find_attribute(file.mesh, "red");
    ASSERT_NE(red, nullptr);
    EXPECT_EQ(red->values, (std::vector<double>{10, 20, 30, 40}));
    EXPECT_EQ(red->number, MeshAttribute::Number::uint8);
    EXPECT_EQ(find_attribute(file.mesh, "group")->values, (std::vector<double>{7, 8, 9, -1}));
    EXPECT_EQ(find_attribute(file.mesh, "group")->domain, MeshAttribute::Domain::face);
}

TEST(ReadMesh, ReadsBinaryPlyOfEitherByteOrder) {
    const TemporaryFolder folder;
    for (bool big_endian : {false, true}) {
        const MeshFile file = read_mesh(folder.write("t.ply", tetrahedron_ply_binary(big_endian)));
        expect_tetrahedron(file.mesh);
        EXPECT_EQ(find_attribute(file.mesh, "tag")->values, std::vector<double>(4, -3));
        const MeshAttribute* uv = find_attribute(file.mesh, "uv");
        ASSERT_NE(uv, nullptr);
        EXPECT_EQ(uv->domain, MeshAttribute::Domain::corner);
        EXPECT_EQ(uv->width, 2);
        EXPECT_EQ(uv->values[23], 1.25);
    }
}

TEST(ReadMesh, ReadsEveryPlyType) {
    const TemporaryFolder folder;
    std::string bytes = "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
                        "property double z\nproperty int8 a\nproperty uint8 b\nproperty int16 c\nproperty uint16 d\n"
                        "property int32 e\nproperty uint32 f\nproperty float32 g\nproperty float64 h\n"
                        "element face 1\nproperty list uint uint vertex_indices\nend_header\n";
    for (int v = 0; v < 3; ++v)
        bytes += raw_bytes(double(v), true) + raw_bytes(double(v * v), true) + raw_bytes(0.0, true) +
                 raw_bytes(std::int8_t{-100}) + raw_bytes(std::uint8_t{200}) + raw_bytes(std::int16_t{-30000}, true) +
                 raw_bytes(std::uint16_t{60000}, true) + raw_bytes(std::int32_t{-2000000000}, true) +
                 raw_bytes(std::uint32_t{4000000000}, true) + raw_bytes(0.5f, true) + raw_bytes(0.1, true);
    for (std::uint32_t value : {3u, 0u, 1u, 2u})
        bytes += raw_bytes(value, true);
    const TriangleMesh mesh = read_mesh(folder.write("t.ply", bytes)).mesh;
    const double expected[] = {-100, 200, -30000, 60000, -2000000000.0, 4000000000.0, 0.5, 0.1};
    ASSERT_EQ(mesh.attributes.size(), 8u);
    for (std::size_t k = 0; k < 8; ++k)
        EXPECT_EQ(mesh.attributes[k].values, std::vector<double>(3, expected[k])) << mesh.attributes[k].name;
}

TEST(ReadMesh, ReadsStlAndMergesEqualCorners) {
    const TemporaryFolder folder;
    for (const std::string& bytes : {tetrahedron_stl_text(), tetrahedron_stl_binary()}) {
        const TriangleMesh mesh = read_mesh(folder.write("t.stl", bytes)).mesh;
        EXPECT_EQ(mesh.vertex_count(), 4);
        ASSERT_EQ(mesh.face_count(), 4);
        for (std::size_t f = 0; f < 4; ++f)
            for (std::size_t k = 0; k < 3; ++k)
                for (int i = 0; i < 3; ++i)
                    EXPECT_EQ(mesh.positions(i, mesh.faces[f][k]), tetrahedron_corners()[f][k][i]);
    }
    std::string minus_zero = tetrahedron_stl_text();
    minus_zero.replace(minus_zero.find("vertex 0.0"), 10, "vertex -0.0");
    EXPECT_EQ(read_mesh(folder.write("t.stl", minus_zero)).mesh.vertex_count(), 4);
}

struct BadFile {
    const char* name;
    std::string bytes;
    const char* message; ///< what the message must hold after the folder's path
};

std::string ply_with(const std::string& vertices, const std::string& faces) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
           vertices + faces;
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return text.replace(at, from.size(), to);
}

std::vector<BadFile> bad_files() {
    const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const std::string p = "0 0 0\n1 0 0\n0 1 0\n";
    const std::string off = tetrahedron_off();
    const std::string ply = tetrahedron_ply_text();
    const std::string binary = tetrahedron_ply_binary(false);
    const std::string stl = tetrahedron_stl_binary();
    std::string stl_nan = stl;
    stl_nan.replace(84 + 12, 4, raw_bytes(std::numeric_limits<float>::quiet_NaN()));
    std::string many_properties = "ply\nformat ascii 1.0\nelement vertex 3\n";
    for (int k = 0; k < 300; ++k)
        many_properties += "property float p" + std::to_string(k) + "\n";
    return {
        {"a.obj", v + "f 1 2 9\n", "a.obj:4: a face refers to vertex 9 of 3;"},
        {"a.obj", v + "f 1 2 0\n", "a.obj:4: a face refers to vertex 0"},
        {"a.obj", v + "f 1 2 -4\n", "a.obj:4: a face refers to vertex -4"},
        {"a.obj", v + "f 1 2 99999999999\n", "a.obj:4:"},
        {"a.obj", v + "f 1 2 99999999999999999999999\n", "a.obj:4: '99999999999999999999999' is no face corner;"},
        {"a.obj", v + "f 1 2 x\n", "a.obj:4: 'x' is no face corner;"},
        {"a.obj", v + "f 1/ 2/ 3/\n", "a.obj:4: '1/' is no face corner;"},
        {"a.obj", v + "f 1/1 2/1 3/1\n", "a.obj:4: a face refers to texture point 1 of 0;"},
        {"a.obj", v + "f 1 2\n", "a.obj:4: a face with 2 corners;"},
        {"a.obj", "v nan 0 0\n" + v + "f 1 2 3\n", "a.obj:1: 'nan' is not a finite coordinate;"},
        {"a.obj", v + "v 0 inf 0\nf 1 2 3\n", "a.obj:4: 'inf' is not a finite coordinate;"},
        {"a.obj", v + "v 0 0 1e999\nf 1 2 3\n", "a.obj:4: '1e999' is not a finite coordinate;"},
        {"a.obj", v + "v 0 0x10 0\nf 1 2 3\n", "a.obj:4: '0x10' is no number"},
        {"a.obj", v + "v 1 2\nf 1 2 3\n", "a.obj:4: the line ends before the z coordinate;"},
        {"a.obj", "f 1 2 3\n", "a.obj:1:"},
        {"a.obj", v, "a.obj: has no faces;"},
        {"a.obj", "# nothing\n", "a.obj: has no vertices;"},
        {"a.obj", "", "a.obj: is empty;"},
        {"a.fbx", v, "a.fbx: has the unknown extension '.fbx';"},
        {"a", v, "a: has the unknown extension '';"},
        {"a.off", changed(off, "3 1 2 3\n", ""), "a.off: ends before face 3 of 4;"},
        {"a.off", changed(off, "4 4 6", "4000000000 4 6"), "a.off:2: the count of vertices is 4000000000"},
        {"a.off", changed(off, "4 4 6", "4 -4 6"), "a.off:2: the count of faces is -4"},
        {"a.off", changed(off, "4 4 6", "4"), "a.off:2: the line ends before the count of faces;"},
        {"a.off", changed(off, "3 1 2 3", "3 1 2 4"), "a.off:11: a face refers to vertex 4 of 4;"},
        {"a.off", changed(off, "3 1 2 3", "2 1 2"), "a.off:11: a face with 2 corners;"},
        {"a.off", changed(off, "3 1 2 3", "9 1 2 3"), "a.off:11: a face of 9 corners lists 3;"},
        {"a.off", changed(off, "1 0 0", "1 0 -inf"), "a.off:4: '-inf' is not a finite coordinate;"},
        {"a.off", changed(off, "OFF", "4OFF"), "a.off:1: '4OFF'"},
        {"a.off", "OFF BINARY\n", "a.off:1: binary OFF is not read;"},
        {"a.off", "OFF\n", "a.off: ends before the counts of vertices and faces;"},
        {"a.ply", "hello", "a.ply:1: does not begin with the word ply;"},
        {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\n", "a.ply: ends before end_header;"},
        {"a.ply", changed(ply, "ascii 1.0", "ascii 2.0"), "a.ply:2: an unknown format;"},
        {"a.ply", changed(ply, "property float x", "property half x"), "a.ply:5: 'half' is no type;"},
        {"a.ply", changed(ply, "property float x", "property float y"), "a.ply:6: a second property 'y';"},
        {"a.ply", changed(ply, "property float x", "property float w"), "a.ply: its vertices have no number x;"},
        {"a.ply", changed(ply, "list uchar int", "list float int"), "a.ply:10: a list whose count is no integer;"},
        {"a.ply", changed(ply, "list uchar int", "list uchar float"), "a.ply: its faces have no list vertex_indices"},
        {"a.ply", changed(ply, "element vertex 4", "element vertex 4000000000"),
         "a.ply: announces 4000000000 elements"},
        {"a.ply", changed(ply, "element vertex 4", "element vertex -4"), "a.ply:4: a negative count;"},
        {"a.ply", changed(ply, "element face 4", "element facet 4"), "a.ply: has no element face;"},
        {"a.ply", many_properties, "a.ply:260: more than 256 properties"},
        {"a.ply", ply_with(p, "3 0 1 3\n"), "a.ply:13: face 0 refers to vertex 3 of 3;"},
        {"a.ply", ply_with(p, "3 0 1 -1\n"), "a.ply:13: face 0 refers to vertex -1 of 3;"},
        {"a.ply", ply_with(p, "2 0 1\n"), "a.ply:13: face 0 has 2 corners;"},
        {"a.ply", ply_with(p, "3 0 1\n"), "a.ply:13: face 0 has a list 'vertex_indices' of 3 entries"},
        {"a.ply", ply_with(p, "3 0 1 1.5\n"), "a.ply:13: '1.5' is out of the range"},
        {"a.ply", ply_with(p, "3 0 1 2 7\n"), "a.ply:13: more numbers than the header announces;"},
        {"a.ply", ply_with(p, ""), "a.ply: announces 1 elements 'face' and is too short"},
        {"a.ply", ply_with("0 0 0\n1 nan 0\n0 1 0\n", "3 0 1 2\n"),
         "a.ply:11: vertex 1 has a coordinate that is not finite;"},
        {"a.ply", ply_with("0 0 0\n1 0\n0 1 0\n", "3 0 1 2\n"), "a.ply:11: the line ends before z;"},
        {"a.ply", binary.substr(0, binary.size() - 1), "a.ply: "},
        {"a.ply", changed(binary, "element face 4", "element face 4000000000"), "a.ply: announces 4000000000 elements"},
        {"a.stl", stl.substr(0, 200), "a.stl:"},
        {"a.stl", stl_nan, "a.stl: triangle 0 has a coordinate that is not finite;"},
        {"a.stl", "x" + stl.substr(1, 79) + raw_bytes(std::uint32_t{4000000000}) + stl.substr(84),
         "a.stl: announces 4000000000 triangles and holds 4;"},
        {"a.stl", "binary?", "a.stl: is neither text"},
        {"a.stl", changed(tetrahedron_stl_text(), "endloop", "vertex 0 0 0"),
         "a.stl:7: 'vertex' where 'endloop' belongs;"},
        {"a.stl", changed(tetrahedron_stl_text(), "endsolid tetrahedron\n", ""), "a.stl: ends before endsolid;"},
        {"a.stl", changed(tetrahedron_stl_text(), "vertex 0.000000 0.000000", "vertex 0 q"),
         "a.stl:4: 'q' is no number"},
        {"a.stl", "solid nothing\nendsolid\n", "a.stl: has no vertices;"},
    };
}

TEST(ReadMesh, RefusesBadFilesAndSaysWhatIsWrongWhere) {
    const TemporaryFolder folder;
    for (const BadFile& bad : bad_files()) {
        const std::string message = refusal(folder.write(bad.name, bad.bytes));
        const std::string expected = folder.path().string() + "/" + bad.message;
        EXPECT_EQ(message.substr(0, expected.size()), expected) << message;
        EXPECT_NE(message.find("; "), message.npos) << message;
    }
}

TEST(ReadMesh, RefusesWhatIsNoFile) {
    const TemporaryFolder folder;
    EXPECT_NE(refusal(folder.path() / "absent.obj").find("absent.obj: no such file; "), std::string::npos);
    std::filesystem::create_directory(folder.path() / "folder.obj");
    EXPECT_NE(refusal(folder.path() / "folder.obj").find("folder.obj: is a folder; "), std::string::npos);
}

} // namespace
} // namespace plisse
