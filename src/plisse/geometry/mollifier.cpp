#include <plisse/geometry/mollifier.h>

namespace plisse {

namespace {

constexpr double first_ratio = 0.25; // m is 1 below

} // namespace

EdgeMollifier::EdgeMollifier(const Separation& s, const Stencil& x, std::uint8_t ends) : separation_(s) {
    for (int i = 0; i < 4; ++i) {
        if ((ends >> i & 1) == 0 || s.squared_distance <= first_ratio * squared_distance_end(x, i))
            continue;
        const Separation end = separate_end(x, i);
        const double ratio = s.squared_distance / end.squared_distance;
        const double slope = 1 / (1 - first_ratio), q = std::min(1.0, (ratio - first_ratio) * slope);
        ends_[static_cast<std::size_t>(count_++)] = {end, ratio, 1 - q * q * q, -3 * q * q * slope,
                                                     -6 * q * slope * slope};
        value_ *= 1 - q * q * q;
    }
}

/// Of the ends' factors, save those of ends i and j.
double EdgeMollifier::product_without(int i, int j) const {
    double product = 1;
    for (int k = 0; k < count_; ++k)
        if (k != i && k != j)
            product *= ends_[static_cast<std::size_t>(k)].value;
    return product;
}

Vec12 EdgeMollifier::ratio_gradient(const End& end) const {
    return (squared_distance_gradient(separation_) - end.ratio * squared_distance_gradient(end.separation)) /
           end.separation.squared_distance;
}

Vec12 EdgeMollifier::gradient() const {
    Vec12 gradient = Vec12::Zero();
    for (int i = 0; i < count_; ++i) {
        const End& end = ends_[static_cast<std::size_t>(i)];
        gradient += product_without(i, i) * end.first * ratio_gradient(end);
    }
    return gradient;
}

Mat12 EdgeMollifier::hessian() const {
    Mat12 hessian = Mat12::Zero();
    for (int i = 0; i < count_; ++i) {
        const End& end = ends_[static_cast<std::size_t>(i)];
        const Vec12 by_ratio = ratio_gradient(end);
        // r D_i = D, differentiated twice.
        const Mat12 mixed = by_ratio * squared_distance_gradient(end.separation).transpose();
        const Mat12 ratio_hessian = (squared_distance_hessian(separation_) -
                                     end.ratio * squared_distance_hessian(end.separation) - mixed - mixed.transpose()) /
                                    end.separation.squared_distance;
        hessian += product_without(i, i) * (end.first * ratio_hessian + end.second * by_ratio * by_ratio.transpose());
        for (int j = 0; j < i; ++j) {
            const End& other = ends_[static_cast<std::size_t>(j)];
            const Mat12 both = by_ratio * ratio_gradient(other).transpose();
            hessian += product_without(i, j) * end.first * other.first * (both + both.transpose());
        }
    }
    return hessian;
}

} // namespace plisse
