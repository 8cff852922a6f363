#pragma once

namespace plisse {

constexpr int most_friction_updates = 30; ///< of the normal forces, in one step

/// How much of its normal forces an update of friction replaces: all, then halves, lest forces and positions chase each
/// other in circles.
constexpr double friction_share(int update) {
    constexpr int most_whole_updates = 5;
    return update < most_whole_updates ? 1 : 0.5;
}

} // namespace plisse
