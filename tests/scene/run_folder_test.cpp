#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <plisse/base/random.h>
#include <plisse/mesh/read_mesh.h>
#include <plisse/scene/build_model.h>
#include <plisse/scene/read_scene.h>
#include <plisse/scene/run_folder.h>

#include "temporary_folder.h"

namespace plisse {
namespace {

using Existing = RunFolderOptions::Existing;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr double infinity = std::numeric_limits<double>::infinity();

Positions random_positions(int count, std::uint64_t seed) {
    Random random(seed);
    Positions x(3, count);
    for (Eigen::Index i = 0; i < x.size(); ++i)
        x.data()[i] = random.uniform(-1, 1) / 3;
    return x;
}

RunReport sample_report() {
    RunReport report;
    report.name = "n";
    report.method = "progressive";
    report.wall_seconds = 1.0 / 3;
    LevelReport level;
    level.vertices = 4;
    level.min_gap = infinity;
    level.max_stretch = 1.1;
    level.to_final = {1e-3 / 3, infinity};
    level.too_coarse = {1.0 / 7, 2.5, 0.75, 1e-2 / 3, Vec3(0, 1.0 / 3, -2)};
    level.estimated_turn = 0.1 / 3;
    level.energy = {0.1, 0.3, 0.2, 0, -1e-17, 0.7};
    level.reactions = {{"left", Vec3(0, 0.1 / 7, 0), Vec3::Ones()}};
    level.work.resize(2);
    level.work[0].quadratic_solves = 8;
    level.work[1].assemblies = 3;
    level.work[1].quadratic_products = 10.0 / 3;
    level.seconds[Phase::ccd] = 0.1 + 0.2;
    level.total_seconds = 2.0 / 3;
    report.levels = {level};
    RefinementReport refinement;
    refinement.to = 1;
    refinement.min_gap = 1e-4 / 3;
    report.refinements = {refinement};
    report.reactions = {{"left", Vec3(0, 1.0 / 7, 0), Vec3::Ones()}, {"ball", Vec3::Zero(), Vec3::Zero()}};
    report.lagging = {{"left", 3, 0.1, {{0, 1}, {7, 7}}}};
    return report;
}

Checkpoint sample_checkpoint(std::uint64_t seed) {
    Checkpoint c;
    c.level = 1;
    c.step = static_cast<int>(seed);
    c.settle_step = 3;
    c.settle_time_step = 0.1 / 3;
    c.settle_tolerance = 1e-3 / 7;
    c.stiffness_factor = 30.0 / 7;
    c.stiffening_helps = seed % 2 == 0;
    c.settled = true;
    c.t = 0.7;
    c.positions = random_positions(50, seed);
    c.velocity = random_positions(50, seed + 1);
    c.previews = {random_positions(7, seed + 2), random_positions(20, seed + 3)};
    c.frame_numbers = {3, 1};
    c.report = sample_report();
    return c;
}

void expect_same(const Checkpoint& a, const Checkpoint& b) {
    EXPECT_EQ(a.level, b.level);
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.settle_step, b.settle_step);
    EXPECT_EQ(a.settle_time_step, b.settle_time_step);
    EXPECT_EQ(a.settle_tolerance, b.settle_tolerance);
    EXPECT_EQ(a.stiffness_factor, b.stiffness_factor);
    EXPECT_EQ(a.stiffening_helps, b.stiffening_helps);
    EXPECT_EQ(a.settled, b.settled);
    EXPECT_EQ(a.t, b.t);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.previews, b.previews);
    EXPECT_EQ(a.frame_numbers, b.frame_numbers);
    EXPECT_EQ(report_to_json(a.report, {}), report_to_json(b.report, {}));
}

