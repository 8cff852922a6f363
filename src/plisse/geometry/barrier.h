#pragma once

#include <cmath>

namespace plisse {

/// The barrier b(X) = -(X - 1)^2 ln X, 0 from X = 1 on, of what is left of some room, relative to where it begins to
/// act (IPC, Li et al. 2020, equation 6, without its dimensions), and its derivatives. Contact's X is a squared
/// distance.
struct Barrier {
    double value = 0, first = 0, second = 0;
};

inline Barrier barrier(double x) {
    if (!(x < 1))
        return {};
    const double log = std::log(x), below = x - 1, ratio = below / x;
    return {-below * below * log, -2 * below * log - below * ratio, -2 * log - 4 * ratio + ratio * ratio};
}

} // namespace plisse
