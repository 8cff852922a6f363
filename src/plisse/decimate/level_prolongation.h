#pragma once

#include <plisse/decimate/hierarchy.h>
#include <plisse/transfer/prolongation.h>

namespace plisse {

/// P_l: from a level straight to the finest. level: below the finest. kind: loop needs a hierarchy by subdivision,
/// affine one by collapse.
Prolongation prolongation_to_finest(const Hierarchy& hierarchy, int level, ProlongationOperator kind);

/// P_l^(l+1): from a level to the next finer one. level: below the finest.
Prolongation prolongation_to_next(const Hierarchy& hierarchy, int level, ProlongationOperator kind);

} // namespace plisse
