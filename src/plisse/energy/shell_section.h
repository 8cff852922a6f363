#pragma once

#include <vector>

#include <plisse/energy/orthotropic.h>

namespace plisse {

/// A shell's material over its thickness: strains E0 + xi kappa, integrated by Gauss points in xi into an energy per
/// area of the membrane strain E0 and the change of curvature kappa, both as (11, 22, 12).
class ShellSection {
public:
    /// thickness in m; points: 3 or 5. Of a linear material 3 are exact.
    ShellSection(OrthotropicMaterial material, double thickness, int points);

    double energy(const Vec3& strain, const Vec3& curvature) const; ///< J/m^2
    struct Forces {
        Vec3 membrane; ///< N = d energy / d strain, N/m
        Vec3 bending;  ///< M = d energy / d curvature, N
    };
    Forces forces(const Vec3& strain, const Vec3& curvature) const;
    struct Tangent {
        Forces forces;
        Mat3 membrane, coupling, bending; ///< dN/dE0, dN/dkappa (symmetric), dM/dkappa
    };
    /// project: each point's tangent is made positive semi-definite, hence that of both together.
    Tangent tangent(const Vec3& strain, const Vec3& curvature, bool project) const;

    const OrthotropicMaterial& material() const { return material_; }
    double thickness() const { return thickness_; }

private:
    struct Point {
        double height, weight; ///< xi and its share of the thickness, m
    };
    OrthotropicMaterial material_;
    double thickness_;
    std::vector<Point> points_;
};

} // namespace plisse
