#pragma once

#include <vector>

namespace plisse {

/// When the states of an animation are shown, counted in frames of one length.
struct Playback {
    double rate = 24;          ///< frames per second: the inverse of the usual time between two states
    std::vector<double> codes; ///< of each state: its time in frames, whole where it is so but for round-off
};

Playback playback_of(const std::vector<double>& times);

} // namespace plisse
