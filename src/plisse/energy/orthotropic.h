#pragma once

#include <array>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// phi(u) = sum_i mu_i/alpha_i [(1 + u)^alpha_i - 1] (RMTR equation 3.4), with sum_i mu_i = 1, so that phi'(0) = 1; of
/// squares u >= 0. Beyond u = `limit`, a strain of a quarter, where fitted exponents mean nothing, it goes on as a
/// parabola with the slope and the second derivative that it has there, the latter at least 0, so that energies stay
/// bounded from below. phi(u) = u takes any u.
class ResponseFunction {
public:
    static constexpr double limit = 0.0625;
    struct Term {
        double mu, alpha;
    };
    /// Of terms that sum to 1 together with a first one of this alpha, whose mu follows.
    ResponseFunction(double first_alpha, std::vector<Term> others);
    /// phi(u) = u.
    ResponseFunction() = default;

    double value(double u) const;
    struct Slopes {
        double first, second;
    };
    /// phi'(u) and phi''(u).
    Slopes slopes(double u) const;
    const std::vector<Term>& terms() const { return terms_; }

private:
    Slopes inner_slopes(double u) const;

    std::vector<Term> terms_; ///< none: phi(u) = u
};

/// In-plane strain (E11, E22, E12) of Green and Lagrange along warp, weft and between them; E12 is half the shear
/// angle.
using Strain = Vec3;

/// Stress and tangent at a strain.
struct StressTangent {
    Vec3 stress;  ///< d psi / d (E11, E22, E12), Pa
    Mat3 tangent; ///< d2 psi, Pa; nothing couples E12 with the others
};

/// An orthotropic membrane in plane stress, per unit of rest volume (RMTR equation 3.3):
///   psi = k1/2 phi1(E11^2) + k2 phi2(E11 E22) + k3/2 phi3(E22^2) + k4 phi4(E12^2).
struct OrthotropicMaterial {
    std::array<double, 4> stiffness{};         ///< k1 .. k4, Pa
    std::array<ResponseFunction, 4> responses; ///< phi1 .. phi4

    double energy(const Strain& strain) const; ///< J/m^3
    Vec3 stress(const Strain& strain) const;
    StressTangent stress_and_tangent(const Strain& strain) const;
};

/// Denim as the paper's table has it, the first mu of each response filled in. Its energy has a spurious well under
/// biaxial strain, -20.5 kPa at (E11, E22) = (-0.114, 0.108).
OrthotropicMaterial denim_table();
/// The same with a tenth of k2: the energy is not negative for strains below 0.2.
OrthotropicMaterial denim_stable();
/// St Venant-Kirchhoff in plane stress: E in Pa, nu in (-1, 1).
OrthotropicMaterial isotropic_material(double youngs_modulus, double poisson_ratio);

} // namespace plisse
