#include <plisse/linalg/condition.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include <plisse/base/random.h>
#include <plisse/linalg/multigrid.h>

namespace plisse {

double largest_eigenvalue(Eigen::Index size, const std::function<VecX(const VecX&)>& apply, int steps) {
    Random random(1);
    VecX before = VecX::Zero(size), v(size);
    for (double& entry : v)
        entry = random.uniform(-1, 1);
    v.normalize();
    std::vector<double> diagonal, beside;
    // Rounding takes the vectors' orthogonality, which repeats extreme Ritz values and does not move them.
    for (Eigen::Index k = 0; k < std::min<Eigen::Index>(steps, size); ++k) {
        VecX next = apply(v);
        diagonal.push_back(v.dot(next));
        next -= diagonal.back() * v;
        if (k > 0)
            next -= beside.back() * before;
        beside.push_back(next.norm());
        if (beside.back() <= 1e-14 * diagonal.back())
            break;
        before = std::exchange(v, next / beside.back());
    }
    const auto count = std::ssize(diagonal);
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(Eigen::Map<VecX>(diagonal.data(), count), Eigen::Map<VecX>(beside.data(), count - 1),
                                  Eigen::EigenvaluesOnly);
    return solver.eigenvalues().maxCoeff();
}

double condition_number(const NewtonSystem& matrix) {
    const Eigen::Index size = 3 * static_cast<Eigen::Index>(matrix.row_count());
    ShiftedCholesky factor;
    if (!factor.try_factorize(matrix, 0))
        return std::numeric_limits<double>::infinity();
    const double highest = largest_eigenvalue(size, [&](const VecX& v) { return matrix.multiply(v); });
    return highest * largest_eigenvalue(size, [&](const VecX& v) { return factor.solve(v); });
}

} // namespace plisse
