#include <plisse/scene/write_scene.h>

#include <plisse/scene/json_writer.h>

namespace plisse {

nlohmann::ordered_json ObjectWriter::write(const std::array<bool, 3>& axes) {
    std::string name;
    for (std::size_t k = 0; k < 3; ++k)
        if (axes[k])
            name += static_cast<char>('x' + k);
    return name;
}

nlohmann::ordered_json ObjectWriter::write(const RestSpec& rest) {
    switch (rest.kind) {
    case RestSpec::Kind::as_given:
        return "as-given";
    case RestSpec::Kind::flat_angles:
        return "flat-angles";
    case RestSpec::Kind::mesh:
        return {{"mesh", write(rest.mesh)}};
    }
    return nullptr;
}

nlohmann::ordered_json scene_to_json(const Scene& scene) {
    return ObjectWriter::write(scene);
}

} // namespace plisse
