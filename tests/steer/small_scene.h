#pragma once

#include <string>

#include <plisse/scene/read_scene.h>

namespace plisse {

/// A cloth of about 300 vertices that falls over a ball, on two levels; more: further members of the scene.
inline Scene small_scene(const std::string& more = "") {
    return parse_scene("small.json",
                       R"({
        "plisse": 1, "name": "small",
        "bodies": [{"name": "cloth", "mesh": {"generate": "sheet", "size": [0.5, 0.5], "edge_length": 0.03},
                    "transform": {"translate": [0, 0.12, 0]}, "material": "cotton"}],
        "obstacles": [{"name": "ball", "mesh": {"generate": "sphere", "radius": 0.1, "edge_length": 0.03}}],
        "handles": [{"name": "corner", "body": "cloth",
                     "select": {"box": [[-0.3, 0, -0.3], [-0.2, 1, -0.2]]}}],
        "contact": {"distance": 3e-3, "friction": 0.3},
        "hierarchy": {"levels": 2, "coarsest_vertices": 80},
        "solve": {"time_step": 0.05, "duration": 0.3, "frame_interval": 0.05})" +
                           more + "}",
                       ".");
}

} // namespace plisse
