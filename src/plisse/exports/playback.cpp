#include <plisse/exports/playback.h>

#include <algorithm>
#include <cmath>

namespace plisse {

namespace {

constexpr double epsilon = 1e-6; ///< relative: round-off of times that were added up

double rounded_if_close(double value) {
    const double whole = std::round(value);
    return std::abs(value - whole) <= epsilon * std::max(1.0, std::abs(value)) ? whole : value;
}

} // namespace

Playback playback_of(const std::vector<double>& times) {
    Playback result;
    std::vector<double> gaps;
    for (std::size_t k = 1; k < times.size(); ++k)
        gaps.push_back(times[k] - times[k - 1]);
    if (!gaps.empty()) {
        const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
        std::nth_element(gaps.begin(), middle, gaps.end());
        result.rate = rounded_if_close(1 / *middle);
    }
    for (double t : times)
        result.codes.push_back(rounded_if_close(t * result.rate));
    return result;
}

} // namespace plisse
