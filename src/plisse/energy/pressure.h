#pragma once

#include <vector>

#include <plisse/energy/element_energy.h>

namespace plisse {

/// A uniform pressure p inside a closed body: W = -p V, V by the divergence theorem about the centre of the rest shape.
/// V is positive whichever way the faces turn, so a positive p pushes outward.
///
/// What an element's derivatives stand for: only their sums over the closed surface are derivatives of V. An element's
/// gradient is its own share p A n/3 of the force at each corner, its Hessian the symmetric part of the derivative of
/// that: free of the reference point, and as small as the element, so that projecting it element by element adds a
/// stiffness of p times the edge length only.
class PressureEnergy : public ElementEnergy {
public:
    /// faces: a closed surface (every edge has two faces, turned alike) that encloses a volume at rest.
    PressureEnergy(const Positions& rest, std::vector<Face> faces, double pressure = 0);

    void set_pressure(double pressure) { pressure_ = pressure; } ///< Pa
    double pressure() const { return pressure_; }
    /// Enclosed volume, m^3.
    double volume(const Positions& x) const;

    int element_count() const override { return static_cast<int>(faces_.size()); }
    std::span<const int> vertices(int face) const override { return faces_[static_cast<std::size_t>(face)]; }
    double value(int face, const Positions& x) const override;
    void gradient(int face, const Positions& x, double* gradient) const override;
    void hessian(int face, const Positions& x, bool project, double* hessian) const override;

private:
    double signed_volume(int face, const Positions& x) const;

    std::vector<Face> faces_;
    double pressure_;
    double orientation_ = 1; ///< -1 where the normals point into the body
    Vec3 reference_ = Vec3::Zero();
};

/// Forces p A n/3 of the faces at their corners at x, N: the frozen loads of an open body under pressure (Pa), along
/// the face normals.
Positions pressure_forces(const Positions& x, std::span<const Face> faces, double pressure);

} // namespace plisse
