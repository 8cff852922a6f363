#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/exports/formats.h>
#include <plisse/exports/playback.h>
#include <plisse/mesh/read_mesh.h>

#include "exports/sample_animation.h"
#include "scene/temporary_folder.h"

namespace plisse {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

class Writers : public testing::Test {
protected:
    fs::path at(const std::string& file) const { return folder_.path() / file; }
    void write(const std::string& format, const std::string& file, const Animation& animation) {
        write_animation(*animation_format(format), at(file), animation);
    }
    std::vector<std::string> list(const std::string& folder = "") const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(at(folder)))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }

    TemporaryFolder folder_;
    Animation animation_ = sample_animation();
};

template <typename T>
T number_at(const std::string& bytes, std::size_t offset) {
    static_assert(std::endian::native == std::endian::little);
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

/// The first state alone.
Animation still(Animation animation) {
    animation.times.resize(1);
    return animation;
}

/// The last vertex of the sample is of no face.
Positions used_points(const TriangleMesh& mesh) {
    return mesh.positions.leftCols(mesh.vertex_count() - 1);
}

TEST_F(Writers, Pc2HoldsTheUsedPointsOfAllStatesInTheOrderOfItsMesh) {
    write("pc2", "a.pc2", animation_);
    const std::string bytes = read_text(at("a.pc2"));
    EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2\0", 12));
    EXPECT_EQ(number_at<std::int32_t>(bytes, 12), 1);
    EXPECT_EQ(number_at<std::int32_t>(bytes, 16), 15);
    EXPECT_EQ(number_at<float>(bytes, 20), 0);
    EXPECT_EQ(number_at<float>(bytes, 24), 1);
    EXPECT_EQ(number_at<std::int32_t>(bytes, 28), 5);
    ASSERT_EQ(bytes.size(), 32u + 5 * 15 * 12);
    const TriangleMesh mesh = read_mesh(at("a.obj")).mesh;
    EXPECT_EQ(mesh.faces, animation_.state(0).faces);
    EXPECT_EQ(mesh.positions, used_points(animation_.state(0)));
    std::size_t offset = 32;
    for (std::size_t k = 0; k < 5; ++k) {
        const Positions positions = used_points(animation_.state(k));
        for (double coordinate : positions.reshaped()) {
            EXPECT_EQ(number_at<float>(bytes, offset), static_cast<float>(coordinate)) << k << " " << offset;
            offset += 4;
        }
    }
    EXPECT_EQ(list(), (std::vector<std::string>{"a.obj", "a.pc2"}));
}

TEST_F(Writers, SequencesKeepEveryStateAndItsAttributes) {
    for (const std::string format : {"obj", "ply"}) {
        write(format, format, animation_);
        EXPECT_EQ(list(format).size(), 5u);
        for (std::size_t k = 0; k < 5; ++k) {
            const std::string file = format + ".000" + std::to_string(k + 1) + "." + format;
            const TriangleMesh read = read_mesh(at(format) / file).mesh, state = animation_.state(k);
            EXPECT_EQ(read.positions, state.positions) << file;
            EXPECT_EQ(read.faces, state.faces) << file;
            ASSERT_EQ(read.attributes.size(), format == "obj" ? 4u : 7u); // PLY: all six, and the body
        }
    }
    const TriangleMesh obj = read_mesh(at("obj/obj.0003.obj")).mesh, state = animation_.state(2);
    for (const MeshAttribute& attribute : obj.attributes)
        EXPECT_EQ(attribute.values,
                  attribute.name == "uv" ? state.attributes[0].values : std::vector<double>(16, 0.2)); // 51 of 255
    const TriangleMesh ply = read_mesh(at("ply/ply.0003.ply")).mesh;
    for (const MeshAttribute& attribute : ply.attributes)
        if (attribute.name == "coarseness") {
            EXPECT_EQ(attribute.values, state.attributes[1].values);
        } else if (attribute.name == "body") {
            EXPECT_EQ(attribute.values, (std::vector<double>{0, 0, 0, 0, 0, 0, 1, 2, 2}));
        }
    const std::string text = read_text(at("obj/obj.0001.obj"));
    EXPECT_LT(text.find("g cloth\nf 1/"), text.find("g 1st_\"wild\"_part\nf 9/"));
}

TEST_F(Writers, OneStateGoesIntoOneFile) {
    for (const std::string format : {"obj", "ply"}) {
        write(format, "one." + format, still(animation_));
        EXPECT_EQ(read_mesh(at("one." + format)).mesh.positions, animation_.state(0).positions);
        EXPECT_THROW(write(format, "all." + format, animation_), InputError);
        EXPECT_FALSE(fs::exists(at("all." + format)));
    }
}

TEST_F(Writers, UsdSaysWhenItPlaysAndSamplesOnlyWhatMoves) {
    write("usd", "a.usda", animation_);
    const std::string text = read_text(at("a.usda"));
    for (const char* part :
         {"#usda 1.0\n", "defaultPrim = \"two_things___a_floor\"", "timeCodesPerSecond = 10\n", "endTimeCode = 4.5\n",
          "def Mesh \"cloth\"\n", "def Mesh \"_1st__wild__part\" (\n        displayName = \"1st \\\"wild\\\" part\"\n",
          "            4.5: [(0, ", "point3f[] points = [(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)]\n"})
        EXPECT_NE(text.find(part), std::string::npos) << part;
    write("usd", "still.usda", still(animation_));
    EXPECT_EQ(read_text(at("still.usda")).find("imeSamples"), std::string::npos);
    EXPECT_EQ(list(), (std::vector<std::string>{"a.usda", "still.usda"}));
}

/// What a .glb holds.
struct Glb {
    explicit Glb(const std::string& bytes) {
        EXPECT_EQ(bytes.substr(0, 4), "glTF");
        EXPECT_EQ(number_at<std::uint32_t>(bytes, 8), bytes.size());
        const auto json_size = number_at<std::uint32_t>(bytes, 12);
        EXPECT_EQ(json_size % 4, 0u);
        json = Json::parse(bytes.substr(20, json_size));
        EXPECT_EQ(number_at<std::uint32_t>(bytes, 20 + json_size), bytes.size() - 28 - json_size);
        buffer = bytes.substr(28 + json_size);
    }
    std::vector<float> floats(const Json& accessor_number) const {
        const Json& accessor = json["accessors"][accessor_number.get<std::size_t>()];
        const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        std::vector<float> values(view["byteLength"].get<std::size_t>() / sizeof(float));
        std::memcpy(values.data(), buffer.data() + view["byteOffset"].get<std::size_t>(),
                    values.size() * sizeof(float));
        return values;
    }
    Json json;
    std::string buffer;
};

TEST_F(Writers, GltfPlaysEachStateAsATargetOfWeightOne) {
    write("gltf", "a.glb", animation_);
    const Glb glb(read_text(at("a.glb")));
    const Json& animation = glb.json["animations"][0];
    ASSERT_EQ(animation["channels"].size(), 2u);
    const Json& sampler = animation["samplers"][0];
    EXPECT_EQ(glb.floats(sampler["input"]), (std::vector<float>{0, 0.1F, 0.2F, 0.3F, 0.45F}));
    EXPECT_EQ(glb.floats(sampler["output"]),
              (std::vector<float>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}));
    const Json& hopping = glb.json["meshes"][1]["primitives"][0];
    ASSERT_EQ(hopping["targets"].size(), 4u);
    EXPECT_EQ(glb.floats(hopping["attributes"]["POSITION"]),
              (std::vector<float>{0.5F, 0.2F, 0, 0.6F, 0.2F, 0, 0.5F, 0.2F, 0.1F}));
    const std::vector<float> moved = glb.floats(hopping["targets"][3]["POSITION"]);
    for (std::size_t c = 0; c < 9; ++c)
        EXPECT_NEAR(moved[c], c % 3 == 1 ? 0.45 : 0, 1e-7);
    EXPECT_EQ(glb.floats(hopping["attributes"]["NORMAL"])[1], 1);
    EXPECT_FALSE(glb.json["meshes"][2]["primitives"][0].contains("targets"));
    // The cloth's seam: two vertices have two places on the texture.
    const Json& cloth = glb.json["meshes"][0]["primitives"][0]["attributes"];
    EXPECT_EQ(glb.json["accessors"][cloth["POSITION"].get<std::size_t>()]["count"], 10);
}

