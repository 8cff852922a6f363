#pragma once

#include <array>
#include <vector>

#include <plisse/decimate/patch.h>

namespace plisse {

/// Which end of an edge the merged vertex coincides with.
enum class Alias { none, i, j };

/// Common parameter plane of a patch before and after its collapse: U_i = (0, 0), U_j = (1, 0).
struct Chart {
    Alias alias = Alias::none; ///< U_k is exactly U_i or U_j
    Vec2 k = Vec2::Zero();
    std::vector<Vec2> ring; ///< in the order of the patch's ring
};

/// Flattens the faces before and after a collapse together, so that both cover one polygon and the plane maps either
/// onto the other one to one (Liu et al. 2021). Least squares conformal energy over the triangles of both,
///     E = sum |sum_c W_c U_c|^2 / (2 A),  U = u + iv,  W = (z2 - z1, z0 - z2, z1 - z0),
/// z a triangle laid out at true size. Where the edge is on the boundary, boundary stays on the line v = 0.
class JointFlattening {
public:
    static constexpr int most_ring = 24;

    /// alias: the end whose position k took, if it did (as it must when only that end is on the boundary). Rest
    /// positions are by vertex id, k's included. False when no chart is valid: all triangles positive and not slivers,
    /// angles around i, j and k at most a full turn.
    bool flatten(const Patch& patch, const DynamicFaces& faces, const Positions& rest, Alias alias, Chart& chart);

private:
    static constexpr int most_vertices = most_ring + 3;
    static constexpr int most_unknowns = 2 * (most_ring + 1);

    struct Triangle {
        std::array<int, 3> corner; ///< 0 = i, 1 = j, 2 = k, 3 + n = ring vertex n
        double length, x, y;       ///< laid out as (0, 0), (length, 0), (x, y)
    };
    /// What is prescribed beside the places of i and j.
    struct Constraint {
        Alias alias = Alias::none;
        int beyond_i = -1, beyond_j = -1; ///< vertices that the boundary runs straight to, v = 0; -1: none
        bool straight_k = false;          ///< k lies on the boundary line too
    };

    void lay_out(const Patch& patch, const DynamicFaces& faces, const Positions& rest);
    void assemble();
    bool solve(const Constraint& constraint);
    int number_unknowns(const Constraint& constraint);
    void fill_system(int unknowns);
    bool is_valid(const Constraint& constraint) const;
    bool runs_straight(const Constraint& constraint) const;
    bool triangles_are_sound() const;
    double distortion() const;
    void keep(Alias alias, Chart& chart) const;

    int count_ = 0; ///< vertices
    std::vector<Triangle> triangles_;
    std::array<double, most_vertices * most_vertices> real_, imaginary_; ///< the Hermitian matrix of E
    std::array<int, 2 * most_vertices> unknown_;                         ///< number of each coordinate, -1: prescribed
    std::array<double, 2 * most_vertices> coordinate_;                   ///< u and v of each vertex
    std::array<double, most_unknowns*(most_unknowns + 1)> system_;       ///< rows of unknowns, right side last
};

} // namespace plisse
