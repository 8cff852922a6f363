#pragma once

#include <memory>
#include <span>

#include <plisse/linalg/multigrid.h>

namespace plisse {

enum class QuadraticMethod {
    dogleg, ///< with a factor, shifted until it is definite
    exact,  ///< as near the true solution as a few factorisations bring it
    conjugate_gradients,
};
enum class Preconditioning { none, block_jacobi, block_gauss_seidel, multigrid };

/// In which norm steps are held within the radius.
enum class RadiusNorm {
    euclidean,
    preconditioner, ///< root of s'Ms, M being what the preconditioner inverts; conjugate gradients only
};

struct QuadraticOptions {
    QuadraticMethod method = QuadraticMethod::exact;
    Preconditioning preconditioning = Preconditioning::none; ///< of conjugate gradients
    RadiusNorm norm = RadiusNorm::euclidean;
    int max_iterations = 10; ///< of conjugate gradients, >= 1
    double tolerance =
        1e-3; ///< they end when the residual, in the norm of the preconditioner, has shrunk to this share
    MultigridOptions multigrid;
    /// Conjugate gradients whose preconditioner is built from a positive semi-definite approximation of H. Where the
    /// last step met no bound they work on the true H, elsewhere on the approximation: along negative curvature the
    /// model promises more than the value keeps, and the radius stays short.
    bool project = false;
};

/// A step s of the model m(s) = g's + s'Hs/2.
struct QuadraticStep {
    VecX s;
    double slope = 0;         ///< g's
    double curvature = 0;     ///< s'Hs
    double norm = 0;          ///< of s in the norm of the radius
    bool on_boundary = false; ///< norm is the radius, to rounding
    int iterations = 0;       ///< factorisations, or products with H
    double products = 0;      ///< what it cost in products with H, preconditioners' and solves by a factor included

    /// m(0) - m(alpha s).
    double decrease(double alpha = 1) const { return -alpha * (slope + 0.5 * alpha * curvature); }
};

/// Minimises g's + s'Hs/2 over |s| <= radius, H symmetric and perhaps indefinite. Whatever the method, the model
/// decreases at least as much as at the Cauchy point, its minimum along the steepest descent of the norm (Conn, Gould
/// and Toint 2000, sections 6.3 and 7.5).
class QuadraticSolver {
public:
    virtual ~QuadraticSolver() = default;
    /// H, kept by reference; called whenever it has changed.
    virtual void set_matrix(const NewtonSystem& matrix) = 0;
    /// Whether set_matrix is to be followed by set_definite, with a positive semi-definite approximation of H, kept by
    /// reference.
    virtual bool wants_definite() const { return false; }
    virtual void set_definite(const NewtonSystem&) {}
    /// For the rows of the system; radius > 0.
    virtual QuadraticStep minimize(const VecX& gradient, double radius) = 0;
};

/// prolongations: for the multigrid preconditioner, the coarsest first; kept by reference.
std::unique_ptr<QuadraticSolver> make_quadratic_solver(const QuadraticOptions& options,
                                                       std::span<const ScalarTransfer* const> prolongations = {});

/// The steps tau with |s + tau d| = radius, for ss = s.s, sd = s.d, dd = d.d in the norm; lower < 0 < upper.
struct BoundarySteps {
    double lower, upper;
};
BoundarySteps steps_to_boundary(double ss, double sd, double dd, double radius);

/// The minimum of the model along -g within the Euclidean radius.
QuadraticStep cauchy_step(const NewtonSystem& matrix, const VecX& gradient, double radius);

} // namespace plisse
