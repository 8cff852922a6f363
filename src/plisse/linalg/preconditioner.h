#pragma once

#include <vector>

#include <plisse/linalg/newton_system.h>

namespace plisse {

/// How costs in products with H count a solve by a factor of it: as the ten products of a smoothing step, like
/// Kopanicakova, Krause and Tamstorf (2019, section 7.4.2), who call this generous to direct solvers.
constexpr double products_of_direct_solve = 10;

/// An approximate inverse of H: symmetric and positive definite whether or not H is, so that conjugate gradients may
/// use it. Works on the rows of the system.
class Preconditioner {
public:
    virtual ~Preconditioner() = default;
    /// The matrix is kept by reference.
    virtual void set_matrix(const NewtonSystem& matrix) = 0;
    virtual VecX apply(const VecX& residual) const = 0;
    /// What apply costs, in products with H. Work on diagonal blocks is not counted, nor is set_matrix.
    virtual double products() const = 0;
};

/// The diagonal blocks of H made definite: eigenvalues are taken absolutely, and not below a tiny share of the block's
/// largest; one that is negative or small beside what couples its axis to other rows, as under compression, is raised
/// to half of that, without which sweeps blow up. So the blocks are at least those of H in every direction.
class DiagonalBlocks {
public:
    void set_matrix(const NewtonSystem& matrix);
    VecX multiply(const VecX& x) const { return each(blocks_, x); }
    VecX solve(const VecX& x) const { return each(inverses_, x); }
    const Mat3& inverse(int row) const { return inverses_[static_cast<std::size_t>(row)]; }

private:
    static VecX each(const std::vector<Mat3>& blocks, const VecX& x);

    std::vector<Mat3> blocks_, inverses_;
};

/// inverse(D) of those blocks.
class BlockJacobi : public Preconditioner {
public:
    void set_matrix(const NewtonSystem& matrix) override { diagonal_.set_matrix(matrix); }
    VecX apply(const VecX& residual) const override { return diagonal_.solve(residual); }
    double products() const override { return 0; }

private:
    DiagonalBlocks diagonal_;
};

/// A forward and a backward sweep from zero: inverse(M) with M = (D + L) inverse(D) (D + L'), L being the blocks below
/// the diagonal. M - H = (D - diagonal of H) + L inverse(D) L' is positive semi-definite for any H, so that sweeps also
/// smooth within a positive definite V-cycle when H is indefinite.
class BlockGaussSeidel : public Preconditioner {
public:
    void set_matrix(const NewtonSystem& matrix) override;
    VecX apply(const VecX& residual) const override;
    double products() const override { return 1; } // each sweep takes one half of H

private:
    const NewtonSystem* matrix_ = nullptr;
    DiagonalBlocks diagonal_;
};

/// p(inverse(D) H) inverse(D) with the Chebyshev polynomial p of a degree that damps the upper part of the spectrum of
/// inverse(D) H, whose largest eigenvalue is estimated by the power method. Degree 1 is damped Jacobi.
class Chebyshev : public Preconditioner {
public:
    explicit Chebyshev(int degree) : degree_(degree) {}
    void set_matrix(const NewtonSystem& matrix) override;
    VecX apply(const VecX& residual) const override;
    double products() const override { return degree_ - 1; }

private:
    int degree_;
    const NewtonSystem* matrix_ = nullptr;
    DiagonalBlocks diagonal_;
    double largest_ = 1; ///< no eigenvalue of inverse(D) H is above it
};

} // namespace plisse
