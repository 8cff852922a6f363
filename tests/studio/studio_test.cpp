#include <studio/studio.h>

#include <cstring>
#include <map>

#include <gtest/gtest.h>

#include <plisse/drive/run.h>
#include <plisse/scene/build_model.h>
#include <plisse/scene/read_scene.h>

#include "running_server.h"
#include "running_studio.h"

namespace plisse::studio {
namespace {

using nlohmann::json;

std::vector<float> as_floats(const Positions& x) {
    return {x.data(), x.data() + x.size()};
}

/// The positions that a run saves of its timeline's steps on level 0, by their time.
struct PreviewSteps : Recorder {
    std::map<double, std::vector<float>> by_time;
    void on_frame(const Frame& frame) override {
        if (frame.phase == "preview")
            by_time[frame.t] = as_floats(*frame.positions);
    }
};

struct ShownState {
    std::uint32_t level = 0, step = 0;
    double t = 0;
    std::vector<float> positions;
};

ShownState decoded(const std::string& message) {
    struct {
        std::uint32_t kind, level, version, count;
        double t;
        std::uint32_t flags, step;
    } header;
    std::memcpy(&header, message.data(), sizeof header);
    ShownState state{header.level, header.step, header.t, std::vector<float>(std::size_t{3} * header.count)};
    std::memcpy(state.positions.data(), message.data() + sizeof header, state.positions.size() * sizeof(float));
    return state;
}

TEST(Studio, ShowsTheStepsThatARunOfTheSceneTakes) {
    Context context;
    PreviewSteps steps;
    const RunResult result =
        run(build_model(parse_scene("small.json", small_scene_text, "."), context), {}, steps, context);
    ASSERT_EQ(result.report.status, RunStatus::converged);
    ASSERT_EQ(steps.by_time.size(), 7U);

    RunningStudio running;
    WatchingPage page(running);
    ASSERT_TRUE(page.comes_to("idle"));
    page.send({{"type", "play"}});
    ASSERT_TRUE(page.comes_to("at_rest"));
    page.send({{"type", "refine"}, {"to", "finest"}});
    ASSERT_TRUE(page.comes_to("at_rest"));
    std::size_t compared = 0;
    for (const std::string& message : page.states) {
        const ShownState state = decoded(message);
        if (state.level > 0 || state.step >= steps.by_time.size())
            continue;
        EXPECT_EQ(state.positions, steps.by_time.at(state.t)) << "step " << state.step;
        ++compared;
    }
    EXPECT_GE(compared, 3U); // a page that is slow may have been spared some
    EXPECT_EQ(decoded(page.states.back()).positions, as_floats(result.positions));
}

TEST(Studio, GoesOnWhereAKilledOneStopped) {
    TemporaryFolder folder;
    const std::filesystem::path session = folder.path() / "session";
    json before;
    {
        RunningStudio running(small_scene_text, &session);
        WatchingPage page(running);
        ASSERT_TRUE(page.comes_to("idle"));
        page.send({{"type", "frame"}, {"index", 99}});
        ASSERT_FALSE(page.next("error").is_null()) << "there is no such frame";
        EXPECT_FALSE(std::filesystem::exists(session / "last-session.json")) << "nothing has been done yet";
        page.send({{"type", "step"}});
        page.send({{"type", "set"}, {"edits", {{{"set", "/gravity"}, {"value", {0, -3, 1}}}}}});
        page.send({{"type", "step"}});
        page.send({{"type", "step"}});
        page.send({{"type", "save"}, {"name", "mine"}});
        ASSERT_FALSE(page.next("saved").is_null());
        ASSERT_TRUE(eventually([&] { // before it ends, as if it were killed
            return read_text(session / "last-session.edits.json") == read_text(session / "mine.edits.json");
        }));
        before = page.status;
        ASSERT_EQ(before.at("step"), 3);
    }
    RunningStudio running(nullptr, &session);
    WatchingPage page(running);
    page.send({{"type", "open"}, {"file", "last-session.json"}});
    ASSERT_TRUE(page.comes_to("idle"));
    EXPECT_EQ(page.status.at("step"), 3);
    EXPECT_EQ(page.status.at("t"), before.at("t"));
    page.send({{"type", "export"}, {"format", "ply"}, {"what", "state"}});
    const std::string kept = page.next("saved").at("files").at(0);
    const std::string last_bytes = read_text(session / kept);
    page.send({{"type", "open"}, {"file", "mine.json"}});
    ASSERT_TRUE(page.comes_to("building"));
    ASSERT_TRUE(page.comes_to("idle"));
    page.send({{"type", "export"}, {"format", "ply"}, {"what", "state"}});
    const std::string mine = page.next("saved").at("files").at(0);
    EXPECT_FALSE(last_bytes.empty());
    EXPECT_EQ(last_bytes, read_text(session / mine));
    page.send({{"type", "save"}, {"name", "last-session"}});
    EXPECT_FALSE(page.next("error").is_null()) << "it would be written over";
}

TEST(Studio, OpensNoSceneThatNamesFilesOutsideOfItsFolder) {
    RunningStudio running(nullptr);
    WatchingPage page(running);
    std::filesystem::create_directories(running.folder);
    write_text(running.folder / "other.json", R"({"plisse": 1, "bodies": [{"mesh": "../other.obj"}]})");
    page.send({{"type", "open"}, {"file", "other.json"}});
    EXPECT_NE(page.next("error").at("message").get<std::string>().find("outside"), std::string::npos);
    page.send({{"type", "open"}, {"file", "absent.json"}});
    EXPECT_NE(page.next("error").at("message").get<std::string>().find("absent.json"), std::string::npos);
}

TEST(Studio, AMeshOfTheSameNameReplacesNone) {
    RunningStudio running(nullptr);
    const std::string one = "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n", other = "v 0 0 0\nv 2 0 0\nv 0 0 1\nf 1 2 3\n";
    EXPECT_EQ(running.post("/api/mesh?name=a.obj", one).status, 200);
    EXPECT_EQ(running.post("/api/mesh?name=a.obj", other).status, 200);
    EXPECT_EQ(running.post("/api/mesh?name=a.obj", one).status, 200);
    EXPECT_EQ(read_text(running.folder / "meshes/a.obj"), one);
    EXPECT_EQ(read_text(running.folder / "meshes/a-2.obj"), other);
    EXPECT_EQ(running.post("/api/mesh?name=b.obj", "no mesh").status, 422);
    EXPECT_FALSE(std::filesystem::exists(running.folder / "meshes/b.obj"));
}

} // namespace
} // namespace plisse::studio
