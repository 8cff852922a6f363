#pragma once

#include <plisse/geometry/distance.h>

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
    /// s = separate_edges(x), and must outlive the object. ends: bit i is set for the ends that count.
    EdgeMollifier(const Separation& s, const Stencil& x, std::uint8_t ends = 0b1111);

    double value() const { return value_; } ///< m
    bool is_one() const { return count_ == 0; }
    Vec12 gradient() const; ///< dm/dX, 1/m
    Mat12 hessian() const;  ///< d2m/dX2, 1/m^2

private:
    /// An end that lowers m.
    struct End {
        Separation separation;
        double ratio = 0;                        ///< r_i
        double value = 0, first = 0, second = 0; ///< 1 - q_i^3 and its derivatives by r_i
    };
    double product_without(int i, int j) const;
    Vec12 ratio_gradient(const End& end) const;

    const Separation& separation_;
    std::array<End, 4> ends_;
    int count_ = 0;
    double value_ = 1;
};

} // namespace plisse
