#pragma once

#include <plisse/solve/quadratic_step.h>

namespace plisse {

/// Powell's dogleg, from zero over the Cauchy point to the Newton point, with the least shift of a ladder that makes
/// H + shift I definite. Unshifted, it stalls on an indefinite H. A shifted Newton point inside the radius is carried
/// on to it along the direction of negative curvature. H is factorised once, whatever the radii.
class DoglegStep : public QuadraticSolver {
public:
    void set_matrix(const NewtonSystem& matrix) override;
    QuadraticStep minimize(const VecX& gradient, double radius) override;

private:
    const NewtonSystem* matrix_ = nullptr;
    ShiftedCholesky factor_;
    double shift_ = 0;
    bool factorized_ = false;
};

/// The method of More and Sorensen (1983) in the form of Conn, Gould and Toint (2000), algorithm 7.3.4: a shift for
/// which s = -inverse(H + shift I) g is as long as the radius, found by Newton's method on 1/|s| between bounds; in the
/// hard case s is carried to the radius along the softest direction. m(s) is within 3 % of the minimum.
class ExactStep : public QuadraticSolver {
public:
    void set_matrix(const NewtonSystem& matrix) override;
    QuadraticStep minimize(const VecX& gradient, double radius) override;

private:
    QuadraticStep search(const VecX& gradient, double radius);

    const NewtonSystem* matrix_ = nullptr;
    ShiftedCholesky factor_;
    double largest_row_ = 0;  ///< no eigenvalue of H is beyond it
    double least_shift_ = -1; ///< H + shift I is indefinite for any below it; -1 where nothing is known
};

} // namespace plisse
