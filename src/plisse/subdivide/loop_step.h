#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <plisse/base/types.h>
#include <plisse/transfer/prolongation.h>

namespace plisse {

/// What a surface is apart from where its vertices are.
struct LabelledSurface {
    std::vector<Face> faces;
    std::vector<int> part;  ///< per vertex: number of its body or obstacle, ascending
    std::vector<int> label; ///< per vertex: -1 free, else pinned
};

/// The label of a vertex in the middle of an edge whose ends have these labels; -1: it is free.
using LabelBetween = std::function<int(int, int)>;

/// One subdivision of a surface.
struct LoopStep {
    LabelledSurface fine;
    ProlongationWeights weights;  ///< one row for every fine vertex, one column for every coarse one; rows sum to 1
    std::vector<int> fine_number; ///< per coarse vertex: its number on the fine surface
    std::vector<int> parent;      ///< per fine face: the coarse face it is a part of
    std::vector<Mat3> corners; ///< per fine face: column k holds the barycentric weights of its corner k in the parent
};

/// Loop's subdivision (Loop 1987) with a fixed boundary, as in progressive cloth simulation (PSQ section 3.3): every
/// face becomes four, by a new vertex on each of its edges.
/// - An edge between two faces is smooth: its new vertex is at 3/8 of each end and 1/8 of each corner opposite. So is a
///   vertex all of whose edges are: of n neighbours, it goes to 1 - n b of itself and b of each neighbour,
///   b = (5/8 - (3/8 + cos(2 pi / n) / 4)^2) / n; 5/8 and 1/16 where n is 6.
/// - Everything else is kept as it is: a boundary edge (and one of three or more faces) takes the midpoint, and its
///   ends stay. So a boundary is the same line on all levels, with its corners and its length, and two surfaces sewn to
///   the same line stay so. Loop's own rule for boundaries would round corners off and draw hems inward.
/// - A pinned vertex stays, and an edge with a label between its ends takes the midpoint, which has that label: the new
///   places of what is prescribed depend on prescribed ones alone, by averages that rigid motions keep.
/// - Vertices that no face uses, and all of kept parts, stay; faces of kept parts are not divided.
/// All weights are >= 0, so no vertex leaves the hull of the coarse ones around it.
///
/// Order of vertices: part by part, first the coarse ones as they were, then those on edges by the numbers of their
/// edges' ends. Order of faces: the parts of face 0, of face 1 ..., each first the three at its corners, then the one
/// in the middle. kept_part: per part; empty: none.
LoopStep loop_step(const LabelledSurface& coarse, const std::vector<std::uint8_t>& kept_part,
                   const LabelBetween& label_between);

} // namespace plisse
