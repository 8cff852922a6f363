#pragma once

#include <plisse/scene/scene.h>

namespace plisse {

/// The scripted motion that keyframes describe: a field left out keeps its last value. Before it is first given,
/// translate and rotate_deg are 0, and about is the first one given: a pivot says where to turn, not a way to go.
MotionTrack motion_track(const MotionSpec& spec);

} // namespace plisse
