#pragma once

#include <optional>

namespace plisse {

/// What minimises a step of the method rmtr: the method itself, and those it is compared with.
enum class SurfaceSolver {
    rmtr,          ///< recursive multilevel trust region
    trust_region,  ///< on the finest level alone, with a factorised Hessian
    newton,        ///< Newton's method with line search on the finest level
    damped_newton, ///< full steps of it, times a factor of 0.3
    linearised     ///< one such step, not damped
};

/// What smooths on the levels of rmtr: conjugate gradients with a preconditioner.
enum class SurfaceSmoother {
    plain,        ///< without one: the paper's
    block_jacobi, ///< by the 3x3 diagonal blocks
    gauss_seidel, ///< by a symmetric sweep over them
    multigrid     ///< by a linear V-cycle over the levels below
};

/// How points of a fine level are taken to a coarser one.
enum class SurfaceProjection { reverse_subdivision, least_squares };

/// What bounds smoothing steps and coarse corrections of rmtr.
enum class SurfaceRadii {
    separate, ///< a radius of its own for each; corrections rest after rejections
    single    ///< one for both: the paper's
};

/// Of the method rmtr.
struct RmtrSettings {
    SurfaceSolver solver = SurfaceSolver::rmtr;
    SurfaceSmoother smoother = SurfaceSmoother::block_jacobi; ///< between the finest and the coarsest level
    SurfaceSmoother finest_smoother = SurfaceSmoother::multigrid;
    SurfaceProjection projection = SurfaceProjection::reverse_subdivision;
    SurfaceRadii radii = SurfaceRadii::separate;
    bool boundary_variables = true; ///< points of the boundary curve instead of ghost points
    bool nested_iteration = true;   ///< each coarser level is solved first, for a start
    /// Of what holds a boundary, N/m^3; empty: h^-5 in SI units, h being the finest level's mean side (RMTR
    /// section 7.1).
    std::optional<double> penalty;
    int thickness_points = 3; ///< Gauss points over the thickness, 3 or 5
    int max_cycles = 2000;    ///< of a step
};

} // namespace plisse
