#pragma once

#include <plisse/exports/animation.h>

#include "saved_run.h"

namespace plisse {

/// Which of a run's saved states an animation holds, and when it shows them.
struct AnimationChoice {
    int level = -1;          ///< below 0: the level with the most frames, the finest of several
    bool final_only = false; ///< final.ply and nothing else
    int every = 1;           ///< keep each frame whose place is a multiple of this, and the last
    double fps = 0;          ///< above 0: frames a second, evenly; else the timeline's own times, s
};

struct SavedAnimation {
    int level = 0;
    Animation animation; ///< reads its states from the run's folder as they are asked for
};

/// By the timeline's own times, a state saved at the time of the one before it (as settling does) follows it by the
/// usual interval. Throws InputError when there is nothing to show or a file is missing; so do the animation's states
/// when theirs is damaged.
SavedAnimation open_animation(const SavedRun& run, const AnimationChoice& choice);

} // namespace plisse
