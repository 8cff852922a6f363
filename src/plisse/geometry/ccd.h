#pragma once

#include <plisse/geometry/distance.h>

namespace plisse {

/// Which two primitives a stencil holds.
enum class StencilKind : std::uint8_t { point_triangle, edge_edge };

inline Separation separate(StencilKind kind, const Stencil& x) {
    return kind == StencilKind::point_triangle ? separate_point_triangle(x) : separate_edges(x);
}

inline double squared_distance(StencilKind kind, const Stencil& x) {
    return kind == StencilKind::point_triangle ? squared_distance_point_triangle(x) : squared_distance_edges(x);
}

/// A lower bound on the largest t in [0, end] such that two primitives moving from x to x + t * d stay apart by at
/// least `gap` at every moment; `end` itself when they do so all the way. Tight to `ccd_tolerance` of the distance they
/// may lose. When they start at `gap` or nearer, the bound is 0 unless nothing moves relative to each other.
///
/// Additive continuous collision detection (ACCD; C-IPC, Li et al. 2021, section 5) with a longer step. ACCD goes from
/// distance D by (D - gap) / L, where L bounds the relative speed. Here the unit vector n between the closest points
/// bounds the distance at all times: it is at least the least of n.(a - b) over corners a, b of the two primitives, and
/// each of these is linear in time. The step up to the first of them that reaches `gap` is never shorter than ACCD's,
/// and sliding along each other costs nothing. Common motion drops out. The bound holds for any n, and nothing else is
/// relied on: errors in the distance and the closest points cost steps and never safety. Where n has lost its digits
/// the direction square to both primitives is tried too. Round-off in positions and products is added to `gap`.
double safe_step(StencilKind kind, const Stencil& x, const Stencil& d, double gap, double end = 1);

/// Whether safe_step is sure to return `end`, judged by the distance at the start and the relative speed alone. The
/// distance is that of separate or squared_distance, which coordinates beyond 1e40 m or below 1e-40 m leave undefined.
bool keeps_apart(StencilKind kind, const Stencil& x, const Stencil& d, double distance, double gap, double end = 1);

/// Share of (starting distance - gap) that safe_step may leave unused.
inline constexpr double ccd_tolerance = 1e-6;

} // namespace plisse
