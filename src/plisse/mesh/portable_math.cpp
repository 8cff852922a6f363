#include <plisse/mesh/portable_math.h>

namespace plisse {

namespace {

/// Taylor polynomials; the first term left out is below 2^-60 for 0 <= x <= pi/4.
double small_sin(double x) {
    const double y = x * x;
    double sum = 1;
    for (int k = 17; k > 1; k -= 2)
        sum = 1 - y * sum / ((k - 1) * k);
    return x * sum;
}

double small_cos(double x) {
    const double y = x * x;
    double sum = 1;
    for (int k = 18; k > 0; k -= 2)
        sum = 1 - y * sum / ((k - 1) * k);
    return sum;
}

} // namespace

CosSin cos_sin_turns(double turns) {
    const double half_root = std::sqrt(0.5);
    double part = turns - std::floor(turns); // [0, 1]
    const bool below = part > 0.5;
    if (below)
        part = 1 - part;
    const bool left = part > 0.25;
    if (left)
        part = 0.5 - part;
    const bool steep = part > 0.125;
    const double angle = 2 * pi * (steep ? 0.25 - part : part);
    if (part == 0.125)
        return {left ? -half_root : half_root, below ? -half_root : half_root};
    const double c = steep ? small_sin(angle) : small_cos(angle);
    const double s = steep ? small_cos(angle) : small_sin(angle);
    return {left ? -c : c, below ? -s : s};
}

} // namespace plisse
