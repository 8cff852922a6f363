#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <plisse/base/context.h>
#include <plisse/decimate/hierarchy.h>

namespace plisse {

/// What is decimated: all bodies and obstacles in one mesh.
struct DecimationInput {
    const Positions& rest;       ///< m
    std::span<const Face> faces; ///< of the finest level
    std::span<const int> part;   ///< per vertex: number of its body or obstacle; an edge joins like with like
    std::span<const int> label;  ///< per vertex: -1 free, else the handle it belongs to; empty: all free
    std::span<const std::uint8_t> frozen_part; ///< per part: not decimated; empty: none
};

struct DecimationOptions {
    int levels = 3; ///< meshes, the input included, >= 1
    int coarsest_vertices =
        500; ///< over all decimated parts that are no obstacles (obstacles when there are no others)
    /// Per part: an obstacle, which shrinks from level to level by the same ratio as the others do together. Pairs of
    /// obstacles may intersect. Empty: none.
    std::vector<std::uint8_t> obstacle_part;

    double normal_sigma = 0.1;  ///< s_n of the probabilistic quadrics; 0.25 where element quality matters more
    double point_sigma = 0.05;  ///< s_p, in mean edge lengths
    double corner_angle = 60;   ///< degrees: a boundary vertex that turns by more stays where it is
    double least_cosine = 0.25; ///< between a face's normals before and after a collapse
    double least_quality = 0.1; ///< q of new faces, unless they were worse than twice that before
    int most_neighbours = 24;   ///< of a vertex, <= 24
    double cost_jitter = 0.2;   ///< relative; shortens the chains of dependent collapses
    std::uint64_t seed = 1;     ///< of the jitter

    bool test_intersections = true; ///< refuse collapses that bring new intersections or too small gaps
    /// In edge lengths of the new faces: they come no nearer than this to faces that share no vertex with them, unless
    /// they were nearer before.
    double least_gap = 0.05;
};

/// Why an edge was not collapsed.
enum class Rejection { topology, handle, fold, quality, flattening, intersection, gap };
inline constexpr int rejection_count = 7;
const char* rejection_name(Rejection rejection);

/// What came of a decimation.
struct DecimationSummary {
    std::vector<int> wanted_vertices;              ///< per level, of the counted parts
    std::vector<int> reached_vertices;             ///< per level, of the counted parts
    std::array<int, rejection_count> rejections{}; ///< tries, not edges
    bool ran_dry = false;                          ///< no edge could be collapsed any more above coarsest_vertices
    bool topology_kept = true; ///< Euler characteristic, components, boundary and graph of sheets equal on all levels
    long relocations = 0;      ///< of points, from one face to another
    int location_errors = 0;   ///< points found outside the new faces by more than round-off: 0 unless there is a fault
    double worst_location = 0; ///< smallest barycentric weight ever met, <= 0
    double collapse_seconds = 0, map_seconds = 0, total_seconds = 0;
};

/// Builds nested levels by quadric edge collapse (PSQ section 4.1; Garland and Heckbert 1997, Trettner and Kobbelt
/// 2020), with each finer vertex's anchor by joint flattening (Liu et al. 2021) and the batches in which collapses are
/// undone (PSQ section 4.4.4). Level sizes fall geometrically; when the queue runs dry early they are spread over what
/// was reached. Joints of more than two faces keep their shape as boundaries do. Faces without area, pinched vertices
/// and faces turned opposite ways keep their neighbourhood. Vertices no face uses appear on the finest level only.
///
/// The same input gives the same bits. A cancelled context ends the decimation early with a complete hierarchy.
Hierarchy decimate(const DecimationInput& input, const DecimationOptions& options, Context* context = nullptr,
                   DecimationSummary* summary = nullptr);

} // namespace plisse
