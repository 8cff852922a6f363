#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "cli_fixture.h"

namespace plisse {
namespace {

const std::string square_obj = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 3 2\nf 1 4 3\n";

/// A sheet held along one edge, small enough to end within a second.
std::string hung_sheet(const std::string& solve) {
    return R"({"plisse": 1, "name": "hung", "bodies": [{"name": "sheet", "mesh": {"generate": "sheet", "size": [0.2, 0.2],
        "cells": [8, 8], "pattern": "regular"}}], "handles": [{"name": "edge", "body": "sheet",
        "select": {"box": [[-0.11, -1, -1], [-0.09, 1, 1]]}}], "hierarchy": {"levels": 2, "coarsest_vertices": 20},
        "solve": {)" +
           solve + "}}";
}
const std::string few_steps = R"("method": "direct", "duration": 0.3, "settle": false)";
const std::string many_steps = R"("method": "direct", "time_step": 0.01, "duration": 2, "settle": false)";

TEST_F(Cli, ArgumentsItCannotUseEndInTwo) {
    expect_unusable({}, "command line: ");
    expect_unusable({"rum"}, "rum");
    expect_unusable({"run", "scene.json"}, "plisse run --help");
    expect_unusable({"run", "scene.json", "-o", "x", "--levle", "1"}, "--levle");
    expect_unusable({"run", "scene.json", "-o", "x", "--threads", "many"}, "--threads");
    expect_unusable({"run", "scene.json", "-o", "x", "--progress", "loud"}, "--progress");
    expect_unusable({"bench", "cam"}, "plisse bench can");
    expect_unusable({"bench", "can", "--levels", "2"}, "rmtr");
    expect_unusable({"bench", "rmtr", "--scenario", "tent"}, "--scenario");
}

TEST_F(Cli, AnIntersectingStartIsRefusedWithItsPlacesAndShown) {
    write("crossing.json", R"({"plisse": 1, "name": "crossing", "bodies": [
        {"name": "sheet", "mesh": {"generate": "sheet", "size": [1, 1], "cells": [2, 2], "pattern": "regular"}},
        {"name": "ball", "mesh": {"generate": "sphere", "radius": 0.1, "edge_length": 0.05},
         "transform": {"translate": [0.3, 0, 0]}}], "hierarchy": {"levels": 1}})");
    expect_unusable({"run", at("crossing.json"), "-o", at("out")}, "face 27 of \"ball\" near (0.");
    expect_unusable({"run", at("crossing.json"), "-o", at("out/")}, at("out_intersections.ply"));
    EXPECT_FALSE(fs::exists(at("out")));
    const Outcome check = run({"check", at("out_intersections.ply"), "--json"});
    EXPECT_GT(Json::parse(check.out)["intersecting_face_pairs"], 0);
}

