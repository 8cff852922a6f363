#pragma once

#include <cstdint>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// Where the line search compares: value + weight * share is exact for a script on its way, share being 1 where a drive
/// begins and shrinking by (1 - alpha) with each step.
struct ScriptPenalty {
    double share = 0;
    double weight = 0;

    double value() const { return weight * share; }
};

/// Leads prescribed unknowns to their targets, drive by drive. A drive moves them all at once, straight to their
/// targets. Where it is blocked the script rests until the free unknowns are at their minimum, and is then driven on.
/// When two drives in a row have been futile, each script (of one handle or obstacle) is driven once by itself, so that
/// those in nobody's way arrive, and then the script is given up.
class ScriptDrive {
public:
    /// script_of: the number of the script that each unknown follows, for prescribed ones; empty for a single one.
    ScriptDrive(const std::vector<std::uint8_t>& prescribed, const std::vector<int>& script_of);

    /// The step of the prescribed unknowns from x: 0 where they have arrived within the tolerance, and while the script
    /// rests. `remaining`: the largest distance of a vertex to its target, arrived or not.
    VecX step(const VecX& x, const VecX& targets, double tolerance);
    double remaining() const { return remaining_; }

    /// Whether prescribed unknowns move.
    bool drives() const { return penalty_.share > 0; }
    /// Whether it waits for the free unknowns to come to rest.
    bool waits() const { return state_ == State::waiting; }
    /// Whether the unknowns that have not arrived never will.
    bool gave_up() const { return state_ == State::given_up; }
    ScriptPenalty& penalty() { return penalty_; }

    /// The drive under way leads no further.
    void block();
    /// The free unknowns are at rest: the next drive begins.
    void go_on();

private:
    enum class State { driving, waiting, given_up };
    static constexpr int all = -1;
    static constexpr double futile_share = 0.9; ///< of its way that a futile drive leaves
    static constexpr int most_futile_drives = 2;

    bool is_driven(std::size_t unknown) const;
    void drive_next();

    const std::vector<std::uint8_t>& prescribed_;
    const std::vector<int>& script_of_;
    int script_count_ = 1;
    State state_ = State::driving;
    ScriptPenalty penalty_{1, 0};
    int driven_ = all; ///< the only script that is driven
    int futile_drives_ = 0;
    double remaining_ = 0;
};

} // namespace plisse
