#include <algorithm>

#include "cli_fixture.h"

namespace plisse {
namespace {

/// A cloth that falls for six steps on a coarse level, then settles on two; beside it an obstacle.
constexpr const char* falling_cloth = R"({"plisse": 1, "name": "fall",
    "bodies": [{"name": "cloth", "mesh": {"generate": "sheet", "size": [0.2, 0.2], "cells": [8, 8], "pattern": "regular"}}],
    "handles": [{"name": "edge", "body": "cloth", "select": {"box": [[-0.11, -1, -1], [-0.09, 1, 1]]}}],
    "obstacles": [{"name": "ball", "mesh": {"generate": "sphere", "radius": 0.05, "edge_length": 0.04},
                   "transform": {"translate": [0, -1, 0]}}],
    "hierarchy": {"levels": 2, "coarsest_vertices": 40}, "solve": {"duration": 0.6, "time_step": 0.1}})";

class Export : public Cli {
protected:
    void SetUp() override {
        write("scene.json", falling_cloth);
        const Outcome outcome = run({"run", at("scene.json"), "-o", at("out"), "--quiet"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
    }
    Outcome export_run(const std::string& format, const std::string& file, std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"export", at("out"), "--format", format, "-o", at(file)});
        return run(more);
    }
    void expect_refused(const std::string& format, const std::string& file, const std::string& fragment,
                        std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"export", at("out"), "--format", format, "-o", at(file)});
        expect_unusable(more, fragment);
    }
    int count_files(const std::string& folder) const {
        return static_cast<int>(std::distance(fs::directory_iterator(at(folder)), fs::directory_iterator()));
    }
};

TEST_F(Export, WritesTheTimelineInEveryFormat) {
    for (const auto& [format, file] : {std::pair{"usd", "a.usda"},
                                       {"gltf", "a.glb"},
                                       {"gltf", "b.gltf"},
                                       {"pvd", "a.pvd"},
                                       {"pc2", "a.pc2"},
                                       {"obj", "objects"},
                                       {"ply", "surfaces"}}) {
        const Outcome outcome = export_run(format, file);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_NE(outcome.out.find("8 states of level 0, from 0 to 0.7 s"), std::string::npos) << outcome.out;
        EXPECT_TRUE(fs::exists(at(file))) << file;
    }
    EXPECT_EQ(count_files("surfaces"), 8);
    EXPECT_EQ(count_files("a"), 8);
    const Json gltf = Json::parse(read_text(at("b.gltf")));
    EXPECT_EQ(gltf["meshes"][0]["name"], "cloth");
    EXPECT_EQ(gltf["meshes"][1]["name"], "ball");
    EXPECT_EQ(gltf["meshes"][0]["primitives"][0]["targets"].size(), 7u);
    EXPECT_NE(read_text(at("a.usda")).find("def Mesh \"ball\""), std::string::npos);
}

TEST_F(Export, ChoosesStatesAndTheirTimes) {
    EXPECT_EQ(export_run("ply", "fine", {"--level", "1"}).code, 0);
    EXPECT_EQ(count_files("fine"), 2);
    EXPECT_EQ(export_run("ply", "few", {"--every", "3"}).code, 0);
    EXPECT_EQ(count_files("few"), 4); // 0, 3, 6 and the last
    EXPECT_EQ(export_run("pvd", "a.pvd", {"--fps", "25"}).code, 0);
    EXPECT_NE(read_text(at("a.pvd")).find("timestep=\"0.28\""), std::string::npos);
    EXPECT_EQ(export_run("ply", "last.ply", {"--final"}).code, 0);
    EXPECT_EQ(read_text(at("last.ply")), read_text(at("out/final.ply")));
    EXPECT_EQ(run({"check", at("fine/fine.0002.ply")}).code, 0);
}

TEST_F(Export, RefusesWhatItCannotDo) {
    expect_refused("fbx", "a.fbx", "give usd, gltf, pvd, pc2, obj or ply");
    expect_refused("usd", "a.glb", "ends in .usda or .usd");
    expect_refused("obj", "a.obj", "give the name of a folder");
    expect_refused("usd", "nowhere/a.usda", "its folder does not exist");
    expect_refused("usd", "a.usda", "(how many): 0 (8), 1 (2)", {"--level", "7"});
    expect_refused("usd", "a.usda", "--final", {"--final", "--level", "1"});
    expect_refused("usd", "a.usda", "--every", {"--every", "0"});
    expect_unusable({"export", at("scene.json"), "--format", "usd", "-o", at("a.usda")}, "the output folder of a run");
    write("a.bin", "mine");
    expect_refused("gltf", "a.gltf", "a.bin: it exists already");
    EXPECT_EQ(read_text(at("a.bin")), "mine");
    expect_refused("ply", "out", "the folder holds other things", {"--overwrite"});
    EXPECT_EQ(export_run("gltf", "a.gltf", {"--overwrite"}).code, 0);
    EXPECT_EQ(export_run("gltf", "a.gltf", {"--overwrite"}).code, 0);
}

TEST_F(Export, DamagedRunsLeaveNothingHalfWritten) {
    const auto files_here = [&] { return count_files(""); };
    const int before = files_here();
    const std::string frame = read_text(at("out/frames/0/000005.ply"));
    write("out/frames/0/000005.ply", frame.substr(0, frame.size() - 9));
    for (const auto& [format, file] : {std::pair{"usd", "a.usda"}, {"gltf", "a.gltf"}, {"pvd", "a.pvd"}, {"obj", "a"}})
        expect_refused(format, file, "out/frames/0/000005.ply");
    fs::copy_file(at("out/frames/1/000000.ply"), at("out/frames/0/000005.ply"), fs::copy_options::overwrite_existing);
    expect_refused("pc2", "a.pc2", "it is not of the same mesh as");
    fs::remove(at("out/frames/0/000005.ply"));
    expect_refused("usd", "a.usda", "000005.ply: the frame is missing");
    fs::remove_all(at("out/frames"));
    expect_refused("usd", "a.usda", "the run has saved no frames");
    EXPECT_EQ(export_run("usd", "a.usda", {"--final"}).code, 0);
    fs::remove(at("a.usda"));
    fs::remove(at("out/final.ply"));
    expect_refused("usd", "a.usda", "final.ply: it is missing", {"--final"});
    EXPECT_EQ(files_here(), before);
}

} // namespace
} // namespace plisse
