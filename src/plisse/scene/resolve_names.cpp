#include <plisse/scene/resolve_names.h>

#include <algorithm>

#include <fmt/core.h>

#include <plisse/scene/json_cursor.h>

namespace plisse {

namespace {

/// Gives the nameless names by number, and refuses a name that is taken twice within `taken`.
template <typename Named>
void name_all(const Scene& scene, std::vector<Named>& list, const char* kind, const char* key,
              std::vector<std::string>& taken) {
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (list[i].name.empty())
            list[i].name = fmt::format("{}-{}", kind, i);
        if (std::find(taken.begin(), taken.end(), list[i].name) != taken.end())
            throw scene.error_at(fmt::format("/{}/{}/name", key, i),
                                 fmt::format("the name \"{}\" is taken twice", list[i].name), "give another name");
        taken.push_back(list[i].name);
    }
}

void expect_name(const Scene& scene, const std::string& pointer, const std::string& name,
                 std::span<const std::string> names, const char* kind) {
    if (std::find(names.begin(), names.end(), name) == names.end())
        throw scene.error_at(pointer, fmt::format("there is no {} \"{}\"", kind, name),
                             fmt::format("the nearest name is \"{}\"", nearest_name(name, names)));
}

} // namespace

void resolve_names(Scene& scene) {
    std::vector<std::string> parts, scripted;
    name_all(scene, scene.bodies, "body", "bodies", parts);
    const std::vector<std::string> bodies = parts;
    name_all(scene, scene.obstacles, "obstacle", "obstacles", parts);
    for (const ObstacleSpec& obstacle : scene.obstacles)
        scripted.push_back(obstacle.name);
    name_all(scene, scene.handles, "handle", "handles", scripted);

    for (std::size_t i = 0; i < scene.handles.size(); ++i)
        expect_name(scene, fmt::format("/handles/{}/body", i), scene.handles[i].body, bodies, "body");
    for (std::size_t i = 0; i < scene.loads.size(); ++i)
        expect_name(scene, fmt::format("/loads/{}/body", i), scene.loads[i].body, bodies, "body");
    std::vector<std::string> pulls;
    name_all(scene, scene.pulls, "pull", "pulls", pulls);
    for (std::size_t i = 0; i < scene.pulls.size(); ++i)
        expect_name(scene, fmt::format("/pulls/{}/body", i), scene.pulls[i].body, bodies, "body");
    for (std::size_t i = 0; i < scene.contact.pairs.size(); ++i) {
        expect_name(scene, fmt::format("/contact/pairs/{}/a", i), scene.contact.pairs[i].a, parts, "body or obstacle");
        expect_name(scene, fmt::format("/contact/pairs/{}/b", i), scene.contact.pairs[i].b, parts, "body or obstacle");
    }
}

} // namespace plisse
