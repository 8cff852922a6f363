#pragma once

#include <memory>
#include <span>
#include <vector>

#include <plisse/linalg/cholesky.h>
#include <plisse/linalg/preconditioner.h>
#include <plisse/linalg/triple_product.h>

namespace plisse {

enum class Smoother { block_jacobi, block_gauss_seidel, chebyshev };

struct MultigridOptions {
    Smoother smoother = Smoother::block_gauss_seidel;
    int steps = 1;  ///< before and after each coarse correction, >= 1
    int degree = 3; ///< of the Chebyshev smoother, >= 1
};

/// H + shift I in double precision, with a shift that makes it definite.
class ShiftedCholesky {
public:
    /// False where H + shift I is not positive definite.
    bool try_factorize(const NewtonSystem& matrix, double shift);
    /// Raises the shift from 0 by factors until the factorisation succeeds, and returns it.
    double factorize(const NewtonSystem& matrix);
    VecX solve(const VecX& right_hand_side) { return cholesky_.solve(plan_, right_hand_side); }

private:
    FrontPlan plan_;
    SparseCholesky<double> cholesky_;
};

/// One linear V-cycle from zero. Coarse matrices are S'HS; the coarsest is factorised, shifted where it is indefinite.
/// Before and after the coarse correction the same symmetric smoother M works, so the cycle is symmetric; it is
/// positive definite as long as 2 M - H is, which holds for indefinite H too (see the smoothers). All unknowns are
/// free.
class Multigrid : public Preconditioner {
public:
    /// Prolongations, the coarsest first, kept by reference; none makes it a direct solver.
    Multigrid(std::span<const ScalarTransfer* const> prolongations, const MultigridOptions& options);
    void set_matrix(const NewtonSystem& matrix) override;
    VecX apply(const VecX& residual) const override { return cycle(levels_.size(), residual); }
    /// A level counts a quarter of the next finer one.
    double products() const override;

    /// H on a level: 0 the coarsest, the number of prolongations the matrix that was set.
    const NewtonSystem& matrix(int level) const;

private:
    struct Level { ///< all but the coarsest
        const ScalarTransfer* prolongation;
        TripleProduct product;
        std::unique_ptr<Preconditioner> smoother;
        const NewtonSystem* matrix = nullptr;
    };

    VecX cycle(std::size_t level, const VecX& residual) const;
    static void smooth(const Level& level, const VecX& right_hand_side, VecX& x);

    MultigridOptions options_;
    std::vector<Level> levels_;
    const NewtonSystem* coarsest_ = nullptr;
    mutable ShiftedCholesky direct_;
};

} // namespace plisse
