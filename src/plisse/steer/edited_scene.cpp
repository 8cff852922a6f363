#include <plisse/steer/edited_scene.h>

#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <plisse/scene/motion_track.h>
#include <plisse/scene/read_scene.h>
#include <plisse/scene/write_scene.h>

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

const std::array<std::string, 24> live{"/name",
                                       "/gravity",
                                       "/pulls",
                                       "/edits",
                                       "/bodies/*/pressure",
                                       "/bodies/*/material/density",
                                       "/bodies/*/material/youngs_modulus",
                                       "/bodies/*/material/poisson_ratio",
                                       "/bodies/*/material/thickness",
                                       "/bodies/*/material/bending_scale",
                                       "/obstacles/*/motion",
                                       "/handles/*/motion",
                                       "/loads/*/force",
                                       "/loads/*/traction",
                                       "/contact/friction",
                                       "/contact/friction_velocity",
                                       "/contact/pairs",
                                       "/solve/time_step",
                                       "/solve/duration",
                                       "/solve/settle",
                                       "/solve/max_settle_steps",
                                       "/solve/tolerance",
                                       "/solve/max_iterations_per_step",
                                       "/solve/frame_interval"};

/// Takes out what the rest of a pattern names, without its leading "/".
void erase(Json& json, std::string_view pattern) {
    const std::size_t end = pattern.find('/');
    const std::string key(pattern.substr(0, end));
    if (end == std::string_view::npos) {
        json.erase(key);
        return;
    }
    const std::string_view rest = pattern.substr(end + 1);
    if (key == "*")
        for (Json& item : json)
            erase(item, rest);
    else if (json.contains(key))
        erase(json[key], rest);
}

Json without_live(const Scene& scene) {
    Json json = scene_to_json(scene);
    for (const std::string& pattern : live)
        erase(json, std::string_view(pattern).substr(1));
    return json;
}

bool same_at_start(const MotionSpec& a, const MotionSpec& b) {
    const MotionTrack one = motion_track(a), other = motion_track(b);
    const auto differs = [](const Track<Vec3>& p, const Track<Vec3>& q) { return p.at(0) != q.at(0); };
    const bool turned = one.rotate_deg.at(0) != Vec3::Zero() && differs(one.about, other.about);
    return !differs(one.translate, other.translate) && !differs(one.rotate_deg, other.rotate_deg) && !turned;
}

} // namespace

Scene edited_scene(const Scene& scene, const std::string& pointer, const nlohmann::ordered_json& value) {
    Json json = scene_to_json(scene);
    try {
        const Json::json_pointer place(pointer);
        Json& parent = json.at(place.parent_pointer());
        (parent.is_object() ? parent[place.back()] : parent.at(Json::json_pointer("/" + place.back()))) = value;
    } catch (const Json::exception&) {
        throw InputError(pointer, "the scene has no such place", "give a JSON pointer such as \"/gravity\"");
    }
    return parse_scene("the edited scene", json.dump(2), scene.folder);
}

std::span<const std::string> live_pointers() {
    return live;
}

bool can_go_on(const Scene& before, const Scene& after) {
    if (without_live(before) != without_live(after))
        return false;
    for (std::size_t o = 0; o < before.obstacles.size(); ++o)
        if (!same_at_start(before.obstacles[o].motion, after.obstacles[o].motion))
            return false;
    return true;
}

} // namespace plisse
