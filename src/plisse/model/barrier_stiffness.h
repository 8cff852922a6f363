#pragma once

#include <plisse/model/model.h>

namespace plisse {

/// Barrier pressure scale, Pa: the pressure that a membrane of strain 0.1 exerts over a radius of 1/300 of a body of
/// this size (m), at most its bulk modulus. With the bulk modulus itself (C-IPC section 4), which a thin shell's
/// contacts are nowhere near, the barrier would act like a switch (docs/decisions/0009).
double barrier_stiffness(const Material& material, double size);

} // namespace plisse
