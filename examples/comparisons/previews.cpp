// Which coarse preview foretells the fine result? Runs a scene with every way to make one, and prints a row for each.
//     compare_previews SCENE.json
// A scene's "x-compare" may name the plane of a curve along which folds are counted, and the handle whose force counts.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <unistd.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/decimate/level_prolongation.h>
#include <plisse/drive/run.h>
#include <plisse/mesh/write_ply.h>
#include <plisse/scene/build_model.h>
#include <plisse/scene/read_scene.h>
#include <plisse/spatial/box.h>

#include "fold_count.h"

namespace plisse::comparisons {

namespace {

/// What of a scene is compared beside distances.
struct Interest {
    std::optional<Plane> curve;
    std::string force_on;
};

Interest read_interest(const std::string& file) {
    std::ifstream stream(file);
    const auto json = nlohmann::json::parse(stream, nullptr, true, true).value("x-compare", nlohmann::json::object());
    Interest interest;
    interest.force_on = json.value("force_on", "");
    if (json.contains("curve")) {
        const auto vector = [&](const char* key) {
            const auto numbers = json["curve"].at(key).get<std::array<double, 3>>();
            return Vec3(numbers[0], numbers[1], numbers[2]);
        };
        interest.curve = Plane{vector("point"), vector("normal").normalized()};
    }
    return interest;
}

/// Keeps the hierarchy, the last state of every level, and the last checkpoint.
class LastStates : public Recorder {
public:
    void on_hierarchy(const Hierarchy& given) override {
        hierarchy = given;
        states.resize(given.levels.size());
    }
    void on_frame(const Frame& frame) override { states[static_cast<std::size_t>(frame.level)] = *frame.positions; }
    void on_checkpoint(const Checkpoint& given) override { checkpoint = given; }

    Hierarchy hierarchy;
    std::vector<Positions> states;
    Checkpoint checkpoint;
};

/// A way to make previews, and what came of it.
struct Contestant {
    std::string label;
    RunResult result;
    LastStates last;
    ProlongationOperator shown_by = ProlongationOperator::shell;

    const LevelReport& level(std::size_t number) const { return result.report.levels.at(number); }
    Positions preview_on_finest(int from) const {
        return prolongation_to_finest(last.hierarchy, from, shown_by)
            .apply(last.states.at(static_cast<std::size_t>(from)));
    }
};

/// Previews as the model makes them, refined to the finest result.
Contestant compete(const std::string& label, const Model& model, Context& context) {
    Contestant contestant{label, {}, {}, model.hierarchy.prolongation};
    contestant.result = run(model, {}, contestant.last, context);
    return contestant;
}

/// The coarsest mesh simulated for itself, then refined as any other preview.
Contestant compete_directly(Model model, Context& context) {
    const SolveSettings progressive = model.solve;
    model.solve.method = Method::direct;
    model.solve.level = 0;
    Contestant contestant{"direct on level 0", {}, {}};
    run(model, {}, contestant.last, context);
    const Checkpoint preview = contestant.last.checkpoint;
    model.solve = progressive;
    RunOptions options;
    options.resume = &preview;
    contestant.result = run(model, options, contestant.last, context);
    return contestant;
}

TriangleMesh body_on_level_0(const Hierarchy& hierarchy) {
    const HierarchyLevel& level = hierarchy.levels.front();
    std::vector<int> of_body, number(level.part.size(), -1);
    for (std::size_t v = 0; v < level.part.size(); ++v)
        if (level.part[v] == 0) {
            number[v] = static_cast<int>(of_body.size());
            of_body.push_back(static_cast<int>(v));
        }
    TriangleMesh mesh;
    mesh.positions = level.rest(Eigen::all, of_body);
    const auto numbered = [&](int v) { return number[static_cast<std::size_t>(v)]; };
    for (const Face& face : level.faces)
        if (numbered(face[0]) >= 0)
            mesh.faces.push_back({numbered(face[0]), numbered(face[1]), numbered(face[2])});
    return mesh;
}

/// The scene on the mesh that another hierarchy has on level 0, subdivided: equal counts where the levels of the other
/// have four times the vertices of the next coarser.
Contestant compete_by_loop(Scene scene, const Hierarchy& hierarchy, Context& context) {
    if (scene.bodies.size() != 1)
        throw InputError(scene.name, "it has several bodies", "compare a scene of one");
    const TriangleMesh mesh = body_on_level_0(hierarchy);
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / fmt::format("plisse_previews_{}.ply", getpid());
    write_ply(file, mesh);
    BodySpec& body = scene.bodies.front();
    body.mesh.file = file.string();
    body.transform = {}; // the level's mesh is where the body is
    scene.hierarchy.source = HierarchySource::loop;
    scene.hierarchy.prolongation = ProlongationOperator::loop;
    scene.hierarchy.bending_on = BendingOn::finest;
    const Model model = build_model(scene, context);
    std::filesystem::remove(file);
    return compete("loop", model, context);
}

std::vector<Contestant> hold_contest(const Scene& scene, Model model, Context& context) {
    std::vector<Contestant> contestants;
    const auto add = [&](const char* label, ProlongationOperator kind, BendingOn bending) {
        model.hierarchy.prolongation = kind;
        model.hierarchy.bending_on = bending;
        contestants.push_back(compete(label, model, context));
    };
    add("shell", ProlongationOperator::shell, BendingOn::finest);
    add("split", ProlongationOperator::shell, BendingOn::level);
    add("blend", ProlongationOperator::blend, BendingOn::finest);
    model.hierarchy.prolongation = ProlongationOperator::shell;
    contestants.push_back(compete_directly(model, context));
    contestants.push_back(compete_by_loop(scene, contestants.front().last.hierarchy, context));
    return contestants;
}

double force_of(const LevelReport& level, const std::string& name) {
    for (const Reaction& reaction : level.reactions)
        if (reaction.name == name)
            return reaction.force.norm();
    return std::nan("");
}

class Table {
public:
    Table(const Model& model, Interest interest)
        : interest_(std::move(interest)), diagonal_(bounding_box(model.mesh.positions).diagonal()) {}

