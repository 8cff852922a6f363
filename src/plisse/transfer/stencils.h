#pragma once

#include <span>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// The coarse vertices on which fine vertices depend; those of one group depend on the same ones.
struct Stencils {
    std::vector<int> group_of;  ///< of every fine vertex; -1 where it depends on none
    std::vector<int> starts{0}; ///< group g depends on coarse[starts[g]] .. coarse[starts[g + 1] - 1]
    std::vector<int> coarse;

    int fine_count() const { return static_cast<int>(group_of.size()); }
    std::span<const int> group(int g) const {
        const auto begin = static_cast<std::size_t>(starts[static_cast<std::size_t>(g)]);
        const auto end = static_cast<std::size_t>(starts[static_cast<std::size_t>(g) + 1]);
        return std::span(coarse).subspan(begin, end - begin);
    }
    /// Of a fine vertex.
    std::span<const int> of(int fine) const {
        const int g = group_of[static_cast<std::size_t>(fine)];
        return g < 0 ? std::span<const int>() : group(g);
    }
};

/// The Jacobian of a prolongation, J: of every fine vertex three rows, with three columns for each vertex of its
/// stencil.
class ProlongationJacobian {
public:
    template <int columns>
    using Rows = Eigen::Map<Eigen::Matrix<double, 3, columns, Eigen::RowMajor>>;
    template <int columns>
    using ConstRows = Eigen::Map<const Eigen::Matrix<double, 3, columns, Eigen::RowMajor>>;

    /// Zero.
    explicit ProlongationJacobian(const Stencils& stencils) {
        starts_.reserve(stencils.group_of.size() + 1);
        for (int i = 0; i < stencils.fine_count(); ++i)
            starts_.push_back(starts_.back() + 9 * stencils.of(i).size());
        values_.assign(starts_.back(), 0);
    }

    Rows<Eigen::Dynamic> rows(int fine) { return {values_.data() + starts_[at(fine)], 3, column_count(fine)}; }
    ConstRows<Eigen::Dynamic> rows(int fine) const { return rows<Eigen::Dynamic>(fine); }
    /// The same with the number of columns known beforehand, which it must match.
    template <int columns>
    ConstRows<columns> rows(int fine) const {
        return ConstRows<columns>(values_.data() + starts_[at(fine)], 3, column_count(fine));
    }

private:
    static std::size_t at(int index) { return static_cast<std::size_t>(index); }
    Eigen::Index column_count(int fine) const {
        return static_cast<Eigen::Index>((starts_[at(fine) + 1] - starts_[at(fine)]) / 3);
    }

    std::vector<std::size_t> starts_{0};
    std::vector<double> values_;
};

} // namespace plisse
