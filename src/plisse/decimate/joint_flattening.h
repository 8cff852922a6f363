#pragma once

#include <array>
#include <vector>

#include <plisse/decimate/patch.h>

namespace plisse {

/// Which end of an edge the merged vertex coincides with.
enum class Alias { none, i, j };

/// Common parameter plane of a patch before and after its collapse, for each sheet of it: U_i = (0, 0), U_j = (1, 0).
struct Chart {
    Alias alias = Alias::none; ///< U_k is exactly U_i or U_j
    Vec2 k = Vec2::Zero();
    std::vector<Vec2> ring; ///< in the order of the patch's places
};

/// Flattens the faces before and after a collapse together, so that both cover one polygon and the plane maps either
/// onto the other one to one (Liu et al. 2021). Least squares conformal energy over the triangles of both,
///     E = sum |sum_c W_c U_c|^2 / (2 A),  U = u + iv,  W = (z2 - z1, z0 - z2, z1 - z0),
/// z a triangle laid out at true size. Where the edge is on a curve, the curve stays on the line v = 0. The sheets that
/// end there each have a plane of their own, but one parameter u along the curve, so that what is mapped in one sheet
/// fits what is mapped in the others.
class JointFlattening {
public:
    static constexpr int most_ring = 24;
    static constexpr int most_places = 40;

    /// alias: the end whose position k took, if it did (as it must when only that end is on a curve). Rest positions
    /// are by vertex id, k's included. False when no chart is valid: all triangles positive and not slivers, angles
    /// around i, j and k in a sheet at most a full turn.
    bool flatten(const Patch& patch, const DynamicFaces& faces, const Positions& rest, Alias alias, Chart& chart);

private:
    static constexpr int most_vertices = most_places + 3;
    static constexpr int most_unknowns = 2 * (most_places + 1);

    struct Triangle {
        std::array<int, 3> corner; ///< 0 = i, 1 = j, 2 = k, 3 + n = place n
        int sheet;
        double length, x, y; ///< laid out as (0, 0), (length, 0), (x, y)
    };
    /// What is prescribed beside the places of i and j.
    struct Constraint {
        Alias alias = Alias::none;
        bool straight_i = false, straight_j = false; ///< the curve runs straight on beyond the end, v = 0
        bool straight_k = false;                     ///< k lies on the line too
    };

    void lay_out(const Patch& patch, const DynamicFaces& faces, const Positions& rest);
    void find_beyond(const Patch& patch);
    void assemble();
    bool solve(const Constraint& constraint);
    int number_unknowns(const Constraint& constraint);
    void fill_system(int unknowns);
    bool is_valid(const Constraint& constraint);
    bool runs_straight(const Constraint& constraint) const;
    bool triangles_are_sound();
    double distortion() const;
    void keep(Alias alias, Chart& chart) const;

    int count_ = 0; ///< i, j, k and the places
    int sheet_count_ = 0;
    std::vector<Triangle> triangles_;
    std::vector<int> beyond_i_, beyond_j_; ///< where the next vertices on the curve are in the sheets
    std::vector<double> angles_;           ///< around i, j and k in each sheet
    std::array<double, most_vertices * most_vertices> real_, imaginary_; ///< the Hermitian matrix of E
    std::array<int, 2 * most_vertices> unknown_;                         ///< number of each coordinate, -1: prescribed
    std::array<double, 2 * most_vertices> coordinate_;                   ///< u and v of each vertex
    std::array<double, most_unknowns*(most_unknowns + 1)> system_;       ///< rows of unknowns, right side last
};

} // namespace plisse
