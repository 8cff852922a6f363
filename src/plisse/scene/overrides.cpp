#include <plisse/scene/overrides.h>

#include <fmt/core.h>

#include <plisse/scene/scene_fields.h>

namespace plisse {

namespace {

Method method_named(const std::string& name) {
    for (const auto& choice : choices_of(Method{}).choices)
        if (choice.name == name)
            return choice.value;
    throw InputError("--method " + name, "there is no such method", "give progressive, direct or rmtr");
}

} // namespace

void override_solve(Scene& scene, const std::optional<std::string>& method, const std::optional<int>& level) {
    if (method)
        scene.solve.method = method_named(*method);
    if (scene.solve.method != Method::direct)
        scene.solve.level.reset();
    if (!level)
        return;
    const std::string place = fmt::format("--level {}", *level);
    if (scene.solve.method != Method::direct)
        throw InputError(place, "a level is only for the method direct", "give --method direct too");
    if (*level < 0 || *level >= scene.hierarchy.levels)
        throw InputError(place, fmt::format("the scene has {} levels", scene.hierarchy.levels),
                         fmt::format("give a level from 0 to {}", scene.hierarchy.levels - 1));
    scene.solve.level = level;
}

} // namespace plisse
