#include <plisse/scene/contact_settings.h>

#include <algorithm>

namespace plisse {

namespace {

template <typename Part>
int number_of(const std::vector<Part>& parts, const std::string& name) {
    const auto found = std::find_if(parts.begin(), parts.end(), [&](const Part& part) { return part.name == name; });
    return static_cast<int>(found - parts.begin());
}

/// Of a body, or of an obstacle after the bodies.
int part_number(const Scene& scene, const std::string& name) {
    const auto bodies = static_cast<int>(scene.bodies.size());
    const int body = number_of(scene.bodies, name);
    return body < bodies ? body : bodies + number_of(scene.obstacles, name);
}

} // namespace

ContactSettings contact_settings(const Scene& scene) {
    const ContactSpec& spec = scene.contact;
    ContactSettings settings{spec.distance, spec.thickness, spec.self, spec.friction, spec.friction_velocity, {}};
    for (const ContactPairSpec& pair : spec.pairs)
        settings.pairs.push_back({part_number(scene, pair.a), part_number(scene, pair.b), pair.friction});
    return settings;
}

} // namespace plisse
