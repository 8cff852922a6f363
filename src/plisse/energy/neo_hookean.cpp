#include <plisse/energy/neo_hookean.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <plisse/energy/positive_part.h>

namespace plisse {

namespace {

/// C - I = [[a, c], [c, b]] and det C.
struct Strain {
    double a, b, c;
    double shear_part;      ///< ab - c^2, the determinant of C - I
    double determinant;     ///< det C
    double log_determinant; ///< 2 ln J
    double dilation() const { return a + b + shear_part; }
};

/// Far from rest det C comes from the cross product, which is exact to round-off where C is nearly singular; near rest
/// from C - I, where 1 + x - 1 would lose the strain.
Strain strain_of(const Mat32& F) {
    Strain strain;
    strain.a = F.col(0).squaredNorm() - 1;
    strain.b = F.col(1).squaredNorm() - 1;
    strain.c = F.col(0).dot(F.col(1));
    strain.shear_part = strain.a * strain.b - strain.c * strain.c;
    strain.determinant = F.col(0).cross(F.col(1)).squaredNorm();
    strain.log_determinant = strain.determinant < 0.5 ? std::log(strain.determinant) : std::log1p(strain.dilation());
    return strain;
}

/// x - ln(1 + x) given the logarithm, to round-off relative to x^2.
double excess_over_log(double x, double log_of_one_plus_x) {
    if (std::abs(x) > 0.1)
        return x - log_of_one_plus_x;
    // ln(1 + x) = 2 artanh z = 2 (z + z^3/3 + ...) with z = x/(2 + x), and x - 2z = x z.
    const double z = x / (2 + x);
    const double q = z * z;
    const double tail =
        1.0 / 3 + q * (1.0 / 5 + q * (1.0 / 7 + q * (1.0 / 9 + q * (1.0 / 11 + q * (1.0 / 13 + q * (1.0 / 15))))));
    return z * (x - 2 * q * tail);
}

} // namespace

Lame plane_stress_lame(double youngs_modulus, double poisson_ratio) {
    return {youngs_modulus / (2 * (1 + poisson_ratio)),
            youngs_modulus * poisson_ratio / (1 - poisson_ratio * poisson_ratio)};
}

double neo_hookean_value(const Mat32& F, const Lame& lame) {
    const Strain strain = strain_of(F);
    if (!(strain.determinant > 0))
        return std::numeric_limits<double>::infinity();
    const double excess = excess_over_log(strain.dilation(), strain.log_determinant) - strain.shear_part;
    return lame.mu / 2 * excess + lame.lambda / 8 * strain.log_determinant * strain.log_determinant;
}

Mat32 neo_hookean_stress(const Mat32& F, const Lame& lame) {
    const Strain strain = strain_of(F);
    const double pressure = lame.lambda / 2 * strain.log_determinant;
    // S = [mu (C - I) + lambda ln J I] C^-1, P = F S
    const double c_squared = strain.c * strain.c;
    const double s11 = lame.mu * (strain.a * (1 + strain.b) - c_squared) + pressure * (1 + strain.b);
    const double s22 = lame.mu * (strain.b * (1 + strain.a) - c_squared) + pressure * (1 + strain.a);
    const double s12 = strain.c * (lame.mu - pressure);
    Mat32 stress;
    stress.col(0) = (s11 * F.col(0) + s12 * F.col(1)) / strain.determinant;
    stress.col(1) = (s12 * F.col(0) + s22 * F.col(1)) / strain.determinant;
    return stress;
}

StretchModes neo_hookean_modes(const Mat32& F, const Lame& lame, bool project) {
    const Strain strain = strain_of(F);
    const double J = std::sqrt(strain.determinant);
    StretchModes modes;
    modes.frame = principal_frame(F);
    const double s1 = modes.frame.stretches[0];
    const double s2 = modes.frame.stretches[1];

    const double pressure = lame.lambda / 2 * strain.log_determinant;
    const double drop = lame.mu - pressure;
    const double inverse1 = 1 / (s1 * s1);
    const double inverse2 = 1 / (s2 * s2);
    modes.stretch << lame.mu + (drop + lame.lambda) * inverse1, lame.lambda / J, lame.lambda / J,
        lame.mu + (drop + lame.lambda) * inverse2;
    modes.twist = lame.mu - drop / J;
    modes.flip = lame.mu + drop / J;
    modes.lift << lame.mu - drop * inverse1, lame.mu - drop * inverse2;
    if (project) {
        modes.stretch = positive_part(modes.stretch);
        modes.twist = std::max(modes.twist, 0.0);
        modes.flip = std::max(modes.flip, 0.0);
        modes.lift = modes.lift.cwiseMax(0.0);
    }
    return modes;
}

} // namespace plisse
