#include <plisse/linalg/cholesky.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <limits>
#include <stdexcept>

#include <cblas.h>

#include <plisse/linalg/panel_cholesky.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Makes room, with some to spare: memory that is new each time would cost more than the analysis.
template <typename Vector>
void grow(Vector& storage, std::size_t size) {
    if (static_cast<std::size_t>(storage.size()) < size)
        storage.resize(static_cast<Eigen::Index>(size + size / 4));
}

/// Lower triangle of C (rows x rows) becomes kept C - B B'.
void subtract_square(int rows, int columns, const float* b, int stride, float kept, float* c) {
    cblas_ssyrk(CblasColMajor, CblasLower, CblasNoTrans, rows, columns, -1, b, stride, kept, c, rows);
}
void subtract_square(int rows, int columns, const double* b, int stride, double kept, double* c) {
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, rows, columns, -1, b, stride, kept, c, rows);
}

} // namespace

template <typename Scalar>
SparseCholesky<Scalar>::SparseCholesky() {
    openblas_set_num_threads(1); // fronts are worked on at a time instead; a team's sums would depend on its size
}

template <typename Scalar>
bool SparseCholesky<Scalar>::factorize(const FrontPlan& plan, const NewtonSystem& system, double shift) {
    grow(panels_, plan.panel_room());
    grow(updates_, plan.update_room());
    grow(carried_, 3 * plan.elimination().reach.size());
    std::atomic<bool> definite = true;
    plan.visit_upwards([&](int front) {
        if (!definite)
            return;
        assemble(plan, front, system.blocks(), shift);
        if (!eliminate(plan, front))
            definite = false;
    });
    return definite;
}

template <typename Scalar>
VecX SparseCholesky<Scalar>::solve(const FrontPlan& plan, const VecX& right_hand_side) {
    const Elimination& e = plan.elimination();
    assert(right_hand_side.size() == 3 * e.row_count());
    Vector x(right_hand_side.size());
    for (int p = 0; p < e.row_count(); ++p)
        x.template segment<3>(3 * p) = right_hand_side.segment<3>(3 * e.order[at(p)]).cast<Scalar>();

    using PanelMap = Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>, 0, Eigen::OuterStride<>>;
    const auto pivots_of = [&](int f) { return x.segment(3 * e.first_pivot[at(f)], plan.pivot_size(f)); };
    const auto carried_of = [&](int f) { return carried_.segment(3 * e.reach_starts[at(f)], plan.reach_size(f)); };
    const auto panel_of = [&](int f) {
        return PanelMap(panels_.data() + plan.panel_start(f), plan.front_size(f), plan.pivot_size(f),
                        Eigen::OuterStride<>(plan.panel_rows(f)));
    };
    plan.visit_upwards([&](int f) {
        auto pivots = pivots_of(f);
        auto carried = carried_of(f);
        const int pivot_count = e.pivot_count(f);
        carried.setZero();
        for (int c : e.children[at(f)]) {
            const auto place = e.place_of(c);
            const auto from = carried_of(c);
            for (std::size_t i = 0; i < place.size(); ++i) {
                const auto part = from.template segment<3>(3 * static_cast<int>(i));
                if (place[i] < pivot_count)
                    pivots.template segment<3>(3 * place[i]) += part;
                else
                    carried.template segment<3>(3 * (place[i] - pivot_count)) += part;
            }
        }
        const auto panel = panel_of(f);
        panel.topRows(panel.cols()).template triangularView<Eigen::Lower>().solveInPlace(pivots);
        carried.noalias() -= panel.bottomRows(carried.size()) * pivots;
    });
    plan.visit_downwards([&](int f) {
        auto pivots = pivots_of(f);
        auto carried = carried_of(f);
        const auto reach = e.reach_of(f);
        for (std::size_t i = 0; i < reach.size(); ++i)
            carried.template segment<3>(3 * static_cast<int>(i)) = x.template segment<3>(3 * reach[i]);
        const auto panel = panel_of(f);
        pivots.noalias() -= panel.bottomRows(carried.size()).transpose() * carried;
        panel.topRows(panel.cols()).template triangularView<Eigen::Lower>().transpose().solveInPlace(pivots);
    });

    VecX solution(x.size());
    for (int p = 0; p < e.row_count(); ++p)
        solution.segment<3>(3 * e.order[at(p)]) = x.template segment<3>(3 * p).template cast<double>();
    return solution;
}

