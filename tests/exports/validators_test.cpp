#include <cstdlib>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <plisse/exports/formats.h>

#include "exports/sample_animation.h"
#include "scene/temporary_folder.h"

namespace plisse {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// The sample as it should be found in a file, for the scripts that read it with tools of other makers.
Json describe(const Animation& animation) {
    Json json = {{"times", animation.times}, {"parts", animation.parts}, {"face_part", animation.face_part}};
    const TriangleMesh first = animation.state(0);
    json["faces"] = first.faces;
    json["corner_uv"] = first.attributes[0].values;
    for (std::size_t k = 0; k < animation.size(); ++k) {
        const TriangleMesh state = animation.state(k);
        Json points = Json::array();
        for (int v = 0; v < state.vertex_count(); ++v)
            points.push_back({state.positions(0, v), state.positions(1, v), state.positions(2, v)});
        json["points"].push_back(std::move(points));
        json["coarseness"].push_back(state.attributes[1].values);
    }
    return json;
}

/// Each test hands an exported sample to a script that reads it with a public reader and compares.
class Validators : public testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(fs::exists(fs::path(PLISSE_VALIDATORS) / "installed")) << "run scripts/validators/install";
        write_text(at("expected.json"), describe(animation_).dump());
    }
    std::string at(const std::string& file) const { return (folder_.path() / file).string(); }

    void export_and_check(const std::string& format, const std::string& file, const std::string& script) {
        write_animation(*animation_format(format), at(file), animation_);
        const bool is_python = script.ends_with(".py");
        const std::string program = is_python ? PLISSE_VALIDATORS "/python/bin/python" : "node";
        const std::string command = program + " " PLISSE_SOURCE_DIR "/tests/exports/" + script + " \"" + at(file) +
                                    "\" " + at("expected.json") + " > " + at("output.txt") + " 2>&1";
        EXPECT_EQ(std::system(command.c_str()), 0) << read_text(at("output.txt"));
        EXPECT_NE(read_text(at("output.txt")).find("all as expected"), std::string::npos);
    }

    TemporaryFolder folder_;
    Animation animation_ = sample_animation();
};

TEST_F(Validators, UsdPassesItsOwnValidatorsAndReadsBack) {
    export_and_check("usd", "a.usda", "check_usd.py");
    export_and_check("usd", "a.usd", "check_usd.py");
}

TEST_F(Validators, GltfPassesTheKhronosValidatorAndPlaysBack) {
    setenv("NODE_PATH", PLISSE_VALIDATORS "/node_modules", 1);
    export_and_check("gltf", "a.glb", "check_gltf.js");
    export_and_check("gltf", "a b.gltf", "check_gltf.js");
}

TEST_F(Validators, VtkReadsTheCollection) {
    export_and_check("pvd", "a.pvd", "check_pvd.py");
}

TEST_F(Validators, BlenderPlaysThePointCache) {
    export_and_check("pc2", "a.pc2", "check_pc2.py");
}

TEST_F(Validators, TrimeshReadsTheSequences) {
    export_and_check("obj", "objects", "check_sequence.py");
    export_and_check("ply", "surfaces", "check_sequence.py");
}

} // namespace
} // namespace plisse