TEST(ReportJson, HasTheContractsKeysAndReadsBackToTheBit) {
    const RunReport report = sample_report();
    const Json json = Json::parse(report_to_json(report, {"0.1.0", 2, 1234}).dump());
    for (const char* key : {"plisse", "name", "method", "status", "wall_seconds", "peak_memory_bytes", "threads",
                            "intersecting_pairs", "levels", "refinements", "reactions", "lagging"})
        EXPECT_TRUE(json.contains(key)) << key;
    for (const char* key : {"level", "vertices", "faces", "steps", "newton_iterations", "equilibrium", "min_gap",
                            "max_stretch", "residual", "to_final", "too_coarse", "energy", "reactions", "seconds"})
        EXPECT_TRUE(json["levels"][0].contains(key)) << key;
    for (const char* key :
         {"total", "elastic", "contact", "linear_solve", "line_search", "broad_phase", "ccd", "other"})
        EXPECT_TRUE(json["levels"][0]["seconds"].contains(key)) << key;
    for (const char* key :
         {"from", "to", "expansions", "colors", "first_try", "sampled", "relaxed", "deferred", "min_gap", "seconds"})
        EXPECT_TRUE(json["refinements"][0].contains(key)) << key;
    EXPECT_EQ(json["status"], "running");
    EXPECT_TRUE(json["levels"][0]["min_gap"].is_null()) << "infinity";
    EXPECT_EQ(json["reactions"]["left"]["force"][1], 1.0 / 7);

    EXPECT_EQ(json["levels"][0]["work"]["assembly_units"], 3);
    EXPECT_EQ(json["levels"][0]["work"]["quadratic_units"], 2);
    EXPECT_EQ(json["levels"][0]["work"]["levels"].size(), 2u);

    const RunReport back = report_from_json(json);
    EXPECT_EQ(report_to_json(back, {}), report_to_json(report, {}));
    EXPECT_EQ(back.levels[0].min_gap, infinity);
    EXPECT_EQ(back.levels[0].seconds[Phase::ccd], 0.1 + 0.2);
    EXPECT_EQ(back.wall_seconds, 1.0 / 3);
}

TEST(CheckpointFolder, ReturnsExactlyWhatWasSaved) {
    const TemporaryFolder folder;
    EXPECT_FALSE(CheckpointFolder(folder.path()).load().has_value());
    CheckpointFolder writer(folder.path());
    for (std::uint64_t k = 1; k <= 3; ++k) {
        writer.save({sample_checkpoint(k), 10 * k, 20 * k});
        const auto loaded = CheckpointFolder(folder.path()).load();
        ASSERT_TRUE(loaded.has_value());
        expect_same(loaded->checkpoint, sample_checkpoint(k));
        EXPECT_EQ(loaded->log_bytes, 10 * k);
        EXPECT_EQ(loaded->index_bytes, 20 * k);
    }
    Checkpoint still = sample_checkpoint(9);
    still.velocity.resize(3, 0);
    writer.save({still, 0, 0});
    EXPECT_EQ(CheckpointFolder(folder.path()).load()->checkpoint.velocity.cols(), 0);
}

TEST(CheckpointFolder, SurvivesAKillAtAnyMomentOfTheNextSave) {
    // What the folder holds when the writer dies while it writes the second checkpoint: the other state file cut off at
    // any length or whole, and the new manifest not yet in place.
    const TemporaryFolder folder;
    CheckpointFolder(folder.path()).save({sample_checkpoint(1), 1, 2});
    const std::string state = read_text(folder.path() / "state-0.bin");
    const std::string manifest = read_text(folder.path() / "manifest.json");
    ASSERT_FALSE(state.empty());
    for (std::size_t size : {std::size_t{0}, std::size_t{1}, state.size() / 2, state.size()}) {
        write_text(folder.path() / "state-1.bin", state.substr(0, size));
        write_text(folder.path() / "state-1.bin.tmp", state.substr(0, size));
        write_text(folder.path() / "manifest.json.tmp", manifest.substr(0, manifest.size() / 3));
        CheckpointFolder reopened(folder.path());
        const auto loaded = reopened.load();
        ASSERT_TRUE(loaded.has_value());
        expect_same(loaded->checkpoint, sample_checkpoint(1));
    }
    CheckpointFolder reopened(folder.path());
    reopened.load();
    reopened.save({sample_checkpoint(2), 3, 4});
    EXPECT_EQ(read_text(folder.path() / "state-0.bin"), state) << "the state in use is never written over";
    expect_same(CheckpointFolder(folder.path()).load()->checkpoint, sample_checkpoint(2));
}

