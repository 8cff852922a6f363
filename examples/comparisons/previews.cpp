// Which coarse preview foretells the fine result? Runs a scene with every way to make one, and prints a row for each.
//     compare_previews SCENE.json
// A scene's "x-compare" may name the plane of a curve along which folds are counted, and the handle whose force counts.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <unistd.h>

#include <Eigen/LU>
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
    Positions on_input{}; ///< level 0's preview at the body's vertices as the scene gives them

    const LevelReport& level(std::size_t number) const { return result.report.levels.at(number); }
    Positions preview_on_finest(int from) const {
        return prolongation_to_finest(last.hierarchy, from, shown_by)
            .apply(last.states.at(static_cast<std::size_t>(from)));
    }
};

/// The state of a subdivided mesh at places on its level 0.
class SubdividedSurface {
public:
    SubdividedSurface(const Hierarchy& hierarchy, Positions finest) : hierarchy_(hierarchy), x_(std::move(finest)) {
        const HierarchyLevel& fine = hierarchy.finest();
        parts_.resize(hierarchy.levels.front().faces.size());
        for (std::size_t f = 0; f < fine.faces.size(); ++f)
            parts_[static_cast<std::size_t>(fine.face_ids[f])].push_back(static_cast<int>(f));
    }

    Vec3 at(const Anchor& place) const {
        for (const int f : parts_[static_cast<std::size_t>(place.face)]) {
            const Face& part = hierarchy_.finest().faces[static_cast<std::size_t>(f)];
            Mat3 corners;
            for (int k = 0; k < 3; ++k)
                corners.col(k) = weights_in(place.face, part[static_cast<std::size_t>(k)]);
            const Vec3 within = corners.partialPivLu().solve(place.weights);
            if (within.minCoeff() >= -1e-9)
                return x_(Eigen::all, part) * within;
        }
        throw std::logic_error("a place that no part of its face covers");
    }

private:
    /// Of a finest vertex on the border of a coarse face, or in it: its weights there.
    Vec3 weights_in(int coarse_face, int vertex) const {
        const HierarchyLevel& coarse = hierarchy_.levels.front();
        const Anchor& anchor = coarse.to_finest[static_cast<std::size_t>(vertex)];
        const Face& face = coarse.faces[static_cast<std::size_t>(coarse_face)];
        const Face& known = coarse.faces[static_cast<std::size_t>(anchor.face)];
        Vec3 weights = Vec3::Zero();
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t j = 0; j < 3; ++j)
                if (face[k] == known[j])
                    weights[static_cast<int>(k)] = anchor.weights[static_cast<int>(j)];
        return weights;
    }

    const Hierarchy& hierarchy_;
    Positions x_;
    std::vector<std::vector<int>> parts_; ///< per face of level 0: the finest faces it was divided into
};

/// Previews as the model makes them, refined to the finest result.
Contestant compete(const std::string& label, const Model& model, Context& context) {
    Contestant contestant{label, {}, {}, model.hierarchy.prolongation};
    contestant.result = run(model, {}, contestant.last, context);
    contestant.on_input = contestant.preview_on_finest(0);
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
    contestant.on_input = contestant.preview_on_finest(0);
    return contestant;
}

/// The finest mesh simulated for itself.
Positions simulate_finest(Model model, Context& context) {
    model.solve.method = Method::direct;
    Recorder recorder;
    const RunResult result = run(model, {}, recorder, context);
    if (result.report.status != RunStatus::converged)
        throw std::runtime_error("the finest mesh simulated for itself does not converge: " + result.report.message);
    return result.positions;
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

/// Finest positions of a subdivided hierarchy at the body's finest vertices of the one whose level 0 it divides.
Positions seen_from(const Hierarchy& decimated, const Hierarchy& subdivided, const Positions& finest) {
    const SubdividedSurface surface(subdivided, finest);
    const HierarchyLevel& level = decimated.levels.front();
    std::vector<int> face_of_body(level.faces.size());
    int count = 0;
    for (std::size_t f = 0; f < level.faces.size(); ++f)
        face_of_body[f] = level.part[static_cast<std::size_t>(level.faces[f][0])] == 0 ? count++ : -1;
    Positions seen = decimated.finest().rest;
    for (std::size_t v = 0; v < level.to_finest.size(); ++v) {
        Anchor place = level.to_finest[v];
        if (place.face < 0 || face_of_body[static_cast<std::size_t>(place.face)] < 0)
            continue;
        place.face = face_of_body[static_cast<std::size_t>(place.face)];
        seen.col(static_cast<Eigen::Index>(v)) = surface.at(place);
    }
    return seen;
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
    Contestant contestant = compete("loop", model, context);
    contestant.on_input = seen_from(hierarchy, contestant.last.hierarchy, contestant.on_input);
    return contestant;
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
    /// truth: the finest mesh simulated for itself.
    Table(const Model& model, Interest interest, Positions truth)
        : interest_(std::move(interest)), body_vertices_(model.bodies.front().vertices.size()),
          diagonal_(bounding_box(model.mesh.positions).diagonal()), truth_(std::move(truth)) {}

    void print_head() const {
        fmt::print("| preview | off, mean, % of the diagonal, level by level | off, largest, % | level 0 off the "
                   "finest mesh simulated for itself, mean, % | {}{}iterations, level "
                   "by level | s, all | ends |\n| --- | --- | --- | --- |{}{} --- | --- | --- |\n",
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
        fmt::print("| {} | {} | {} | {} | {}{}{} | {:.0f} | {}, {} pairs |\n", contestant.label, mean, largest,
                   percent(off_truth(contestant)), interest_.curve ? folds + " | " : "",
                   interest_.force_on.empty() ? "" : forces + " | ", iterations, contestant.result.report.wall_seconds,
                   run_status_name(contestant.result.report.status), contestant.result.report.intersecting_pairs);
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

    /// In place, m.
    double off_truth(const Contestant& contestant) const {
        const auto away = contestant.on_input.leftCols(body_vertices_) - truth_.leftCols(body_vertices_);
        return away.colwise().norm().mean();
    }

    Interest interest_;
    int body_vertices_;
    double diagonal_; ///< m
    Positions truth_;
};

void compare(const std::string& file) {
    Context context;
    const Scene scene = read_scene(file);
    const Model model = build_model(scene, context);
    const Table table(model, read_interest(file), simulate_finest(model, context));
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
