#pragma once

#include <plisse/geometry/distance_function.h>

namespace plisse {

/// Takes from the energy of two edges what vertices and faces see too: where the edges cross near the end of one of
/// them, the point there repels by itself, and parallel edges have no closest points of their own. With the squared
/// distances D of the edges and D_i of each end i and the other edge,
///   m = prod_i (1 - q_i^3),   q_i = max(0, r_i - 1/4) / (3/4),   r_i = D / D_i in [0, 1].
/// m is 1 where all ends are twice as far away as the edges are, and runs to 0 without a kink where an end becomes the
/// nearest point, as on edges that turn parallel: the distance's own kinks lie where m is 0. An energy that tends to
/// infinity as D does to 0 still does so times m, unless a D_i tends to 0 too.
class EdgeMollifier {
public:
    /// s = separate_edges(x). ends: bit i is set for the ends that count.
    EdgeMollifier(const Separation& s, const Stencil& x, std::uint8_t ends = 0b1111);

    double value() const { return value_; } ///< m
    /// What m depends on: first D, then the D_i of the ends that lower it.
    std::span<const Separation> separations() const { return {separations_.data(), at(count_ + 1)}; }
    /// m as a function of these.
    DistanceFunction function() const;

private:
    /// The factor 1 - q^3 of an end as a function of its ratio r.
    struct Factor {
        double value, first, second;
    };
    static std::size_t at(int index) { return static_cast<std::size_t>(index); }
    double product_without(int i, int j) const;

    std::array<Separation, DistanceFunction::most> separations_;
    std::array<Factor, DistanceFunction::most - 1> factors_; ///< of separations_[1], ...
    int count_ = 0;                                          ///< ends that lower m
    double value_ = 1;
};

} // namespace plisse
