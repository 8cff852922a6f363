#pragma once

#include <plisse/base/types.h>

namespace plisse {

/// Polar decomposition F = R S of a 3x2 deformation gradient, with the unit normal n of the deformed triangle.
/// R has orthonormal columns, S is symmetric positive definite; n = R.col(0) x R.col(1).
struct PolarFrame {
    Mat32 rotation;       ///< R
    Vec3 normal;          ///< n
    Mat2 stretch_inverse; ///< S^-1
    double stretch_trace; ///< tr S
};

/// Closed form without an SVD: S = (C + sqrt(det C) I) / sqrt(tr C + 2 sqrt(det C)) with C = F^T F. A degenerate F (det
/// C vanishing against its trace) still gets an orthonormal frame, whose S^-1 is that of the nearest regular F.
PolarFrame polar_frame(const Mat32& deformation_gradient);

} // namespace plisse
