#pragma once

#include <span>
#include <string>

#include <plisse/model/model.h>

namespace plisse {

/// A named material with where its values come from.
struct MaterialPreset {
    std::string name;
    Material material;
    std::string source;
};

std::span<const MaterialPreset> material_presets();

/// The preset of this name; null when there is none.
const MaterialPreset* find_material_preset(const std::string& name);

} // namespace plisse
