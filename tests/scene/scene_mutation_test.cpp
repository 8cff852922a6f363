#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <plisse/base/random.h>
#include <plisse/scene/build_model.h>
#include <plisse/scene/read_scene.h>
#include <plisse/scene/write_scene.h>

namespace plisse {
namespace {

const std::vector<std::string> good_scenes = {
    R"({"plisse": 1, "name": "a", // sheet over a ball
  "bodies": [{"name": "cloth", "mesh": {"generate": "sheet", "size": [1, 1], "edge_length": 0.25, "seed": 3},
    "transform": {"scale": 1, "rotate_deg": [0, 10, 0], "translate": [0, 1, 0]}, "material": "cotton"}],
  "obstacles": [{"name": "ball", "mesh": {"generate": "sphere", "radius": 0.3, "edge_length": 0.15},
    "motion": [{"t": 0}, {"t": 2, "translate": [0, 0.3, 0]}]}],
  "handles": [{"name": "h", "body": "cloth", "axes": "xy", "select": {"box": [[-1, 0, -1], [-0.2, 2, 1]]},
    "motion": [{"t": 0}, {"t": 1, "rotate_deg": [90, 0, 0], "about": [0, 1, 0]}]}],
  "contact": {"distance": 1e-3, "pairs": [{"a": "cloth", "b": "ball", "friction": 0}]},
  "hierarchy": {"levels": 2, "coarsest_vertices": 10}, "solve": {"time_step": 0.1, "duration": 1}})",
    R"({"plisse": 1, "bodies": [{"mesh": "square.obj", "material": {"density": 500, "thickness": 1e-3},
    "pressure": [[0, 0], [1, 10]], "rest": "flat-angles", "start": "square.obj"}],
  "loads": [{"body": "body-0", "select": {"vertices": [0, 2]}, "force": [[0, [0, 0, 0]], [2, [0, 1, 0]]]}],
  "handles": [{"body": "body-0", "select": {"boundary_loop": 0}}],
  "gravity": [0, -9.81, 0], "solve": {"method": "direct", "level": 0, "max_iterations_per_step": null}})",
    R"({"plisse": 1, "bodies": [
    {"name": "t", "mesh": {"generate": "torus", "radius": 0.5, "tube": 0.2, "edge_length": 0.2}},
    {"name": "u", "mesh": {"generate": "sheet", "cells": [2, 3], "pattern": "regular", "diagonals": "one"},
     "transform": {"translate": [0, 2, 0]}, "rest": {"mesh": {"generate": "sheet", "cells": [2, 3], "pattern": "regular",
     "diagonals": "one", "size": [2, 1]}}}],
  "handles": [{"body": "t", "select": {"sphere": [[0.5, 0, 0], 0.3]}, "axes": "z"}],
  "hierarchy": {"operator": "intrinsic", "bending_on": "level"}, "solve": {"gradient": "lagged", "dynamics": true}})"};

std::size_t place_in(const std::string& text, Random& random) {
    return static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
}

/// Where the token around a place begins and ends: a run of letters, digits, signs and points, or one character.
std::pair<std::size_t, std::size_t> token_around(const std::string& text, std::size_t place) {
    const auto in_word = [&](std::size_t i) {
        return std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '.' || text[i] == '-' || text[i] == '_';
    };
    std::size_t begin = place, end = place + 1;
    if (in_word(place)) {
        while (begin > 0 && in_word(begin - 1))
            --begin;
        while (end < text.size() && in_word(end))
            ++end;
    }
    return {begin, end};
}

std::string mutated(std::string text, Random& random) {
    static const std::vector<std::string> odd_values = {
        "0",     "-1",          "1e308",       "1e-320",     "-0.0",        "1e999",   "99999999999",
        "0.5",   "null",        "true",        "\"\"",       "[]",          "{}",      "[[]]",
        "\"x\"", "\"\\u0000\"", "\"\\ud800\"", "2147483648", "-2147483649", "[0,0,0]", "{\"mesh\":1}"};
    for (int edits = 1 + random.below(3); edits > 0 && !text.empty(); --edits) {
        const std::size_t place = place_in(text, random);
        const auto [begin, end] = token_around(text, place);
        switch (random.below(6)) {
        case 0:
            text[place] = static_cast<char>(random.below(256));
            break;
        case 1:
            text.erase(begin, end - begin);
            break;
        case 2:
            text.insert(place, text.substr(place_in(text, random), static_cast<std::size_t>(1 + random.below(20))));
            break;
        case 3:
            text.resize(place);
            break;
        default:
            text.replace(begin, end - begin,
                         odd_values[static_cast<std::size_t>(random.below(static_cast<int>(odd_values.size())))]);
        }
    }
    return text;
}

/// Whether a mesh is quickly made: a mutation may ask for millions of triangles, which is sound but slow.
bool is_small(const MeshSpec& spec) {
    const GeneratorOptions& g = spec.generator;
    const double across = std::max({g.size.maxCoeff(), g.radius + g.tube, g.outer, g.height, g.radius});
    return spec.is_file() || (across < 40 * g.edge_length && g.cells[0] < 40 && g.cells[1] < 40);
}

bool is_small(const Scene& scene) {
    return std::all_of(scene.bodies.begin(), scene.bodies.end(),
                       [](const BodySpec& b) { return is_small(b.mesh) && is_small(b.rest.mesh); }) &&
           std::all_of(scene.obstacles.begin(), scene.obstacles.end(),
                       [](const ObstacleSpec& o) { return is_small(o.mesh); });
}

bool is_sound(const Model& model) {
    const int n = model.mesh.vertex_count();
    for (const Handle& handle : model.handles)
        if (handle.vertices.empty() || handle.vertices.back() >= n)
            return false;
    return n > 0 && model.mesh.positions.allFinite() && model.start.cols() == n && model.start.allFinite() &&
           model.hierarchy.levels > 0 && model.solve.time_step > 0 &&
           model.solve.level.value_or(0) < model.hierarchy.levels;
}

TEST(SceneMutations, TwoThousandGiveAnErrorWithAPlaceOrASoundModel) {
    const std::filesystem::path folder = std::filesystem::path(PLISSE_SOURCE_DIR) / "tests/data/malformed/good";
    Random random(20);
    Context context;
    int taken = 0, refused = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const std::string text = mutated(good_scenes[static_cast<std::size_t>(trial) % good_scenes.size()], random);
        SCOPED_TRACE(text);
        try {
            const Scene scene = parse_scene("scene.json", text, folder);
            EXPECT_EQ(scene_to_json(parse_scene("scene.json", scene_to_json(scene).dump(), folder)),
                      scene_to_json(scene));
            if (is_small(scene)) {
                EXPECT_TRUE(is_sound(build_model(scene, context)));
            }
            ++taken;
        } catch (const InputError& error) {
            ++refused;
            const std::string message = error.what();
            EXPECT_TRUE(message.starts_with("scene.json:") || message.find(".obj") != std::string::npos) << message;
            EXPECT_NE(message.find("; "), std::string::npos) << message;
        }
    }
    EXPECT_GT(taken, 20) << "some mutations must get through the reader";
    EXPECT_GT(refused, 1000);
}

TEST(SceneMutations, TheScenesTheyStartFromAreGood) {
    const std::filesystem::path folder = std::filesystem::path(PLISSE_SOURCE_DIR) / "tests/data/malformed/good";
    Context context;
    for (const std::string& text : good_scenes)
        EXPECT_TRUE(is_sound(build_model(parse_scene("scene.json", text, folder), context)));
}

} // namespace
} // namespace plisse
