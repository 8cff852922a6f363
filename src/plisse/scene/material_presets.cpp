#include <plisse/scene/material_presets.h>

#include <algorithm>
#include <vector>

namespace plisse {

namespace {

Material denim(MaterialLaw law) {
    Material material;
    material.thickness = 6.6e-4;
    material.density = 0.4 / material.thickness; // 0.4 kg/m^2
    material.law = law;
    return material;
}

} // namespace

std::span<const MaterialPreset> material_presets() {
    // density kg/m^3, Young's modulus Pa, Poisson's ratio, thickness m, bending scale
    static const std::vector<MaterialPreset> presets = {
        {"cotton",
         {472.6, 8e5, 0.243, 3e-4, 1},
         "Li, Kaufman, Jiang 2021 (Codimensional incremental potential contact), rounded: 0.82 MPa and 0.318 mm there"},
        {"denim",
         {680, 4e6, 0.25, 7e-4, 1},
         "typical: a twill of 14 oz per square yard (475 g/m^2), 0.7 mm; modulus of the fabric at small strain"},
        {"silk",
         {500, 2e6, 0.3, 1e-4, 1},
         "typical: a plain weave of 50 g/m^2, 0.1 mm; modulus of the fabric at small strain, not of the fibre"},
        {"rubber",
         {930, 1.5e6, 0.49, 5e-4, 1},
         "unfilled natural rubber: Ashby, Materials Selection in Mechanical Design (1.5 to 2.5 MPa); a sheet of 0.5 "
         "mm"},
        {"mylar",
         {1390, 4.9e9, 0.38, 5e-5, 1},
         "biaxially oriented PET film, typical of makers' data sheets (4.5 to 5 GPa); 50 micrometres"},
        {"aluminium", {2700, 7.0e10, 0.3, 1e-4, 1}, "EN 1999-1-1, 3.2.5; the wall of a drinks can, 0.1 mm"},
        {"steel", {7850, 2.1e11, 0.3, 5e-4, 1}, "EN 1993-1-1, 3.2.6; a sheet of 0.5 mm"},
        {"denim-stable", denim(MaterialLaw::denim_stable),
         "the next, with k2 a tenth of what is printed, so that no strain has an energy below that of rest"},
        {"denim-table", denim(MaterialLaw::denim_table),
         "Kopanicakova, Krause, Tamstorf 2019 (Subdivision-based nonlinear multiscale cloth simulation), table 1"},
        {"acrylic", {1190, 3.3e9, 0.37, 2e-3, 1}, "cast PMMA, typical of makers' data sheets; a sheet of 2 mm"},
    };
    return presets;
}

const MaterialPreset* find_material_preset(const std::string& name) {
    const auto presets = material_presets();
    const auto found =
        std::find_if(presets.begin(), presets.end(), [&](const auto& preset) { return preset.name == name; });
    return found == presets.end() ? nullptr : &*found;
}

} // namespace plisse
