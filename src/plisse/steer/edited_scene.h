#pragma once

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <plisse/scene/scene.h>

namespace plisse {

/// The scene with another value at this JSON pointer. Throws InputError when there is no such place, or when the scene
/// would not be one with this value there.
Scene edited_scene(const Scene& scene, const std::string& pointer, const nlohmann::ordered_json& value);

/// Patterns of the pointers whose values a run can take over between two steps ("*": any number); anything else needs
/// a new run.
std::span<const std::string> live_pointers();

/// Whether a run of the one scene can go on with the other: they differ only at live pointers, and obstacles begin in
/// the same places.
bool can_go_on(const Scene& before, const Scene& after);

} // namespace plisse