TEST_F(Writers, GltfRefusesMoreStatesThanViewersTake) {
    animation_.times.clear();
    for (int k = 0; k < 3000; ++k)
        animation_.times.push_back(k);
    animation_.state = [first = animation_.state(0)](std::size_t) { return first; };
    EXPECT_THROW(write("gltf", "a.glb", animation_), InputError);
    EXPECT_TRUE(list().empty());
}

TEST_F(Writers, LeaveNothingBehindWhenAStateCannotBeRead) {
    animation_.state = [whole = animation_.state](std::size_t k) {
        if (k == 3)
            throw InputError("frame 3", "it is damaged", "restore it");
        return whole(k);
    };
    for (const auto& [format, file] : {std::pair{"usd", "a.usda"},
                                       {"gltf", "a.glb"},
                                       {"gltf", "a.gltf"},
                                       {"pvd", "a.pvd"},
                                       {"pc2", "a.pc2"},
                                       {"obj", "a"},
                                       {"ply", "a"}}) {
        EXPECT_THROW(write(format, file, animation_), InputError) << format;
        EXPECT_EQ(list(), std::vector<std::string>()) << format;
    }
}

TEST_F(Writers, ReplaceTheirOwnFilesOnly) {
    write("ply", "a", animation_);
    write("ply", "a", still(animation_));
    EXPECT_EQ(list("a"), std::vector<std::string>{"a.0001.ply"});
    write_text(at("a/notes.txt"), "mine");
    EXPECT_THROW(write("ply", "a", animation_), InputError);
    EXPECT_THROW(write("pvd", "a.pvd", animation_), InputError);
    EXPECT_EQ(read_text(at("a/notes.txt")), "mine");
    EXPECT_EQ(list(), std::vector<std::string>{"a"});
}

