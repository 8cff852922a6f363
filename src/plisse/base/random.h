#pragma once

#include <cstdint>

namespace plisse {

/// SplitMix64 (Steele, Lea, Flood 2014): a seeded stream that gives the same numbers on every machine, which the
/// distributions of the standard library do not promise.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        state_ += 0x9e3779b97f4a7c15ULL;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31);
    }

    /// Uniform in [0, 1).
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    /// Uniform in [0, bound), bound > 0.
    int below(int bound) { return static_cast<int>(bits() % static_cast<std::uint64_t>(bound)); }

private:
    std::uint64_t state_;
};

} // namespace plisse
