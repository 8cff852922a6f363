#include <plisse/model/barrier_stiffness.h>

#include <algorithm>

#include <plisse/energy/orthotropic.h>

namespace plisse {

namespace {

/// That of an isotropic material, or of an orthotropic one the stiffness of its stiffer yarns.
double modulus(const Material& material) {
    switch (material.law) {
    case MaterialLaw::denim_table:
        return denim_table().stiffness[2];
    case MaterialLaw::denim_stable:
        return denim_stable().stiffness[2];
    case MaterialLaw::isotropic:
        break;
    }
    return material.youngs_modulus;
}

} // namespace

double barrier_stiffness(const Material& material, double size) {
    const double youngs_modulus = modulus(material);
    const double bulk_modulus = youngs_modulus / (3 * (1 - 2 * std::min(material.poisson_ratio, 0.45)));
    return std::min(30 * youngs_modulus * material.thickness / size, bulk_modulus);
}

} // namespace plisse
