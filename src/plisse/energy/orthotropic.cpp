#include <plisse/energy/orthotropic.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace plisse {

ResponseFunction::ResponseFunction(double first_alpha, std::vector<Term> others) : terms_(std::move(others)) {
    double first_mu = 1;
    for (const Term& term : terms_)
        first_mu -= term.mu;
    terms_.insert(terms_.begin(), {first_mu, first_alpha});
}

double ResponseFunction::value(double u) const {
    if (terms_.empty())
        return u;
    const double inner = std::min(u, limit);
    const double log = std::log1p(inner);
    double sum = 0;
    for (const Term& term : terms_)
        sum += term.mu / term.alpha * std::expm1(term.alpha * log);
    if (inner == u)
        return sum;
    const Slopes at_limit = inner_slopes(inner);
    const double beyond = u - inner;
    return sum + beyond * (at_limit.first + beyond * std::max(at_limit.second, 0.0) / 2);
}

ResponseFunction::Slopes ResponseFunction::slopes(double u) const {
    if (terms_.empty())
        return {1, 0};
    const double inner = std::min(u, limit);
    Slopes slopes = inner_slopes(inner);
    if (inner == u)
        return slopes;
    slopes.second = std::max(slopes.second, 0.0);
    slopes.first += (u - inner) * slopes.second;
    return slopes;
}

/// Summed as differences from u = 0, where mu of thousands cancel to 1.
ResponseFunction::Slopes ResponseFunction::inner_slopes(double u) const {
    const double log = std::log1p(u);
    Slopes slopes{1, 0};
    for (const Term& term : terms_) {
        const double power = term.alpha - 1;
        const double change = std::expm1(power * log);
        slopes.first += term.mu * change;
        slopes.second += term.mu * power * (1 + change);
    }
    slopes.second /= 1 + u;
    return slopes;
}

double OrthotropicMaterial::energy(const Strain& strain) const {
    const auto& k = stiffness;
    return k[0] / 2 * responses[0].value(strain[0] * strain[0]) + k[1] * responses[1].value(strain[0] * strain[1]) +
           k[2] / 2 * responses[2].value(strain[1] * strain[1]) + k[3] * responses[3].value(strain[2] * strain[2]);
}

Vec3 OrthotropicMaterial::stress(const Strain& strain) const {
    const auto& k = stiffness;
    const double mixed = k[1] * responses[1].slopes(strain[0] * strain[1]).first;
    return {k[0] * strain[0] * responses[0].slopes(strain[0] * strain[0]).first + mixed * strain[1],
            k[2] * strain[1] * responses[2].slopes(strain[1] * strain[1]).first + mixed * strain[0],
            2 * k[3] * strain[2] * responses[3].slopes(strain[2] * strain[2]).first};
}

StressTangent OrthotropicMaterial::stress_and_tangent(const Strain& strain) const {
    const auto& k = stiffness;
    const double e1 = strain[0], e2 = strain[1], e12 = strain[2];
    const auto warp = responses[0].slopes(e1 * e1), mixed = responses[1].slopes(e1 * e2);
    const auto weft = responses[2].slopes(e2 * e2), shear = responses[3].slopes(e12 * e12);
    StressTangent result;
    result.stress = {k[0] * e1 * warp.first + k[1] * e2 * mixed.first, k[2] * e2 * weft.first + k[1] * e1 * mixed.first,
                     2 * k[3] * e12 * shear.first};
    Mat3& tangent = result.tangent;
    tangent.setZero();
    tangent(0, 0) = k[0] * (warp.first + 2 * e1 * e1 * warp.second) + k[1] * e2 * e2 * mixed.second;
    tangent(1, 1) = k[2] * (weft.first + 2 * e2 * e2 * weft.second) + k[1] * e1 * e1 * mixed.second;
    tangent(0, 1) = tangent(1, 0) = k[1] * (mixed.first + e1 * e2 * mixed.second);
    tangent(2, 2) = 2 * k[3] * (shear.first + 2 * e12 * e12 * shear.second);
    return result;
}

OrthotropicMaterial denim_table() {
    OrthotropicMaterial material;
    material.stiffness = {4.79e6, 4.52e6, 9.03e6, 2.44e6};
    material.responses[0] = {-7.80, {{-1482.1, 10.80}, {276.43, 18.95}, {2407.67, -12.89}, {3416.79, 1.61}}};
    material.responses[2] = {12.71, {{0.658, -12802}, {-185.7, 17.91}, {-45.82, 30.07}, {146.98, 24.68}}};
    material.responses[3] = {2.95, {{0.79, -2823.9}, {11.08, 4.29}}};
    return material;
}

OrthotropicMaterial denim_stable() {
    OrthotropicMaterial material = denim_table();
    material.stiffness[1] = 0.452e6;
    return material;
}

OrthotropicMaterial isotropic_material(double youngs_modulus, double poisson_ratio) {
    assert(poisson_ratio > -1 && poisson_ratio < 1);
    const double k = youngs_modulus / (1 - poisson_ratio * poisson_ratio);
    OrthotropicMaterial material;
    material.stiffness = {k, poisson_ratio * k, k, youngs_modulus / (1 + poisson_ratio)};
    return material;
}

} // namespace plisse