std::string message_of_loading(const TemporaryFolder& folder) {
    try {
        CheckpointFolder(folder.path()).load();
    } catch (const InputError& error) {
        return error.what();
    }
    return "it was loaded";
}

TEST(CheckpointFolder, SaysWhenTheStateIsDamaged) {
    const TemporaryFolder folder;
    CheckpointFolder(folder.path()).save({sample_checkpoint(1), 1, 2});
    std::string state = read_text(folder.path() / "state-0.bin");
    state[100] = static_cast<char>(state[100] ^ 1);
    write_text(folder.path() / "state-0.bin", state);
    EXPECT_EQ(message_of_loading(folder), (folder.path() / "manifest.json").string() +
                                              ": the checkpoint is damaged; "
                                              "begin again with --overwrite instead of --resume");
}

TEST(CheckpointFolder, TellsAnotherVersionFromDamage) {
    const TemporaryFolder folder;
    CheckpointFolder(folder.path()).save({sample_checkpoint(1), 1, 2});
    Json manifest = Json::parse(read_text(folder.path() / "manifest.json"));
    manifest["format"] = manifest["format"].get<int>() - 1;
    write_text(folder.path() / "manifest.json", manifest.dump());
    EXPECT_EQ(message_of_loading(folder), (folder.path() / "manifest.json").string() +
                                              ": the checkpoint is of another version of plisse; "
                                              "begin again with --overwrite instead of --resume");
}

class RunFolderTest : public testing::Test {
protected:
    RunFolderTest() {
        fs::create_directory(input_.path() / "a");
        fs::create_directory(input_.path() / "b");
        write_text(input_.path() / "a/m.obj",
                   "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0.5 0.25\nf 1/1 3/1 2/1\nf 1/1 4/1 3/1\n");
        write_text(input_.path() / "b/m.obj", "v 0 1 0\nv 1 1 0\nv 0 1 1\nf 1 3 2\n");
        scene_ = parse_scene("scene.json", R"({"plisse": 1, "bodies": [{"name": "a", "mesh": "a/m.obj"}],
                                               "obstacles": [{"name": "b", "mesh": "b/m.obj"}]})",
                             input_.path());
        Context context;
        model_ = build_model(scene_, context);
        HierarchyLevel level;
        level.rest = model_.mesh.positions;
        level.faces = model_.mesh.faces;
        level.part = model_.vertex_parts();
        hierarchy_.levels = {level};
    }

    RunFolder open(Existing existing, bool frames = true) {
        RunFolder folder(output(), scene_, model_.mesh.attributes, {existing, frames, "0.1.0", 2});
        folder.on_hierarchy(hierarchy_);
        return folder;
    }
    fs::path output() const { return input_.path() / "run"; }

    void save_frame(RunFolder& folder, int number) {
        const Positions x = model_.mesh.positions * (1.0 + number / 3.0);
        folder.on_frame({0, number, 0.1 * number, "preview", &x});
        folder.on_iteration({0, number, 1, 0.1 * number, 1.0, 0.5, infinity, 0.01, 1.0, {}});
    }
    static std::size_t line_count(const fs::path& path) {
        const std::string text = read_text(path);
        return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    }

    TemporaryFolder input_;
    Scene scene_;
    Model model_;
    Hierarchy hierarchy_;
};