/// Gathers a front: the blocks of the system in its pivots' columns, and what its children leave. It goes by columns of
/// blocks, each cleared and filled while it is in the cache. A leaf's update is left to eliminate().
template <typename Scalar>
void SparseCholesky<Scalar>::assemble(const FrontPlan& plan, int front, const std::vector<Mat3>& blocks, double shift) {
    const int size = plan.front_size(front), reach = plan.reach_size(front), pivots = plan.pivot_size(front);
    const int panel_rows = plan.panel_rows(front);
    const auto& children = plan.elimination().children[at(front)];
    std::vector<std::size_t> taken(children.size(), 0); // columns of blocks of each child's update
    for (int row = 0; row < (children.empty() ? pivots : size); row += 3) {
        const bool pivotal = row < pivots;
        const int stride = pivotal ? panel_rows : reach, height = (pivotal ? panel_rows : size) - row;
        Scalar* column = pivotal // from its diagonal block down
                             ? panels_.data() + plan.panel_start(front) + at(row) * at(panel_rows + 1)
                             : updates_.data() + plan.update_start(front) + at(row - pivots) * at(reach + 1);
        for (int b = 0; b < 3; ++b)
            std::fill_n(column + b * stride, height, Scalar(0));
        if (pivotal)
            place_system_column(plan, plan.elimination().first_pivot[at(front)] + row / 3, stride, blocks);
        for (int b = 0; pivotal && b < 3; ++b)
            column[b * (stride + 1)] += static_cast<Scalar>(shift);
        for (std::size_t c = 0; c < children.size(); ++c) {
            const auto place = plan.elimination().place_of(children[c]);
            if (taken[c] < place.size() && 3 * place[taken[c]] == row)
                add_update_column(plan, children[c], taken[c]++, column, stride);
        }
    }
}

/// Copies the system's blocks of one pivot into their places in the panel, whose columns are `stride` apart.
template <typename Scalar>
void SparseCholesky<Scalar>::place_system_column(const FrontPlan& plan, int pivot, int stride,
                                                 const std::vector<Mat3>& blocks) {
    for (const FrontPlan::Placement& placement : plan.placements_of(pivot)) {
        const double* source = blocks[at(placement.number)].data();
        const int across = placement.transposed ? 1 : 3, down = placement.transposed ? 3 : 1;
        Scalar* target = panels_.data() + placement.target;
        for (int b = 0; b < 3; ++b)
            for (int a = 0; a < 3; ++a)
                target[b * stride + a] = static_cast<Scalar>(source[b * across + a * down]);
    }
}

/// Adds column j of blocks of a child's update, from its diagonal block down, to the column of the parent where it
/// belongs.
template <typename Scalar>
void SparseCholesky<Scalar>::add_update_column(const FrontPlan& plan, int child, std::size_t j, Scalar* column,
                                               int stride) {
    const auto place = plan.elimination().place_of(child);
    const std::size_t height = 3 * place.size();
    const Scalar* source = updates_.data() + plan.update_start(child) + 3 * j * height;
    for (std::size_t begin = j, end; begin < place.size(); begin = end) {
        for (end = begin + 1; end < place.size() && place[end] == place[end - 1] + 1;)
            ++end; // rows that follow each other here and there
        const Scalar* from = source + 3 * begin;
        Scalar* to = column + 3 * (place[begin] - place[j]);
        const std::size_t rows = 3 * (end - begin);
        for (int b = 0; b < 3; ++b, from += height, to += stride)
            for (std::size_t a = 0; a < rows; ++a)
                to[a] += from[a];
    }
}

/// Turns the panel of an assembled front into columns of the factor, and subtracts them from its update.
template <typename Scalar>
bool SparseCholesky<Scalar>::eliminate(const FrontPlan& plan, int front) {
    const int rows = plan.panel_rows(front), reach = plan.reach_size(front), pivots = plan.pivot_size(front);
    Scalar* panel = panels_.data() + plan.panel_start(front);
    if (!factorize_panel(rows, pivots, panel))
        return false;
    if (reach == 0)
        return true;
    const Scalar updated = plan.elimination().children[at(front)].empty() ? 0 : 1; // 0 clears what the memory holds
    subtract_square(reach, pivots, panel + pivots, rows, updated, updates_.data() + plan.update_start(front));
    return true;
}

double larger_shift(const NewtonSystem& system, double shift, double first_share, double growth) {
    double largest = 0;
    for (const Mat3& block : system.blocks()) {
        if (!block.allFinite())
            throw std::runtime_error("a Hessian has entries that are not finite");
        largest = std::max(largest, block.cwiseAbs().maxCoeff());
    }
    return std::max({first_share * largest, growth * shift, std::numeric_limits<double>::min()});
}

template class SparseCholesky<float>;
template class SparseCholesky<double>;

} // namespace plisse
