#include <plisse/linalg/preconditioner.h>

#include <cmath>

#include <Eigen/Eigenvalues>

#include <plisse/base/parallel.h>
#include <plisse/base/random.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Largest |eigenvalue| of inverse(D) H, from below.
double spectral_radius(const NewtonSystem& matrix, const DiagonalBlocks& diagonal) {
    constexpr int iterations = 12;
    Random random(1);
    VecX x(3 * matrix.row_count());
    for (double& entry : x)
        entry = random.uniform(-1, 1);
    double radius = 0;
    for (int k = 0; k < iterations; ++k) {
        x /= std::sqrt(x.dot(diagonal.multiply(x)));
        const VecX product = matrix.multiply(x);
        x = diagonal.solve(product);
        const double squared = x.dot(product);
        if (!(squared > 0))
            break;
        radius = std::sqrt(squared);
    }
    return radius;
}

/// Sums of |v'Hv| over the blocks H beside the diagonal in the row of each axis v of a diagonal block.
Positions axis_couplings(const NewtonSystem& matrix, const std::vector<Mat3>& axes) {
    Positions sums = Positions::Zero(3, matrix.row_count());
    for (int c = 0; c < matrix.row_count(); ++c)
        for (int k = matrix.column_starts()[at(c)] + 1; k < matrix.column_starts()[at(c) + 1]; ++k) {
            const int r = matrix.block_rows()[at(k)];
            const Mat3& block = matrix.blocks()[at(matrix.block_numbers()[at(k)])];
            sums.col(c) += axes[at(c)].cwiseProduct(block * axes[at(c)]).colwise().sum().cwiseAbs().transpose();
            sums.col(r) += axes[at(r)].cwiseProduct(block * axes[at(r)]).colwise().sum().cwiseAbs().transpose();
        }
    return sums;
}

} // namespace

void DiagonalBlocks::set_matrix(const NewtonSystem& matrix) {
    constexpr double least_share = 1e-10, weak = 0.005, dominant = 0.5;
    const std::size_t count = at(matrix.row_count());
    std::vector<Mat3> axes(count);
    Positions values(3, matrix.row_count());
    parallel_for(matrix.row_count(), 256, [&](int row) {
        const int place = matrix.column_starts()[at(row)]; // the diagonal comes first
        const Eigen::SelfAdjointEigenSolver<Mat3> eigen(matrix.blocks()[at(matrix.block_numbers()[at(place)])]);
        axes[at(row)] = eigen.eigenvectors();
        values.col(row) = eigen.eigenvalues();
    });
    const Positions couplings = axis_couplings(matrix, axes);
    blocks_.resize(count);
    inverses_.resize(count);
    parallel_for(matrix.row_count(), 256, [&](int row) {
        Vec3 value = values.col(row).cwiseAbs();
        for (int k = 0; k < 3; ++k)
            if (values(k, row) < weak * couplings(k, row))
                value[k] = std::max(value[k], dominant * couplings(k, row));
        value = value.maxCoeff() > 0 ? Vec3(value.cwiseMax(least_share * value.maxCoeff())) : Vec3(Vec3::Ones());
        const Mat3& turn = axes[at(row)];
        blocks_[at(row)] = turn * value.asDiagonal() * turn.transpose();
        inverses_[at(row)] = turn * value.cwiseInverse().asDiagonal() * turn.transpose();
    });
}

VecX DiagonalBlocks::each(const std::vector<Mat3>& blocks, const VecX& x) {
    VecX product(x.size());
    for (int row = 0; row < static_cast<int>(blocks.size()); ++row)
        product.segment<3>(3 * row) = blocks[at(row)] * x.segment<3>(3 * row);
    return product;
}

void BlockGaussSeidel::set_matrix(const NewtonSystem& matrix) {
    matrix_ = &matrix;
    diagonal_.set_matrix(matrix);
}

VecX BlockGaussSeidel::apply(const VecX& residual) const {
    const auto& starts = matrix_->column_starts();
    const auto& rows = matrix_->block_rows();
    const auto& numbers = matrix_->block_numbers();
    const auto& blocks = matrix_->blocks();
    VecX x = residual;
    for (int c = 0; c < matrix_->row_count(); ++c) {
        const Vec3 value = diagonal_.inverse(c) * x.segment<3>(3 * c);
        x.segment<3>(3 * c) = value;
        for (int k = starts[at(c)] + 1; k < starts[at(c) + 1]; ++k)
            x.segment<3>(3 * rows[at(k)]) -= blocks[at(numbers[at(k)])] * value;
    }
    for (int c = matrix_->row_count() - 1; c >= 0; --c) {
        Vec3 sum = Vec3::Zero();
        for (int k = starts[at(c)] + 1; k < starts[at(c) + 1]; ++k)
            sum += blocks[at(numbers[at(k)])].transpose() * x.segment<3>(3 * rows[at(k)]);
        x.segment<3>(3 * c) -= diagonal_.inverse(c) * sum;
    }
    return x;
}

void Chebyshev::set_matrix(const NewtonSystem& matrix) {
    constexpr double margin = 1.2; // of an estimate from below
    matrix_ = &matrix;
    diagonal_.set_matrix(matrix);
    largest_ = std::max(1.0, margin * spectral_radius(matrix, diagonal_));
}

/// The three-term recurrence from zero (Saad 2003, algorithm 12.1), on the interval [largest / 4, largest].
VecX Chebyshev::apply(const VecX& residual) const {
    const double centre = 0.625 * largest_, half = 0.375 * largest_;
    const double sigma = centre / half;
    double rho = 1 / sigma;
    VecX left = residual;
    VecX step = diagonal_.solve(left) / centre;
    VecX x = step;
    for (int k = 1; k < degree_; ++k) {
        left -= matrix_->multiply(step);
        const double next = 1 / (2 * sigma - rho);
        step = next * rho * step + 2 * next / half * diagonal_.solve(left);
        rho = next;
        x += step;
    }
    return x;
}

} // namespace plisse