TEST_F(Cli, BenchRmtrPrintsThePapersTablesBesideOurs) {
    const Outcome outcome =
        run({"bench", "rmtr", "--quick", "--levels", "2", "--scenario", "trampoline", "--time-limit", "2", "--json",
             at("bench.json"), "--plot", at("bench.svg"), "--threads", "1"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* part : {"Table 3", "(29426)", "Table 4", "(633)", "Tables 5 to 7", "Table 8", "Figure 9",
                             "Figure 10", "rmtr is faster"})
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part << outcome.out;
    const Json json = json_of("bench.json");
    EXPECT_GT(json["ratios"]["trampoline_363_memory"], 0.3);
    for (const Json& contestant : json["runs"]) {
        EXPECT_GT(contestant["peak_memory_bytes"], 1e6);
        EXPECT_TRUE(contestant["converged"] || contestant["way"] == "rmtr as published") << contestant;
    }
    EXPECT_NEAR(json["conditions"][1]["condition"].get<double>() / 1e8, 1, 0.3); // RMTR.md: 0.95e8 at 363 unknowns
    for (const Json& step : json["largest_steps"])
        if (step["way"] == "rmtr" || step["way"] == "trust region") {
            EXPECT_EQ(step["time_step"], 1);
        }
    EXPECT_EQ(read_text(folder_.path() / "bench.svg").rfind("<svg", 0), 0u);
}

TEST_F(Cli, HelpAndVersionEndInZero) {
    EXPECT_EQ(run({"--version"}).code, 0);
    EXPECT_NE(run({"--help"}).out.find("hierarchy"), std::string::npos);
    for (const char* command :
         {"run", "check", "hierarchy", "prolong", "render", "report", "schema", "bench", "studio", "export"}) {
        const Outcome outcome = run({command, "--help"});
        EXPECT_EQ(outcome.code, 0) << command;
        EXPECT_NE(outcome.out.find("Usage"), std::string::npos) << command;
    }
}

TEST_F(Cli, SchemaIsJson) {
    const Outcome outcome = run({"schema"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(Json::parse(outcome.out)["$schema"], "https://json-schema.org/draft/2020-12/schema");
}

TEST_F(Cli, CheckTellsUsableUnusableAndUnreadableApart) {
    write("square.obj", square_obj);
    write("crossing.obj", "v 0.5 -1 0.2\nv 0.5 1 0.2\nv 0.5 0 0.9\nf 1 2 3\n");
    write("pinched.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n");
    EXPECT_EQ(run({"check", at("square.obj")}).code, 0);
    EXPECT_EQ(run({"check", at("pinched.obj")}).code, 1);
    EXPECT_EQ(run({"check", at("square.obj"), at("crossing.obj")}).code, 1);
    expect_unusable({"check", at("nowhere.obj")}, "nowhere.obj");

    const Json json = Json::parse(run({"check", "--json", at("square.obj"), at("crossing.obj")}).out);
    EXPECT_FALSE(json["usable"].get<bool>());
    EXPECT_EQ(json["faces"], 3);
    EXPECT_EQ(json["boundary_loops"], 2);
    EXPECT_EQ(json["intersecting_face_pairs"], json["between"].size());
    EXPECT_GE(json["between"].size(), 1u);
    EXPECT_TRUE(json["meshes"][0]["usable"].get<bool>());
    const Json pinched = Json::parse(run({"check", "--json", at("pinched.obj")}).out);
    EXPECT_EQ(pinched["non_manifold_vertices"], 1);
    EXPECT_EQ(pinched["meshes"][0]["places"]["non_manifold_vertices"], Json::array({0}));
}

TEST_F(Cli, ARefusedSceneLeavesNothingBehind) {
    expect_unusable({"run", at("nowhere.json"), "-o", at("out")}, "nowhere.json");
    write("bad.json", "{\"plisse\": 1,\n \"bodys\": []}");
    expect_unusable({"run", at("bad.json"), "-o", at("out")}, "bad.json:2:11: at /bodys: unknown key");
    write("good.json", hung_sheet(few_steps));
    expect_unusable({"run", at("good.json"), "-o", at("out"), "--level", "9"}, "--level 9");
    expect_unusable({"run", at("good.json"), "-o", at("out"), "--method", "rmtr"}, "takes a mesh of quads");
    EXPECT_FALSE(fs::exists(at("out")));
}

TEST_F(Cli, RunWritesWhatTheContractLists) {
    write("scene.json", hung_sheet(few_steps));
    const Outcome outcome = run({"run", at("scene.json"), "-o", at("out"), "--threads", "1"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("converged"), std::string::npos) << outcome.out;
    for (const char* file :
         {"scene.json", "frames/index.jsonl", "final.ply", "report.json", "checkpoint/manifest.json", "log.jsonl"})
        EXPECT_TRUE(fs::exists(folder_.path() / "out" / file)) << file;
    const Json report = json_of("out/report.json");
    EXPECT_EQ(report["status"], "converged");
    EXPECT_EQ(report["name"], "hung");
    EXPECT_EQ(report["intersecting_pairs"], 0);
    EXPECT_EQ(report["threads"], 1);
    EXPECT_EQ(report["plisse"].get<std::string>() + "\n", run({"--version"}).out);

    expect_unusable({"run", at("scene.json"), "-o", at("out")}, "exists already");
    EXPECT_EQ(run({"run", at("scene.json"), "-o", at("out"), "--overwrite", "--quiet"}).err, "");
    const Outcome json = run({"run", at("scene.json"), "-o", at("json"), "--progress", "json", "--no-frames"});
    std::istringstream lines(json.out);
    for (std::string line; std::getline(lines, line);)
        EXPECT_TRUE(Json::parse(line, nullptr, false).is_object()) << line;
}

TEST_F(Cli, ReportsRunsAloneAndSideBySide) {
    write("scene.json", hung_sheet(few_steps));
    ASSERT_EQ(run({"run", at("scene.json"), "-o", at("a"), "--quiet"}).code, 0);
    ASSERT_EQ(run({"run", at("scene.json"), "-o", at("b"), "--quiet", "--level", "0"}).code, 0);
    EXPECT_NE(run({"report", at("a")}).out.find("linear_solve"), std::string::npos);
    EXPECT_NE(run({"report", at("a"), "--compare", at("b")}).out.find("b / a"), std::string::npos);
    EXPECT_EQ(run({"report", at("a"), "--html", at("page.html")}).code, 0);
    EXPECT_NE(read_text(at("page.html")).find("<svg"), std::string::npos);
    expect_unusable({"report", at("nothing")}, "nothing");
}

TEST_F(Cli, SaysWhereALevelIsTooCoarseAndShowsIt) {
    write("scene.json", hung_sheet(few_steps));
    ASSERT_EQ(run({"run", at("scene.json"), "-o", at("out"), "--quiet", "--method", "progressive"}).code, 0);
    const std::string table = run({"report", at("out")}).out;
    for (const std::string level : {"level 0: ", "level 1: "})
        EXPECT_TRUE(std::regex_search(
            table, std::regex(level + "([0-9.e+-]+ % of the area too coarse, worst near|fine enough)")))
            << table;
    const Json found = json_of("out/report.json")["levels"][0]["too_coarse"];
    EXPECT_GT(found["worst"], 0);
    EXPECT_EQ(found["place"].size(), 3U);
    for (const std::vector<std::string>& what :
         {std::vector<std::string>{at("out"), "--sheet"}, {at("out"), "--level", "0"}, {at("out/final.ply")}}) {
        std::vector<std::string> arguments{"render", "-o", at("picture.png"), "--color", "coarseness"};
        arguments.insert(arguments.end(), what.begin(), what.end());
        EXPECT_EQ(run(arguments).code, 0) << what.back();
    }
    write("square.obj", square_obj);
    expect_unusable({"render", at("square.obj"), "-o", at("x.png"), "--color", "coarseness"}, "square.obj");
}

TEST_F(Cli, HierarchyEstimatesHowCoarseIsSound) {
    write("scene.json", hung_sheet(few_steps));
    const Outcome outcome = run({"hierarchy", at("scene.json")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("sheet: folds under its weight"), std::string::npos) << outcome.out;
    ASSERT_EQ(run({"hierarchy", at("scene.json"), "-o", at("h"), "--levels", "3", "--coarsest", "12"}).code, 0);
    const Json json = json_of("h/hierarchy.json");
    ASSERT_EQ(json["levels"].size(), 3U);
    EXPECT_GT(json["levels"][0]["edge"]["median"], json["levels"][1]["edge"]["median"]);
    EXPECT_GT(json["levels"][0]["estimate"]["turn"], json["levels"][2]["estimate"]["turn"]);
    EXPECT_EQ(json["levels"][0]["estimate"]["verdict"], "too coarse");
    EXPECT_EQ(json["estimate"]["bodies"][0]["folds"][0]["cause"], "folds under its weight");
    EXPECT_GT(json["estimate"]["recommended_coarsest_vertices"], 0);
    EXPECT_TRUE(fs::exists(at("h/level-2.ply")));

    write("square.obj", square_obj);
    const Outcome mesh = run({"hierarchy", at("square.obj"), "-o", at("m"), "--levels", "1"});
    EXPECT_EQ(mesh.code, 0) << mesh.err;
    EXPECT_NE(mesh.out.find("sound"), std::string::npos) << mesh.out;
    expect_unusable({"hierarchy", at("square.obj")}, "-o");
}

class Resume : public Cli {
protected:
    /// Begins a run, ends it by a signal once it has saved a checkpoint, and returns what it ended with.
    Outcome begin_and_end_by(int signal, const std::string& out) {
        Program program(folder_.path(), {"run", at("scene.json"), "-o", at(out), "--threads", "1"});
        const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (!fs::exists(at(out + "/checkpoint/manifest.json")) && std::chrono::steady_clock::now() < patience)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        program.send(signal);
        return program.wait();
    }
    void expect_same_end(const std::string& out) {
        const Outcome resumed = run({"run", at("scene.json"), "-o", at(out), "--resume", "--threads", "2"});
        EXPECT_EQ(resumed.code, 0) << resumed.err;
        EXPECT_TRUE(read_text(at(out + "/final.ply")) == read_text(at("whole/final.ply"))) << "final.ply differs";
        EXPECT_EQ(read_text(at(out + "/frames/index.jsonl")), read_text(at("whole/frames/index.jsonl")));
    }
};

TEST_F(Resume, AnInterruptedOrKilledRunEndsInTheSameBytes) {
    write("scene.json", hung_sheet(many_steps));
    ASSERT_EQ(run({"run", at("scene.json"), "-o", at("whole"), "--threads", "1"}).code, 0);

    const Outcome interrupted = begin_and_end_by(SIGINT, "interrupted");
    EXPECT_EQ(interrupted.code, 130);
    EXPECT_NE(interrupted.err.find("--resume"), std::string::npos) << interrupted.err;
    EXPECT_EQ(json_of("interrupted/report.json")["status"], "interrupted");
    expect_same_end("interrupted");

    EXPECT_EQ(begin_and_end_by(SIGKILL, "killed").code, -SIGKILL);
    expect_same_end("killed");
}

/// Points the programs it starts to a cache of their own.
class CliWithCache : public Cli {
protected:
    void SetUp() override { setenv("PLISSE_CACHE", at("cache").c_str(), 1); }
    void TearDown() override { unsetenv("PLISSE_CACHE"); }
};

TEST_F(CliWithCache, RunsEndTheSameWithAHierarchyThatWasKept) {
    write("scene.json", hung_sheet(R"("duration": 0.3, "settle": false)"));
    const auto run_into = [&](const std::string& folder, const std::string& option = "--no-frames") {
        const Outcome outcome = run({"run", at("scene.json"), "-o", at(folder), "--progress", "plain", option});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome;
    };
    run_into("uncached", "--no-cache");
    EXPECT_FALSE(fs::exists(at("cache")));
    run_into("first");
    ASSERT_TRUE(fs::exists(at("cache")));
    const fs::path kept = fs::directory_iterator(at("cache"))->path();
    const auto written = fs::last_write_time(kept);
    EXPECT_EQ(run_into("second").err.find("hierarchy"), std::string::npos);
    write_text(kept, "damaged");
    const Outcome third = run_into("third");
    EXPECT_NE((third.err + third.out).find("the hierarchy is built again"), std::string::npos) << third.err;
    EXPECT_GT(fs::last_write_time(kept), written);
    for (const char* folder : {"first", "second", "third"})
        EXPECT_EQ(read_text(folder_.path() / folder / "final.ply"), read_text(folder_.path() / "uncached/final.ply"));
}

TEST_F(Cli, HierarchyAndProlongGiveTheRestShapeBack) {
    const Outcome made = run({"hierarchy", std::string(PLISSE_SOURCE_DIR) + "/tests/data/malformed/good/square.obj",
                              "-o", at("h"), "--levels", "1", "--verify"});
    EXPECT_EQ(made.code, 0) << made.err;
    write("scene.json", hung_sheet(few_steps));
    ASSERT_EQ(run({"run", at("scene.json"), "-o", at("rest"), "--quiet"}).code, 0);
    const Outcome levels =
        run({"hierarchy", at("rest/final.ply"), "-o", at("levels"), "--levels", "2", "--coarsest", "20", "--verify"});
    EXPECT_EQ(levels.code, 0) << levels.err << levels.out;
    EXPECT_NE(levels.out.find("rest recovery error"), std::string::npos);
    const Json json = json_of("levels/hierarchy.json");
    ASSERT_EQ(json["levels"].size(), 2u);
    EXPECT_LT(json["levels"][0]["vertices"], json["levels"][1]["vertices"]);
    EXPECT_LT(json["verification"][0]["rest_error"].get<double>(), 1e-10);
    EXPECT_EQ(
        run({"prolong", at("levels"), "--from", "0", "--positions", at("levels/level-0.ply"), "-o", at("fine.ply")})
            .code,
        0);
    EXPECT_EQ(run({"check", at("fine.ply")}).code, 0);
    expect_unusable(
        {"prolong", at("levels"), "--from", "5", "--positions", at("levels/level-0.ply"), "-o", at("x.ply")},
        "--from 5");
    expect_unusable(
        {"prolong", at("levels"), "--from", "1", "--positions", at("levels/level-0.ply"), "-o", at("x.ply")},
        "level-0.ply");
    const auto prolong_by = [&](const std::string& kind) {
        return std::vector<std::string>{
            "prolong", at("levels"),      "--from",     "0", "--positions", at("levels/level-0.ply"),
            "-o",      at(kind + ".ply"), "--operator", kind};
    };
    for (const std::string kind : {"shell", "intrinsic", "blend", "affine"}) {
        EXPECT_EQ(run(prolong_by(kind)).code, 0) << kind;
        EXPECT_EQ(run({"check", at(kind + ".ply")}).code, 0) << kind;
    }
    expect_unusable(prolong_by("loop"), "--operator");
    write("levels/hierarchy.bin", "damaged");
    expect_unusable(prolong_by("affine"), "hierarchy.bin");
}

TEST_F(Cli, HierarchyOfASceneMayBeMadeBySubdivision) {
    write("scene.json", R"({"plisse": 1, "bodies": [{"mesh": {"generate": "sheet", "edge_length": 0.3}}],
        "hierarchy": {"levels": 3, "source": "loop"}})");
    const Outcome made = run({"hierarchy", at("scene.json"), "-o", at("levels"), "--verify"});
    EXPECT_EQ(made.code, 0) << made.err << made.out;
    const Json json = json_of("levels/hierarchy.json");
    ASSERT_EQ(json["levels"].size(), 3u);
    EXPECT_EQ(json["levels"][2]["faces"], 16 * json["levels"][0]["faces"].get<int>());
    const std::vector<std::string> prolong{"prolong", at("levels"),   "--from",
                                           "0",       "--positions",  at("levels/level-0.ply"),
                                           "-o",      at("fine.ply"), "--operator"};
    const auto by = [&](const std::string& kind) {
        std::vector<std::string> arguments = prolong;
        arguments.push_back(kind);
        return arguments;
    };
    EXPECT_EQ(run(by("shell")).code, 0);
    expect_unusable(by("affine"), "subdivision");
    expect_unusable({"hierarchy", at("scene.json"), "--coarsest", "20"}, "--coarsest");
}

} // namespace
} // namespace plisse
