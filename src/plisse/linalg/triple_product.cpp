#include <plisse/linalg/triple_product.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <utility>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

} // namespace

TripleProduct::TripleProduct(const ScalarTransfer& s) : s_(s), rows_(s) {}

const NewtonSystem& TripleProduct::compute(const NewtonSystem& fine) {
    assert(fine.row_count() == fine.vertex_count() && fine.row_count() == s_.rows());
    if (pattern_version_ != fine.pattern_version())
        find_pattern(fine);
    coarse_.begin(extra_pairs_);
    const int columns = coarse_.row_count(), chunk_size = std::max(64, columns / 32);
    parallel_chunks(columns, chunk_size, [&](int, int begin, int end) {
        Workspace space = workspace();
        for (int column = begin; column < end; ++column)
            add_column(column, fine, space);
    });
    return coarse_;
}

TripleProduct::Workspace TripleProduct::workspace() const {
    return {std::vector<int>(at(static_cast<int>(s_.rows())), -1),
            std::vector<int>(at(static_cast<int>(s_.cols())), -1),
            {},
            {}};
}

void TripleProduct::find_pattern(const NewtonSystem& fine) {
    pattern_version_ = fine.pattern_version();
    const int count = fine.row_count();
    const auto for_each_block = [&](const auto& visit) {
        for (int c = 0; c < count; ++c)
            for (int k = fine.column_starts()[at(c)]; k < fine.column_starts()[at(c) + 1]; ++k)
                visit(c, fine.block_rows()[at(k)], fine.block_numbers()[at(k)]);
    };
    entry_starts_.assign(at(count) + 1, 0);
    for_each_block([&](int c, int r, int) {
        ++entry_starts_[at(c) + 1];
        entry_starts_[at(r) + 1] += r != c;
    });
    for (std::size_t c = 0; c < at(count); ++c)
        entry_starts_[c + 1] += entry_starts_[c];
    std::vector<std::size_t> next(entry_starts_.begin(), entry_starts_.end() - 1);
    entries_.resize(entry_starts_.back());
    for_each_block([&](int c, int r, int number) {
        entries_[next[at(c)]++] = {r, number, false};
        if (r != c)
            entries_[next[at(r)]++] = {c, number, true};
    });

    std::vector<Edge> pairs;
    Workspace space = workspace();
    for (int column = 0; column < s_.cols(); ++column)
        for (int row : coarse_rows(column, space))
            pairs.push_back({column, row});
    if (coarse_.vertex_count() == 0)
        coarse_ = NewtonSystem(std::vector<std::uint8_t>(3 * at(static_cast<int>(s_.cols())), 0), pairs);
    else
        extra_pairs_ = std::move(pairs); // one and the same system, so that its pattern_version tells of changes
}

/// Finds the fine vertices where H S has blocks in this column.
void TripleProduct::touch(int column, Workspace& space) const {
    for (ScalarTransfer::InnerIterator weight(s_, column); weight; ++weight)
        for (std::size_t k = entry_starts_[at(weight.row())]; k < entry_starts_[at(weight.row()) + 1]; ++k) {
            int& place = space.place_of_fine[at(entries_[k].row)];
            if (place >= 0)
                continue;
            place = static_cast<int>(space.touched.size());
            space.touched.push_back(entries_[k].row);
        }
}

void TripleProduct::release(Workspace& space) const {
    for (int i : space.touched)
        space.place_of_fine[at(i)] = -1;
    space.touched.clear();
}

/// The rows of the product's lower triangle in this column, ascending.
std::vector<int> TripleProduct::coarse_rows(int column, Workspace& space) const {
    touch(column, space);
    std::vector<int> rows{column};
    space.place_of_coarse[at(column)] = 0;
    for (int i : space.touched)
        for (decltype(rows_)::InnerIterator weight(rows_, i); weight; ++weight) {
            const int row = static_cast<int>(weight.col());
            if (row > column && std::exchange(space.place_of_coarse[at(row)], 0) < 0)
                rows.push_back(row);
        }
    for (int row : rows)
        space.place_of_coarse[at(row)] = -1;
    release(space);
    std::sort(rows.begin(), rows.end());
    return rows;
}

void TripleProduct::add_column(int column, const NewtonSystem& fine, Workspace& space) {
    touch(column, space);
    space.carried.assign(space.touched.size(), Mat3::Zero());
    for (ScalarTransfer::InnerIterator weight(s_, column); weight; ++weight)
        for (std::size_t k = entry_starts_[at(weight.row())]; k < entry_starts_[at(weight.row()) + 1]; ++k) {
            const Mat3& block = fine.blocks()[at(entries_[k].number)];
            Mat3& sum = space.carried[at(space.place_of_fine[at(entries_[k].row)])];
            if (entries_[k].transposed)
                sum += weight.value() * block.transpose();
            else
                sum += weight.value() * block;
        }
    const int begin = coarse_.column_starts()[at(column)], end = coarse_.column_starts()[at(column) + 1];
    std::vector<Mat3> sums(at(end - begin), Mat3::Zero());
    for (int k = begin; k < end; ++k)
        space.place_of_coarse[at(coarse_.block_rows()[at(k)])] = k - begin;
    for (std::size_t i = 0; i < space.touched.size(); ++i)
        for (decltype(rows_)::InnerIterator weight(rows_, space.touched[i]); weight; ++weight)
            if (const int place = space.place_of_coarse[at(static_cast<int>(weight.col()))]; place >= 0)
                sums[at(place)] += weight.value() * space.carried[i];
    for (int k = begin; k < end; ++k) {
        const int row = coarse_.block_rows()[at(k)];
        space.place_of_coarse[at(row)] = -1;
        coarse_.add_block_at(coarse_.block_numbers()[at(k)], row, column, sums[at(k - begin)]);
    }
    release(space);
}

} // namespace plisse
