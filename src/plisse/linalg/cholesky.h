#pragma once

#include <plisse/linalg/front_plan.h>

namespace plisse {

/// Sparse Cholesky factorisation of a NewtonSystem by the multifrontal method, in numbers of type Scalar (float or
/// double), on all threads and with the same bits for any number of them.
template <typename Scalar>
class SparseCholesky {
public:
    SparseCholesky();

    /// Factorises H + shift I. False when that is not positive definite to the precision of Scalar. The plan is adapted
    /// to the system.
    bool factorize(const FrontPlan& plan, const NewtonSystem& system, double shift = 0);

    /// Solves for the rows of the system (3 per row; see NewtonSystem::gather). Needs a successful factorize, and its
    /// plan as it was.
    VecX solve(const FrontPlan& plan, const VecX& right_hand_side);

private:
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

    void assemble(const FrontPlan& plan, int front, const std::vector<Mat3>& blocks, double shift);
    void place_system_column(const FrontPlan& plan, int pivot, int stride, const std::vector<Mat3>& blocks);
    void add_update_column(const FrontPlan& plan, int child, std::size_t j, Scalar* column, int stride);
    bool eliminate(const FrontPlan& plan, int front);

    Vector panels_;  ///< of all fronts
    Vector updates_; ///< of all fronts
    Vector carried_; ///< of every entry of Elimination::reach, what a solve carries from front to front
};

/// The shift to try after one that was too small: a share of H's largest entry, or a multiple of the last shift. Throws
/// std::runtime_error where H is not finite, which none makes definite.
double larger_shift(const NewtonSystem& system, double shift, double first_share, double growth);

extern template class SparseCholesky<float>;
extern template class SparseCholesky<double>;

} // namespace plisse
