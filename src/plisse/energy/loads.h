#pragma once

#include <span>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// Dead loads: forces on vertices that do not follow the motion, N, one column a vertex. Their energy is -f . x.

/// Rest area of each vertex, m^2: a third of each of its faces.
VecX vertex_areas(const Positions& rest, std::span<const Face> faces);

/// Lumped masses, kg: a third of rho h A of each face. density (kg/m^3 of solid) and thickness (m): one a face.
VecX lumped_masses(const Positions& rest, std::span<const Face> faces, std::span<const double> density,
                   std::span<const double> thickness);

/// Adds each vertex's weight; gravity in m/s^2.
void add_weight(const VecX& masses, const Vec3& gravity, Positions& forces);

/// Adds a force of `total` N in all, shared out over distinct vertices by area (evenly where none has any).
void add_shared_force(const VecX& areas, std::span<const int> vertices, const Vec3& total, Positions& forces);

/// Adds a traction, Pa per rest area, on distinct vertices.
void add_traction(const VecX& areas, std::span<const int> vertices, const Vec3& traction, Positions& forces);

/// -f . x, J.
double dead_load_energy(const Positions& forces, const Positions& x);

} // namespace plisse
