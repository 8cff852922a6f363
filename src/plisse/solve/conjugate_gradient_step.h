#pragma once

#include <plisse/solve/quadratic_step.h>

namespace plisse {

/// Truncated conjugate gradients (Steihaug 1983, Toint 1981; Conn, Gould and Toint 2000, algorithm 7.5.1): they end
/// where they leave the radius, and follow a direction of negative curvature to it.
///
/// In the preconditioner's norm iterates grow steadily, so the end is well placed. In the Euclidean norm they are cut
/// where they first leave the ball, and what is best in the plane of that step and the gradient is taken.
class ConjugateGradientStep : public QuadraticSolver {
public:
    /// preconditioner: null for none.
    ConjugateGradientStep(const QuadraticOptions& options, std::unique_ptr<Preconditioner> preconditioner);
    void set_matrix(const NewtonSystem& matrix) override;
    bool wants_definite() const override { return preconditioner_ && options_.project; }
    void set_definite(const NewtonSystem& matrix) override { preconditioner_->set_matrix(matrix); }
    QuadraticStep minimize(const VecX& gradient, double radius) override;

private:
    QuadraticStep iterate(const VecX& gradient, double radius, const Preconditioner* preconditioner) const;

    QuadraticOptions options_;
    std::unique_ptr<Preconditioner> preconditioner_;
    const NewtonSystem* matrix_ = nullptr;
};

} // namespace plisse
