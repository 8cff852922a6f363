#pragma once

#include <array>
#include <span>

#include <plisse/geometry/ccd.h>

namespace plisse {

/// Two primitives of which at least one vertex moves.
struct MovingPair {
    StencilKind kind;
    std::array<int, 4> vertices;
    auto operator<=>(const MovingPair&) const = default;
};

struct PairMotionOptions {
    double reference_gap = 1e-3; ///< m: pairs approach to half of it, and nearer ones hardly (PSQ algorithm 4)
    /// In shares of the way that is left: pairs that could go on by no more than this are stopped with the one that
    /// stops first. The larger, the fewer rounds.
    double grain = 0;
};

/// Moves vertices toward their targets so that no pair ever meets: all advance by the largest safe share, the pairs
/// that limit it stop their vertices, and so on until the rest arrive (PSQ section 4.4.4, algorithm 3). Returns how
/// many were stopped. rest: pairs nearer at rest than the reference gap may come as near again.
int move_apart(Positions& x, const Positions& targets, const Positions& rest, std::span<const int> movers,
               std::span<const MovingPair> pairs, const PairMotionOptions& options);

} // namespace plisse