TEST_F(RunFolderTest, HoldsASceneThatRunsElsewhere) {
    open(Existing::refuse);
    const Scene again = read_scene(output() / "scene.json");
    EXPECT_EQ(again.bodies[0].mesh.file, "meshes/m.obj");
    EXPECT_EQ(again.obstacles[0].mesh.file, "meshes/m-2.obj") << "two files of one name";
    Context context;
    const Model model = build_model(again, context);
    EXPECT_EQ(model.mesh.positions, model_.mesh.positions);
    EXPECT_EQ(model.mesh.faces, model_.mesh.faces);
    EXPECT_EQ(model.bodies[0].material.density, model_.bodies[0].material.density);
    EXPECT_EQ(Json::parse(read_text(output() / "scene.json"))["x-mesh-hashes"].size(), 2u);
}

TEST_F(RunFolderTest, WritesFramesAndTheFinalStateInTheModelsOrder) {
    RunFolder folder = open(Existing::refuse);
    save_frame(folder, 0);
    const Positions last = random_positions(model_.mesh.vertex_count(), 5);
    folder.write_final(0, last);
    folder.on_report(sample_report());
    const TriangleMesh final_mesh = read_mesh(output() / "final.ply").mesh;
    EXPECT_EQ(final_mesh.positions, last);
    EXPECT_EQ(final_mesh.faces, model_.mesh.faces);
    const auto has_body = [](const MeshAttribute& attribute) {
        return attribute.name == "body" && attribute.values == std::vector<double>{0, 0, 1};
    };
    EXPECT_EQ(std::count_if(final_mesh.attributes.begin(), final_mesh.attributes.end(), has_body), 1);
    const auto has_coarseness = [&](const MeshAttribute& attribute) {
        const VecX values = coarseness(model_.mesh.positions, last, model_.mesh.faces);
        return attribute.name == "coarseness" && attribute.values == std::vector<double>(values.begin(), values.end());
    };
    EXPECT_EQ(std::count_if(final_mesh.attributes.begin(), final_mesh.attributes.end(), has_coarseness), 1);
    EXPECT_EQ(final_mesh.attributes.size(), model_.mesh.attributes.size() + 2);
    EXPECT_TRUE(fs::exists(output() / "frames/0/000000.ply"));
    const Json line = Json::parse(read_text(output() / "frames/index.jsonl"));
    EXPECT_EQ(line["file"], "frames/0/000000.ply");
    EXPECT_EQ(line["phase"], "preview");
    const Json report = Json::parse(read_text(output() / "report.json"));
    EXPECT_EQ(report["threads"], 2);
    EXPECT_GT(report["peak_memory_bytes"].get<double>(), 1e6);
}

TEST_F(RunFolderTest, SavesNoFramesWhenNoneAreWanted) {
    RunFolder folder = open(Existing::refuse, false);
    save_frame(folder, 0);
    folder.on_report(sample_report());
    EXPECT_FALSE(fs::exists(output() / "frames/0/000000.ply"));
    EXPECT_EQ(read_text(output() / "frames/index.jsonl"), "");
}

TEST_F(RunFolderTest, RefusesAFolderThatExistsUnlessTold) {
    { open(Existing::refuse); }
    write_text(output() / "mine.txt", "keep");
    EXPECT_THROW(open(Existing::refuse), InputError);
    {
        RunFolder folder = open(Existing::overwrite);
        save_frame(folder, 0);
    }
    { open(Existing::overwrite); }
    EXPECT_FALSE(fs::exists(output() / "frames/0/000000.ply"));
    EXPECT_TRUE(fs::exists(output() / "mine.txt")) << "only what plisse writes is removed";
    scene_ = read_scene(output() / "scene.json");
    EXPECT_NO_THROW(open(Existing::overwrite)) << "a run may be written over by its own scene";
    EXPECT_TRUE(fs::exists(output() / "meshes/m-2.obj"));
}

