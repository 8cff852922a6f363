#pragma once

#include <utility>
#include <vector>

#include <plisse/energy/element_energy.h>
#include <plisse/energy/rest_triangles.h>

namespace plisse {

/// Of each face.
struct StrainLimits {
    std::vector<double> onset;     ///< stretch from which the barrier acts, >= 1
    std::vector<double> limit;     ///< stretch that is never reached, > onset
    std::vector<double> stiffness; ///< N/m
};

/// Isotropic strain limit (C-IPC, Li et al. 2021): a barrier on the principal stretches s1 >= s2 of each triangle,
///   W = A k [b(y1) + b(y2)],  y_i = (limit - s_i) / (limit - onset),
/// with b of barrier.h, A the rest area and k the stiffness; 0 up to the onset and twice continuously differentiable.
/// It is a convex and growing function of the singular values of F, so it is convex in F: its Hessian needs no
/// projection. Derivatives exist where the value is finite and the triangle is not degenerate.
class StrainLimitEnergy : public ElementEnergy {
public:
    /// rest: rest positions, m; faces: vertices in them, each face of positive area.
    StrainLimitEnergy(const Positions& rest, std::vector<Face> faces, StrainLimits limits);

    int element_count() const override { return triangles_.count(); }
    std::span<const int> vertices(int face) const override { return triangles_.face(face); }
    double value(int face, const Positions& x) const override;
    void gradient(int face, const Positions& x, double* gradient) const override;
    void hessian(int face, const Positions& x, bool project, double* hessian) const override;

    const RestTriangles& triangles() const { return triangles_; }
    const StrainLimits& limits() const { return limits_; }
    void set_limits(StrainLimits limits) { limits_ = std::move(limits); }

    /// Largest alpha in [0, 1] such that moving from x to x + alpha * d leaves every face `kept_share` of its room
    /// below the limit (of limit - onset, where there is more) at every moment of the motion, and a millionth of limit
    /// - onset in any case. Never an overestimate.
    double max_step(const Positions& x, const Positions& d) const;
    static constexpr double kept_share = 0.1;
    static constexpr double least_room = 1e-6;

private:
    /// The room below the limit over where it begins to act; above 1 where nothing acts.
    double relative_room(int face, double stretch) const;
    double width(int face) const;

    RestTriangles triangles_;
    StrainLimits limits_;
};

/// Largest alpha in [0, end] for which the largest singular value of F + s d, at most `bound` at s = 0, is at most
/// `bound` for all s in [0, alpha]; may be a fiftieth less. `end` itself where it is so all the way. Never an
/// overestimate.
double limited_step(const Mat32& F, const Mat32& d, double bound, double end);

} // namespace plisse
