#pragma once

#include <vector>

#include <plisse/energy/element_energy.h>
#include <plisse/energy/neo_hookean.h>
#include <plisse/energy/rest_triangles.h>

namespace plisse {

/// Membrane material of each face.
struct MembraneMaterials {
    std::vector<double> mu;        ///< Pa
    std::vector<double> lambda;    ///< Pa, of plane stress (plane_stress_lame)
    std::vector<double> thickness; ///< m
};

/// Neo-Hookean stretching of triangles: W = A h w(F) with w of neo_hookean.h, A and h rest area and thickness.
/// Derivatives exist where the value is finite.
class MembraneEnergy : public ElementEnergy {
public:
    /// rest: rest positions, m; faces: vertices in them, each face of positive area; one material a face.
    MembraneEnergy(const Positions& rest, std::vector<Face> faces, MembraneMaterials materials);

    int element_count() const override { return triangles_.count(); }
    std::span<const int> vertices(int face) const override { return triangles_.face(face); }
    double value(int face, const Positions& x) const override;
    void gradient(int face, const Positions& x, double* gradient) const override;
    void hessian(int face, const Positions& x, bool project, double* hessian) const override;

    const RestTriangles& triangles() const { return triangles_; }

private:
    Lame lame(int face) const;
    double volume(int face) const;

    RestTriangles triangles_;
    MembraneMaterials materials_;
};

} // namespace plisse
