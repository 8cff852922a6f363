#include <plisse/linalg/multigrid.h>

#include <algorithm>

namespace plisse {

namespace {

std::unique_ptr<Preconditioner> make_smoother(const MultigridOptions& options) {
    switch (options.smoother) {
    case Smoother::block_gauss_seidel:
        return std::make_unique<BlockGaussSeidel>();
    case Smoother::chebyshev:
        return std::make_unique<Chebyshev>(options.degree);
    case Smoother::block_jacobi:
        break;
    }
    return std::make_unique<Chebyshev>(1);
}

} // namespace

bool ShiftedCholesky::try_factorize(const NewtonSystem& matrix, double shift) {
    plan_.adapt_to(matrix);
    return cholesky_.factorize(plan_, matrix, shift);
}

double ShiftedCholesky::factorize(const NewtonSystem& matrix) {
    double shift = 0;
    while (!try_factorize(matrix, shift))
        shift = larger_shift(matrix, shift, 1e-11, 4);
    return shift;
}

Multigrid::Multigrid(std::span<const ScalarTransfer* const> prolongations, const MultigridOptions& options)
    : options_(options) {
    for (const ScalarTransfer* s : prolongations)
        levels_.push_back({s, TripleProduct(*s), make_smoother(options)});
}

void Multigrid::set_matrix(const NewtonSystem& matrix) {
    const NewtonSystem* current = &matrix;
    for (auto level = levels_.rbegin(); level != levels_.rend(); ++level) {
        level->matrix = current;
        level->smoother->set_matrix(*current);
        current = &level->product.compute(*current);
    }
    coarsest_ = current;
    // Twice the least shift: one that is only just enough would make the softest direction all but singular.
    if (const double shift = direct_.factorize(*coarsest_); shift > 0)
        direct_.try_factorize(*coarsest_, 2 * shift);
}

double Multigrid::products() const {
    double sum = products_of_direct_solve;
    for (const Level& level : levels_)
        sum = sum / 4 + 2 * options_.steps * (1 + level.smoother->products());
    return sum;
}

const NewtonSystem& Multigrid::matrix(int level) const {
    return level == 0 ? *coarsest_ : *levels_[static_cast<std::size_t>(level) - 1].matrix;
}

VecX Multigrid::cycle(std::size_t level, const VecX& residual) const {
    if (level == 0)
        return direct_.solve(residual);
    const Level& here = levels_[level - 1];
    VecX x = here.smoother->apply(residual);
    for (int k = 1; k < options_.steps; ++k)
        smooth(here, residual, x);
    const VecX left = residual - here.matrix->multiply(x);
    x += prolonged(*here.prolongation, cycle(level - 1, restricted(*here.prolongation, left)));
    for (int k = 0; k < options_.steps; ++k)
        smooth(here, residual, x);
    return x;
}

void Multigrid::smooth(const Level& level, const VecX& right_hand_side, VecX& x) {
    x += level.smoother->apply(right_hand_side - level.matrix->multiply(x));
}

} // namespace plisse
