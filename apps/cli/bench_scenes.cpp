#include "bench_scenes.h"

#include <algorithm>
#include <cassert>

#include <plisse/scene/read_scene.h>

namespace plisse {

namespace {

/// A mesh size with the hierarchy that was fastest for it (docs/decisions/0011).
struct BenchSize {
    double edge_length; ///< m
    int levels, coarsest_vertices;
};

struct BenchScene {
    const char* name;
    const char* text;
    BenchSize full, quick;
};

constexpr BenchScene scenes[] = {
    {"can",
     R"({
  // The wall of a thin aluminium can, its rim pushed down and a little aside.
  "plisse": 1,
  "name": "can",
  "bodies": [{"name": "can", "mesh": {"generate": "cylinder", "radius": 0.033, "height": 0.1, "seed": 1},
    "material": {"density": 2700, "youngs_modulus": 7e10, "poisson_ratio": 0.33, "thickness": 1e-4}}],
  "handles": [
    {"name": "foot", "body": "can", "select": {"box": [[-1, -0.06, -1], [1, -0.0499, 1]]}},
    {"name": "rim", "body": "can", "select": {"box": [[-1, 0.0499, -1], [1, 0.06, 1]]},
     "motion": [{"t": 0}, {"t": 1, "translate": [0.001, -0.02, 0]}]}],
  "gravity": [0, 0, 0],
  "contact": {"distance": 5e-4},
  "hierarchy": {"bending_on": "level"},
  "solve": {"time_step": 0.05, "duration": 1}
})",
     {0.0016, 2, 1500},
     {0.0025, 3, 400}},
    {"twist",
     R"({
  // A cloth whose ends turn against each other, and which rubs on itself.
  "plisse": 1,
  "name": "twist",
  "bodies": [{"name": "cloth", "mesh": {"generate": "sheet", "size": [1, 1], "seed": 1},
    "material": {"density": 472.6, "youngs_modulus": 82.1e3, "poisson_ratio": 0.243, "thickness": 3.18e-4,
                 "bending_scale": 3}}],
  "handles": [
    {"name": "left", "body": "cloth", "select": {"box": [[-0.501, -1, -1], [-0.499, 1, 1]]},
     "motion": [{"t": 0}, {"t": 2, "rotate_deg": [144, 0, 0]}]},
    {"name": "right", "body": "cloth", "select": {"box": [[0.499, -1, -1], [0.501, 1, 1]]},
     "motion": [{"t": 0}, {"t": 2, "rotate_deg": [-144, 0, 0]}]}],
  "gravity": [0, 0, 0],
  "contact": {"distance": 1e-3, "friction": 0.3},
  "hierarchy": {"bending_on": "level"},
  "solve": {"time_step": 0.05, "duration": 2}
})",
     {0.014, 2, 1500},
     {0.025, 3, 300}},
};

} // namespace

Scene bench_scene(const std::string& name, bool quick) {
    const auto* found =
        std::find_if(std::begin(scenes), std::end(scenes), [&](const BenchScene& scene) { return scene.name == name; });
    assert(found != std::end(scenes));
    Scene scene = parse_scene("the benchmark " + name, found->text, {});
    const BenchSize& size = quick ? found->quick : found->full;
    scene.bodies.front().mesh.generator.edge_length = size.edge_length;
    scene.hierarchy.levels = size.levels;
    scene.hierarchy.coarsest_vertices = size.coarsest_vertices;
    return scene;
}

} // namespace plisse
