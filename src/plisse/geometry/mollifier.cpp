#include <plisse/geometry/mollifier.h>

namespace plisse {

namespace {

constexpr double first_ratio = 0.25; // m is 1 below

} // namespace

EdgeMollifier::EdgeMollifier(const Separation& s, const Stencil& x, std::uint8_t ends) {
    separations_[0] = s;
    for (int i = 0; i < 4; ++i) {
        if ((ends >> i & 1) == 0 || s.squared_distance <= first_ratio * squared_distance_end(x, i))
            continue;
        const Separation end = separate_end(x, i);
        const double ratio = s.squared_distance / end.squared_distance;
        const double slope = 1 / (1 - first_ratio), q = std::min(1.0, (ratio - first_ratio) * slope);
        factors_[at(count_)] = {1 - q * q * q, -3 * q * q * slope, -6 * q * slope * slope};
        separations_[at(++count_)] = end;
        value_ *= 1 - q * q * q;
    }
}

/// Of the ends' factors, save those of ends i and j.
double EdgeMollifier::product_without(int i, int j) const {
    double product = 1;
    for (int k = 0; k < count_; ++k)
        if (k != i && k != j)
            product *= factors_[at(k)].value;
    return product;
}

DistanceFunction EdgeMollifier::function() const {
    // Column i: the derivatives of r_i = D / D_i by D, D_1, ...
    Eigen::Matrix<double, DistanceFunction::most, DistanceFunction::most - 1> ratio_slopes;
    ratio_slopes.setZero();
    DistanceFunction m(count_ + 1);
    const double d = separations_[0].squared_distance;
    for (int i = 0; i < count_; ++i) {
        const double end = separations_[at(i + 1)].squared_distance;
        ratio_slopes(0, i) = 1 / end;
        ratio_slopes(i + 1, i) = -d / (end * end);
        const double by_ratio = product_without(i, i) * factors_[at(i)].first;
        m.first += by_ratio * ratio_slopes.col(i).head(count_ + 1);
        m.second(0, i + 1) -= by_ratio / (end * end);
        m.second(i + 1, 0) -= by_ratio / (end * end);
        m.second(i + 1, i + 1) += 2 * by_ratio * d / (end * end * end);
    }
    for (int i = 0; i < count_; ++i)
        for (int j = 0; j < count_; ++j) {
            const double by_ratios = product_without(i, j) *
                                     (i == j ? factors_[at(i)].second : factors_[at(i)].first * factors_[at(j)].first);
            m.second +=
                by_ratios * ratio_slopes.col(i).head(count_ + 1) * ratio_slopes.col(j).head(count_ + 1).transpose();
        }
    return m;
}

} // namespace plisse
