#include <plisse/linalg/cholesky.h>

#include <cholmod.h>
#include <metis.h>
#include <omp.h>

#include <cassert>
#include <cstring>
#include <stdexcept>

extern "C" void openblas_set_num_threads(int count);

namespace plisse {

struct SparseCholesky::State {
    cholmod_common common;
    cholmod_sparse matrix{};
    cholmod_factor* factor = nullptr;
    cholmod_dense* solution = nullptr;
    cholmod_dense* work_y = nullptr;
    cholmod_dense* work_e = nullptr;
    std::vector<int> column_pointers, row_indices, order;
    int pattern_version = -1;
    int ordering_count = 0;
    double ordered_fill = 0;

    State();
    ~State();
    void expand_pattern(const NewtonSystem& system);
    void order_vertices(const NewtonSystem& system);
    void analyze(const NewtonSystem& system);
};

SparseCholesky::State::State() {
    // Debian's CHOLMOD opens OpenMP teams of its own and OpenBLAS threads below them: both are slower here than one
    // thread, and their reductions would make the bits depend on the machine's load.
    omp_set_max_active_levels(0);
    openblas_set_num_threads(1);
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_GIVEN;
    common.postorder = true;
    common.print = 0;
    // Supernodes merged a little more eagerly than by default: shells have many of a dozen columns.
    common.nrelax[0] = 8;
    common.nrelax[1] = 24;
    common.nrelax[2] = 64;
    common.zrelax[1] = 0.2;
    common.zrelax[2] = 0.1;
    common.error_handler = nullptr;
    common.quick_return_if_not_posdef = true;
}

SparseCholesky::State::~State() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
}

void SparseCholesky::State::expand_pattern(const NewtonSystem& system) {
    const auto& starts = system.column_starts();
    const auto& rows = system.block_rows();
    column_pointers.assign(1, 0);
    row_indices.clear();
    row_indices.reserve(9 * rows.size());
    for (std::size_t c = 0; c + 1 < starts.size(); ++c)
        for (int b = 0; b < 3; ++b) {
            for (int k = starts[c]; k < starts[c + 1]; ++k)
                for (int a = 0; a < 3; ++a)
                    row_indices.push_back(3 * rows[static_cast<std::size_t>(k)] + a);
            column_pointers.push_back(static_cast<int>(row_indices.size()));
        }
    const auto n = static_cast<std::size_t>(3 * system.row_count());
    matrix.nrow = matrix.ncol = n;
    matrix.nzmax = row_indices.size();
    matrix.p = column_pointers.data();
    matrix.i = row_indices.data();
    matrix.stype = -1;
    matrix.itype = CHOLMOD_INT;
    matrix.xtype = CHOLMOD_REAL;
    matrix.dtype = CHOLMOD_DOUBLE;
    matrix.sorted = true;
    matrix.packed = true;
}

void SparseCholesky::State::order_vertices(const NewtonSystem& system) {
    const auto n = static_cast<std::size_t>(system.row_count());
    std::vector<std::vector<idx_t>> neighbours(n);
    for (std::size_t c = 0; c < n; ++c)
        for (int k = system.column_starts()[c] + 1; k < system.column_starts()[c + 1]; ++k) {
            const int r = system.block_rows()[static_cast<std::size_t>(k)];
            neighbours[c].push_back(r);
            neighbours[static_cast<std::size_t>(r)].push_back(static_cast<idx_t>(c));
        }
    std::vector<idx_t> starts{0}, adjacent;
    for (const auto& list : neighbours) {
        adjacent.insert(adjacent.end(), list.begin(), list.end());
        starts.push_back(static_cast<idx_t>(adjacent.size()));
    }
    std::vector<idx_t> permutation(n), inverse(n);
    auto count = static_cast<idx_t>(n);
    if (adjacent.empty())
        for (std::size_t i = 0; i < n; ++i)
            permutation[i] = static_cast<idx_t>(i);
    else if (METIS_NodeND(&count, starts.data(), adjacent.data(), nullptr, nullptr, permutation.data(),
                          inverse.data()) != METIS_OK)
        throw std::runtime_error("METIS could not order the matrix");
    order.clear();
    for (idx_t row : permutation)
        for (int a = 0; a < 3; ++a)
            order.push_back(3 * static_cast<int>(row) + a);
    ++ordering_count;
}

void SparseCholesky::State::analyze(const NewtonSystem& system) {
    expand_pattern(system);
    const auto analyze_ordered = [&] {
        cholmod_free_factor(&factor, &common);
        factor = cholmod_analyze_p(&matrix, order.data(), nullptr, 0, &common);
        if (!factor)
            throw std::runtime_error("CHOLMOD could not analyse the matrix (out of memory?)");
    };
    constexpr double fill_worth_reordering = 1.4;
    if (order.size() == matrix.nrow) {
        analyze_ordered();
        if (common.lnz <= fill_worth_reordering * ordered_fill)
            return;
    }
    order_vertices(system);
    analyze_ordered();
    ordered_fill = common.lnz;
}

SparseCholesky::SparseCholesky() : state_(std::make_unique<State>()) {}
SparseCholesky::~SparseCholesky() = default;

bool SparseCholesky::factorize(const NewtonSystem& system, double shift) {
    State& s = *state_;
    if (system.row_count() == 0)
        return true;
    s.matrix.x = const_cast<double*>(system.values().data()); // CHOLMOD reads it only
    if (s.pattern_version != system.pattern_version()) {
        s.analyze(system);
        s.pattern_version = system.pattern_version();
    }
    double beta[2] = {shift, 0};
    if (!cholmod_factorize_p(&s.matrix, beta, nullptr, 0, s.factor, &s.common) && s.common.status != CHOLMOD_NOT_POSDEF)
        throw std::runtime_error("CHOLMOD could not factorise the matrix (out of memory?)");
    return s.common.status == CHOLMOD_OK;
}

void SparseCholesky::reset() {
    state_->order.clear();
    state_->pattern_version = -1;
}

VecX SparseCholesky::solve(const VecX& right_hand_side) {
    State& s = *state_;
    if (right_hand_side.size() == 0)
        return {};
    cholmod_dense b{};
    b.nrow = b.d = b.nzmax = static_cast<std::size_t>(right_hand_side.size());
    b.ncol = 1;
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    b.x = const_cast<double*>(right_hand_side.data());
    if (!cholmod_solve2(CHOLMOD_A, s.factor, &b, nullptr, &s.solution, nullptr, &s.work_y, &s.work_e, &s.common))
        throw std::runtime_error("CHOLMOD could not solve (out of memory?)");
    return Eigen::Map<const VecX>(static_cast<const double*>(s.solution->x), right_hand_side.size());
}

int SparseCholesky::ordering_count() const {
    return state_->ordering_count;
}
double SparseCholesky::factor_nonzeros() const {
    return state_->common.lnz;
}

} // namespace plisse
