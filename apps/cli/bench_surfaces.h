#pragma once

#include <array>

#include <plisse/model/subdivision_model.h>

namespace plisse {

/// The experiments of Kopanicakova, Krause and Tamstorf (2019, section 7): a square metre of denim, flat at first,
/// falls for a step.
enum class Scenario {
    trampoline,       ///< all four sides are held
    drooping,         ///< two neighbouring sides
    reentrant_corner, ///< the sides of a square of 0.3 m that is cut out of a corner
    drape,            ///< two neighbouring corners, which move together by 0.2 m each in a second
};
inline constexpr std::array scenarios{Scenario::trampoline, Scenario::drooping, Scenario::reentrant_corner,
                                      Scenario::drape};
const char* scenario_name(Scenario scenario);

/// On 4 x 4 faces (one fewer with the corner cut out), subdivided levels - 1 times; the scenes of examples/rmtr.
/// boundary_variables: as in RmtrSettings.
SubdivisionModel scenario_model(Scenario scenario, int levels, bool boundary_variables = true);

} // namespace plisse
