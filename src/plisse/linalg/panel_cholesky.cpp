#include <plisse/linalg/panel_cholesky.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include <cblas.h>

namespace plisse {

namespace {

constexpr int register_bytes = 32;

/// As many neighbouring rows as fill a register.
template <typename Scalar>
struct Rows {
    static constexpr int count = register_bytes / sizeof(Scalar);
    static_assert(panel_row_multiple % count == 0);
    typedef Scalar Register __attribute__((vector_size(register_bytes), aligned(alignof(Scalar)), may_alias));
};
template <typename Scalar>
using Register = typename Rows<Scalar>::Register;

template <typename Scalar>
Register<Scalar>& rows_at(Scalar* first) {
    return *reinterpret_cast<Register<Scalar>*>(first);
}

/// The row, at or before the given one, where registers begin.
template <typename Scalar>
int register_start(int row) {
    return row - row % Rows<Scalar>::count;
}

/// `Registers` registers of rows from `row` on, of three columns: the products of those rows in the columns before
/// (`earlier`) with the three rows that begin at `factors` are subtracted.
template <int Registers, typename Scalar>
void subtract_products(int row, int stride, const Scalar* earlier, int earlier_count, const Scalar* factors,
                       Scalar* columns) {
    Register<Scalar> sums[3][Registers] = {};
    earlier += row;
    for (int k = 0; k < earlier_count; ++k, earlier += stride, factors += stride)
        for (int r = 0; r < Registers; ++r) {
            const auto rows = *reinterpret_cast<const Register<Scalar>*>(earlier + r * Rows<Scalar>::count);
            for (int c = 0; c < 3; ++c)
                sums[c][r] += rows * factors[c];
        }
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < Registers; ++r)
            rows_at(columns + c * std::ptrdiff_t{stride} + row + r * Rows<Scalar>::count) -= sums[c][r];
}

/// The same for all rows from `row` to the end of the columns.
template <typename Scalar>
void subtract_products(int row, int stride, const Scalar* earlier, int earlier_count, const Scalar* factors,
                       Scalar* columns) {
    constexpr int size = Rows<Scalar>::count;
    for (; row + 4 * size <= stride; row += 4 * size)
        subtract_products<4>(row, stride, earlier, earlier_count, factors, columns);
    for (; row + 2 * size <= stride; row += 2 * size)
        subtract_products<2>(row, stride, earlier, earlier_count, factors, columns);
    for (; row < stride; row += size)
        subtract_products<1>(row, stride, earlier, earlier_count, factors, columns);
}

/// Lower triangle of three columns by three rows, and one over its diagonal.
template <typename Scalar>
struct SmallFactor {
    Scalar l00, l10, l20, l11, l21, l22;
    Scalar inverse0, inverse1, inverse2;

    /// Factorises the block that begins at `block`; false where it is not positive definite.
    bool factorize(const Scalar* block, std::ptrdiff_t stride) {
        l00 = std::sqrt(block[0]);
        inverse0 = 1 / l00;
        l10 = block[1] * inverse0;
        l20 = block[2] * inverse0;
        l11 = std::sqrt(block[stride + 1] - l10 * l10);
        inverse1 = 1 / l11;
        l21 = (block[stride + 2] - l20 * l10) * inverse1;
        l22 = std::sqrt(block[2 * stride + 2] - l20 * l20 - l21 * l21);
        inverse2 = 1 / l22;
        return l00 > 0 && l11 > 0 && l22 > 0;
    }
};

/// Divides three columns from the given row on by the transpose of the factor of their block.
template <typename Scalar>
void solve_rows(int row, std::ptrdiff_t stride, const SmallFactor<Scalar>& factor, Scalar* columns) {
    for (; row < stride; row += Rows<Scalar>::count) {
        auto& x0 = rows_at(columns + row);
        auto& x1 = rows_at(columns + stride + row);
        auto& x2 = rows_at(columns + 2 * stride + row);
        x0 *= factor.inverse0;
        x1 = (x1 - x0 * factor.l10) * factor.inverse1;
        x2 = (x2 - x0 * factor.l20 - x1 * factor.l21) * factor.inverse2;
    }
}

/// Factorises `count` columns from pivot `first` on, from whose rows the columns before these have been subtracted.
template <typename Scalar>
bool factorize_columns(int rows, int first, int count, Scalar* panel) {
    const Scalar* earlier = panel + first * std::ptrdiff_t{rows};
    for (int pivot = first; pivot < first + count; pivot += 3) {
        Scalar* columns = panel + pivot * std::ptrdiff_t{rows};
        const int start = register_start<Scalar>(pivot);
        subtract_products(start, rows, earlier, pivot - first, earlier + pivot, columns);
        SmallFactor<Scalar> factor;
        if (!factor.factorize(columns + pivot, rows))
            return false;
        solve_rows(start, rows, factor, columns);
    }
    return true;
}

/// C (rows x columns) becomes C - A B'.
void subtract_product(int rows, int columns, int inner, const float* a, const float* b, float* c, int stride) {
    cblas_sgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows, columns, inner, -1, a, stride, b, stride, 1, c, stride);
}
void subtract_product(int rows, int columns, int inner, const double* a, const double* b, double* c, int stride) {
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows, columns, inner, -1, a, stride, b, stride, 1, c, stride);
}

} // namespace

/// Column after column looks back on those of its own group only: they stay in the cache. What a group does to all
/// behind it is a product of matrices large enough for BLAS.
template <typename Scalar>
bool factorize_panel(int rows, int pivots, Scalar* panel) {
    assert(rows % panel_row_multiple == 0 && pivots % 3 == 0);
    constexpr int group = 48;
    for (int first = 0; first < pivots; first += group) {
        const int count = std::min(group, pivots - first);
        if (!factorize_columns(rows, first, count, panel))
            return false;
        const Scalar* done = panel + first * std::ptrdiff_t{rows};
        for (int next = first + group; next < pivots; next += group)
            subtract_product(rows - next, std::min(group, pivots - next), count, done + next, done + next,
                             panel + next * std::ptrdiff_t{rows + 1}, rows);
    }
    return true;
}

template bool factorize_panel(int rows, int pivots, float* panel);
template bool factorize_panel(int rows, int pivots, double* panel);

} // namespace plisse
