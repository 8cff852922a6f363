#include "mesh_samples.h"

#include <plisse/base/random.h>
#include <plisse/mesh/mesh_formats.h>

namespace plisse {
namespace {

/// A few random edits: bytes changed, cut, doubled or put in, or the end cut off.
std::string mutated(std::string bytes, Random& random) {
    static const std::string tempting = "0123456789.-+e \n\t/fvn\xff\0";
    const int edits = 1 + random.below(4);
    for (int k = 0; k < edits && !bytes.empty(); ++k) {
        const auto at = static_cast<std::size_t>(random.below(static_cast<int>(bytes.size())));
        const auto length = static_cast<std::size_t>(1 + random.below(6));
        const char tempting_byte = tempting[static_cast<std::size_t>(random.below(static_cast<int>(tempting.size())))];
        switch (random.below(6)) {
        case 0:
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
            break;
        case 1:
            bytes[at] = static_cast<char>(random.below(256));
            break;
        case 2:
            bytes[at] = tempting_byte;
            break;
        case 3:
            bytes.erase(at, length);
            break;
        case 4:
            bytes.insert(at, random.below(2) == 0 ? std::string(length, tempting_byte) : bytes.substr(at, length));
            break;
        default:
            if (random.below(4) == 0)
                bytes.resize(at);
        }
    }
    return bytes;
}

void expect_sound(const TriangleMesh& mesh) {
    EXPECT_GT(mesh.vertex_count(), 0);
    EXPECT_GT(mesh.face_count(), 0);
    EXPECT_TRUE(mesh.positions.allFinite());
    for (const Face& face : mesh.faces)
        for (int v : face)
            EXPECT_TRUE(v >= 0 && v < mesh.vertex_count());
    for (const MeshAttribute& attribute : mesh.attributes) {
        const int elements = attribute.domain == MeshAttribute::Domain::vertex ? mesh.vertex_count()
                             : attribute.domain == MeshAttribute::Domain::face ? mesh.face_count()
                                                                               : 3 * mesh.face_count();
        EXPECT_EQ(attribute.values.size(),
                  static_cast<std::size_t>(elements) * static_cast<std::size_t>(attribute.width));
    }
}

struct Sample {
    const char* name;
    std::string bytes;
};

std::ostream& operator<<(std::ostream& out, const Sample& sample) {
    return out << sample.name;
}

class MutatedMesh : public testing::TestWithParam<Sample> {};

TEST_P(MutatedMesh, IsReadSoundOrRefusedByName) {
    Random random(7);
    int refused = 0;
    constexpr int mutations = 3000;
    for (int k = 0; k < mutations; ++k) {
        try {
            expect_sound(parse_mesh(mutated(GetParam().bytes, random), GetParam().name).mesh);
        } catch (const InputError& error) {
            ++refused;
            EXPECT_EQ(std::string(error.what()).rfind(GetParam().name, 0), 0u) << error.what();
        }
    }
    EXPECT_GT(refused, mutations / 10);
    EXPECT_LT(refused, mutations);
}

INSTANTIATE_TEST_SUITE_P(Formats, MutatedMesh,
                         testing::Values(Sample{"m.obj", tetrahedron_obj()}, Sample{"m.off", tetrahedron_off()},
                                         Sample{"text.ply", tetrahedron_ply_text()},
                                         Sample{"little.ply", tetrahedron_ply_binary(false)},
                                         Sample{"big.ply", tetrahedron_ply_binary(true)},
                                         Sample{"text.stl", tetrahedron_stl_text()},
                                         Sample{"binary.stl", tetrahedron_stl_binary()}));

} // namespace
} // namespace plisse