TEST_F(RunFolderTest, LogsWhatCutsStepsShort) {
    {
        RunFolder folder = open(Existing::refuse);
        save_frame(folder, 0);
        folder.on_iteration({0, 1, 2, 0.1, 1.0, 0.5, 1e-9, 0.02, 1e-3, {"contact", "a and b"}});
    }
    const std::string log = read_text(output() / "log.jsonl");
    const std::size_t second = log.find('\n') + 1;
    EXPECT_FALSE(Json::parse(log.substr(0, second)).contains("cut_by"));
    EXPECT_EQ(Json::parse(log.substr(second))["cut_by"], Json({{"cause", "contact"}, {"detail", "a and b"}}));
}

TEST_F(RunFolderTest, LogsHowStiffTheBarrierBecomes) {
    {
        RunFolder folder = open(Existing::refuse);
        folder.on_stiffening({1, 3, 0.5, 1e-4, 300, 0.1, "a and b"});
        folder.on_report(sample_report());
    }
    const Json line = Json::parse(read_text(output() / "log.jsonl"));
    EXPECT_EQ(line, Json({{"level", 1},
                          {"step", 3},
                          {"t", 0.5},
                          {"stiffness_factor", 300.0},
                          {"gap_share", 1e-4},
                          {"pair", "a and b"},
                          {"seconds", 0.1}}));
}

TEST_F(RunFolderTest, ResumesFromTheCheckpointAndForgetsWhatCameAfter) {
    {
        RunFolder folder = open(Existing::refuse);
        save_frame(folder, 0);
        folder.on_checkpoint(sample_checkpoint(1));
        save_frame(folder, 1);
        folder.on_report(sample_report());
    }
    EXPECT_EQ(line_count(output() / "log.jsonl"), 2u);
    RunFolder folder = open(Existing::resume);
    ASSERT_TRUE(folder.checkpoint().has_value());
    expect_same(*folder.checkpoint(), sample_checkpoint(1));
    EXPECT_EQ(line_count(output() / "log.jsonl"), 1u);
    EXPECT_EQ(line_count(output() / "frames/index.jsonl"), 1u);
    EXPECT_TRUE(fs::exists(output() / "frames/0/000000.ply"));
    EXPECT_FALSE(fs::exists(output() / "frames/0/000001.ply"));
    save_frame(folder, 1);
    folder.on_report(sample_report());
    EXPECT_EQ(line_count(output() / "frames/index.jsonl"), 2u);
}

TEST_F(RunFolderTest, ResumesOnlyTheSameRun) {
    {
        RunFolder folder = open(Existing::refuse);
        folder.on_checkpoint(sample_checkpoint(1));
    }
    EXPECT_TRUE(open(Existing::resume).checkpoint().has_value());
    scene_.solve.time_step = 0.2;
    EXPECT_THROW(open(Existing::resume), InputError);
    scene_.solve.time_step = SolveSettings{}.time_step;
    write_text(input_.path() / "b/m.obj", "v 0 1 0\nv 1 1 0\nv 0 1 1.5\nf 1 3 2\n");
    EXPECT_THROW(open(Existing::resume), InputError) << "another mesh";
}

TEST_F(RunFolderTest, BeginsAnewWhenThereIsNothingToResume) {
    EXPECT_FALSE(open(Existing::resume).checkpoint().has_value());
    EXPECT_FALSE(open(Existing::resume).checkpoint().has_value()) << "killed before its first checkpoint";
}

TEST_F(RunFolderTest, LeavesNothingBehindWhenDiscarded) {
    open(Existing::refuse).discard();
    EXPECT_FALSE(fs::exists(output()));
}

TEST_F(RunFolderTest, RecordsAFailure) {
    RunFolder folder = open(Existing::refuse);
    folder.on_report(sample_report());
    folder.record_failure("the disk is full");
    const Json report = Json::parse(read_text(output() / "report.json"));
    EXPECT_EQ(report["status"], "failed");
    EXPECT_EQ(report["message"], "the disk is full");
    EXPECT_EQ(report["levels"].size(), 1u);
}

} // namespace
} // namespace plisse