    void print_head() const {
        fmt::print("| preview | off, mean, % of the diagonal, level by level | off, largest, % | {}{}iterations, level "
                   "by level | s, all | ends |\n| --- | --- | --- |{}{} --- | --- | --- |\n",
                   interest_.curve ? "folds, level by level | " : "",
                   interest_.force_on.empty() ? "" : "force, N, level by level | ", interest_.curve ? " --- |" : "",
                   interest_.force_on.empty() ? "" : " --- |");
    }

    void print(const Contestant& contestant) const {
        const std::vector<LevelReport>& levels = contestant.result.report.levels;
        std::string mean, largest, folds, forces, iterations;
        const auto add = [](std::string& text, const std::string& more) { text += (text.empty() ? "" : " / ") + more; };
        for (std::size_t l = 0; l < levels.size(); ++l) {
            if (l + 1 < levels.size()) {
                add(mean, percent(levels[l].to_final.mean));
                add(largest, percent(levels[l].to_final.largest));
            }
            if (interest_.curve)
                add(folds, std::to_string(folds_of(contestant, static_cast<int>(l))));
            add(forces, fmt::format("{:.3g}", force_of(levels[l], interest_.force_on)));
            add(iterations, std::to_string(levels[l].newton_iterations));
        }
        fmt::print("| {} | {} | {} | {}{}{} | {:.0f} | {}, {} pairs |\n", contestant.label, mean, largest,
                   interest_.curve ? folds + " | " : "", interest_.force_on.empty() ? "" : forces + " | ", iterations,
                   contestant.result.report.wall_seconds, run_status_name(contestant.result.report.status),
                   contestant.result.report.intersecting_pairs);
        std::fflush(stdout);
    }

private:
    std::string percent(double distance) const { return fmt::format("{:.3g}", 100 * distance / diagonal_); }

    int folds_of(const Contestant& contestant, int level) const {
        const HierarchyLevel& finest = contestant.last.hierarchy.finest();
        const bool is_last = level + 1 == contestant.last.hierarchy.level_count();
        return count_folds(finest.rest, finest.faces, *interest_.curve,
                           is_last ? contestant.result.positions : contestant.preview_on_finest(level));
    }

    Interest interest_;
    double diagonal_; ///< m
};

void compare(const std::string& file) {
    Context context;
    const Scene scene = read_scene(file);
    const Model model = build_model(scene, context);
    const Table table(model, read_interest(file));
    table.print_head();
    for (const Contestant& contestant : hold_contest(scene, model, context))
        table.print(contestant);
}

} // namespace

} // namespace plisse::comparisons

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: compare_previews SCENE.json\n");
        return 2;
    }
    try {
        plisse::comparisons::compare(argv[1]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "compare_previews: {}\n", error.what());
        return 2;
    }
    return 0;
}