TEST_F(Writers, NamesOfOtherFormatsAreRefused) {
    const auto files = [](const char* format, const char* path) {
        return exported_files(*animation_format(format), path);
    };
    EXPECT_FALSE(animation_format("fbx"));
    for (const auto& [format, path] : {std::pair{"usd", "a.glb"},
                                       {"usd", "a"},
                                       {"usd", "a.usdc"},
                                       {"gltf", "a.obj"},
                                       {"pvd", "a.vtp"},
                                       {"pc2", "a.obj"},
                                       {"obj", "a.ply"},
                                       {"ply", "a.usda"}})
        EXPECT_THROW(files(format, path), InputError) << format << " " << path;
    EXPECT_EQ(files("obj", "a.v2/"), std::vector<fs::path>{"a.v2"});
    EXPECT_EQ(files("gltf", "x/a.gltf"), (std::vector<fs::path>{"x/a.gltf", "x/a.bin"}));
    EXPECT_EQ(files("pvd", "x/a.pvd"), (std::vector<fs::path>{"x/a.pvd", "x/a"}));
}

TEST(Playback, EvenTimesGiveWholeFrames) {
    std::vector<double> times;
    double t = 0.7;
    for (int k = 0; k < 100; ++k, t += 0.1)
        times.push_back(t);
    const Playback playback = playback_of(times);
    EXPECT_EQ(playback.rate, 10);
    for (int k = 0; k < 100; ++k)
        EXPECT_EQ(playback.codes[static_cast<std::size_t>(k)], k + 7);
    EXPECT_EQ(playback_of({0, 0.4, 0.8}).rate, 2.5);
    EXPECT_EQ(playback_of({2}).codes.size(), 1u);
}

} // namespace
} // namespace plisse
