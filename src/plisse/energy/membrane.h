#pragma once

#include <vector>

#include <plisse/energy/element_energy.h>
#include <plisse/energy/neo_hookean.h>

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

    int element_count() const override { return static_cast<int>(faces_.size()); }
    std::span<const int> vertices(int face) const override { return faces_[static_cast<std::size_t>(face)]; }
    double value(int face, const Positions& x) const override;
    void gradient(int face, const Positions& x, double* gradient) const override;
    void hessian(int face, const Positions& x, bool project, double* hessian) const override;

    const std::vector<double>& rest_areas() const { return areas_; } ///< m^2, one a face

    /// The larger, then the smaller stretch of a face.
    Vec2 principal_stretches(int face, const Positions& x) const;
    /// Largest principal stretch over all faces; 0 without faces.
    double largest_stretch(const Positions& x) const;

private:
    Mat32 deformation_gradient(int face, const Positions& x) const;
    Lame lame(int face) const;
    double volume(int face) const;

    std::vector<Face> faces_;
    MembraneMaterials materials_;
    std::vector<Mat2> inverse_rest_edges_;
    std::vector<double> areas_;
};

} // namespace plisse
