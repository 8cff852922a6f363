#pragma once

#include <memory>

#include <plisse/solve/objective.h>
#include <plisse/solve/quadratic_step.h>

namespace plisse {

/// Constants of trust regions (Kopanicakova, Krause and Tamstorf 2019, table 2).
struct TrustRegionConstants {
    double eta1 = 0.1;        ///< a step is accepted where the ratio of actual to predicted decrease is above it
    double eta2 = 0.75;       ///< and its radius grows where it is above this
    double gamma1 = 0.5;      ///< largest factor of the radius after a rejection, in (0, 1)
    double least_gamma = 0.5; ///< and the least one, in (0, gamma1]: between, it goes by interpolation
    double gamma2 = 2;        ///< and after a very good step, > 1
    double noise = 1e-13;     ///< decreases below this share of max(1e-3, |f|) say nothing, and count as agreeing
};

/// Ratio of actual to predicted decrease; 1 where both are below the noise, -infinity where it makes no sense.
double agreement(double actual, double predicted, double noise);

/// What became of one trial step.
struct TrialStep {
    bool accepted = false;
    double ratio = 0;
    double radius = 0; ///< within which it was sought
    double norm = 0;   ///< in the norm of the radius, before max_step cut it
    double length = 0; ///< Euclidean, of the step as tried
    double actual = 0, predicted = 0;
    double slope = 0; ///< g's, of the step as tried; 0 where it is not known
    bool on_boundary = false;
    bool cut = false;      ///< by max_step
    bool in_noise = false; ///< the decrease is too small to be told from rounding
    int quadratic_iterations = 0;
};

/// The radius after a trial. After a rejection steps inside the radius would come again until it is smaller than they
/// are, so these rounds are left out.
double next_radius(const TrustRegionConstants& constants, double radius, const TrialStep& trial);

/// A point x of h(x) = f(x) + <dg, x - x0> with the value, the gradient and the Hessian there, and trust-region steps
/// from it. dg is zero on the finest level; elsewhere it makes the gradient of h at x0 the restricted one of the finer
/// level (first-order consistency, equations (4.3)-(4.5)). Prescribed unknowns stay where they are.
class TrustRegionIterate {
public:
    /// Both are kept by reference; nobody else may assemble into the objective's system in between.
    TrustRegionIterate(Objective& objective, QuadraticSolver& solver, const TrustRegionConstants& constants)
        : objective_(objective), solver_(solver), constants_(constants) {}

    /// Begins at x0 with dg = 0.
    void start(VecX x0);
    /// Begins at x0 with the gradient given there.
    void start(VecX x0, const VecX& gradient);

    const VecX& x() const { return x_; }
    const VecX& start_point() const { return x0_; }
    double value() const { return value_; }
    double start_value() const { return start_value_; }
    const VecX& gradient() const { return gradient_; }
    double gradient_norm() const { return gradient_.norm(); }

    /// h at any x, counted; infinite where it is not a number.
    double value_at(const VecX& x);
    /// The noise in values near this one.
    double noise(double value) const;

    /// One trust-region trial; x moves if it is accepted. radius > 0.
    TrialStep step(double radius);
    void move_to(VecX x, double value);

    Objective& objective() { return objective_; }
    const TrustRegionConstants& constants() const { return constants_; }
    int evaluations() const { return evaluations_; }
    int assemblies() const { return assemblies_; }
    int quadratic_solves() const { return quadratic_solves_; }
    /// What they cost (see QuadraticStep).
    double quadratic_products() const { return quadratic_products_; }

private:
    void begin(VecX x0);
    void update_gradient();
    void update_matrix();
    VecX free_part(const VecX& vertices) const;

    Objective& objective_;
    QuadraticSolver& solver_;
    const TrustRegionConstants& constants_;
    VecX x_, x0_, gradient_;
    VecX tilt_;                              ///< dg; empty where it is zero
    std::unique_ptr<NewtonSystem> definite_; ///< for the preconditioner, where the solver wants it
    double value_ = 0, start_value_ = 0;
    bool matrix_is_current_ = false;
    bool near_ = false; ///< the last accepted step met no bound
    int evaluations_ = 0, assemblies_ = 0, quadratic_solves_ = 0;
    double quadratic_products_ = 0;
};

} // namespace plisse
