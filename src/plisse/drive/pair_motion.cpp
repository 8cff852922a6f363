#include <plisse/drive/pair_motion.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

Stencil gather(const std::array<int, 4>& vertices, const auto& column) {
    Stencil stencil;
    for (int k = 0; k < 4; ++k)
        stencil.col(k) = column(vertices[at(k)]);
    return stencil;
}

/// How much of its distance a pair keeps while it moves: less than half of the reference gap would start the solver
/// where the barrier is so stiff that it cuts step after step.
double kept_gap(double distance, double reference_gap) {
    return std::min(0.9 * distance, std::max(0.1 * distance, 0.5 * reference_gap));
}

class PairMotion {
public:
    PairMotion(Positions& x, const Positions& targets, const Positions& rest, std::span<const int> movers,
               std::span<const MovingPair> pairs, const PairMotionOptions& options)
        : x_(x), movers_(movers), grain_(options.grain) {
        std::unordered_map<int, int> mover_of;
        for (int v : movers) {
            mover_of[v] = static_cast<int>(remaining_.size());
            remaining_.emplace_back(targets.col(v) - x.col(v));
        }
        motions_.reserve(pairs.size());
        for (const MovingPair& pair : pairs) {
            Motion motion{pair, {}, 0, 0, 1};
            for (std::size_t k = 0; k < 4; ++k) {
                const auto found = mover_of.find(pair.vertices[k]);
                motion.movers[k] = found == mover_of.end() ? -1 : found->second;
            }
            const Stencil at_rest = gather(pair.vertices, [&](int v) -> Vec3 { return rest.col(v); });
            motion.reference_gap = std::min(options.reference_gap, std::sqrt(squared_distance(pair.kind, at_rest)));
            motions_.push_back(motion);
        }
    }

    /// Advances until every vertex has arrived or is stopped; returns how many were stopped.
    int run() {
        int stopped = 0;
        for (;;) {
            double least = 1;
            for (Motion& motion : motions_) {
                motion.limit = limit_of(motion, std::min(1.0, least * (1 + 2 * same) + 2 * grain_));
                least = std::min(least, motion.limit);
            }
            advance(least);
            if (least == 1)
                return stopped;
            stopped += stop(least);
        }
    }

private:
    static constexpr double same = 1e-6; ///< limits that differ by no more than this share are reached together

    struct Motion {
        MovingPair pair;
        std::array<int, 4> movers; ///< of its vertices, -1 for one that does not move
        double reference_gap = 0;  ///< m
        double least_distance = 0; ///< m: it is no nearer now
        double limit = 1;
    };

    Vec3 displacement(int mover) const { return mover < 0 ? Vec3::Zero() : remaining_[at(mover)]; }

    /// A bound on how much nearer the two come on the whole of their way, m.
    double approach(const Motion& motion) const {
        double squared = 0;
        for (int mover : motion.movers)
            if (mover >= 0)
                squared = std::max(squared, remaining_[at(mover)].squaredNorm());
        return 2 * std::sqrt(squared);
    }

    /// The share of its way up to which a pair is safe, `end` if that is less.
    double limit_of(Motion& motion, double end) const {
        const double nearer = approach(motion) * end;
        if (nearer == 0)
            return 1;
        // Far pairs keep more than kept_gap() can ask for.
        if (nearer <= 0.5 * motion.least_distance && motion.least_distance - nearer >= 0.5 * motion.reference_gap)
            return end;
        const StencilKind kind = motion.pair.kind;
        const Stencil x = gather(motion.pair.vertices, [&](int v) -> Vec3 { return x_.col(v); });
        const Stencil d = gather(motion.movers, [&](int mover) { return displacement(mover); });
        motion.least_distance = std::sqrt(squared_distance(kind, x));
        const double kept = kept_gap(motion.least_distance, motion.reference_gap);
        return keeps_apart(kind, x, d, motion.least_distance, kept, end) ? end : safe_step(kind, x, d, kept, end);
    }

    void advance(double share) {
        for (Motion& motion : motions_)
            motion.least_distance -= share * approach(motion);
        for (std::size_t m = 0; m < movers_.size(); ++m) {
            x_.col(movers_[m]) += share * remaining_[m];
            remaining_[m] *= 1 - share;
        }
    }

    /// Stops the vertices of the pairs that have reached their limit; returns how many.
    int stop(double limit) {
        int stopped = 0;
        for (const Motion& motion : motions_)
            if (motion.limit < 1 && motion.limit <= limit * (1 + same) + grain_)
                for (int mover : motion.movers)
                    if (mover >= 0 && !remaining_[at(mover)].isZero(0)) {
                        remaining_[at(mover)].setZero();
                        ++stopped;
                    }
        return stopped;
    }

    Positions& x_;
    std::span<const int> movers_;
    double grain_;
    std::vector<Vec3> remaining_; ///< per mover
    std::vector<Motion> motions_;
};

} // namespace

int move_apart(Positions& x, const Positions& targets, const Positions& rest, std::span<const int> movers,
               std::span<const MovingPair> pairs, const PairMotionOptions& options) {
    return PairMotion(x, targets, rest, movers, pairs, options).run();
}

} // namespace plisse
