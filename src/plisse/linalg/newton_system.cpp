#include <plisse/linalg/newton_system.h>

#include <algorithm>
#include <cassert>
#include <iterator>

namespace plisse {

namespace {

std::uint64_t block_key(int row, int column) {
    return (static_cast<std::uint64_t>(column) << 32) | static_cast<std::uint32_t>(row);
}

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

} // namespace

NewtonSystem::NewtonSystem(std::vector<std::uint8_t> prescribed, std::span<const Edge> pairs)
    : prescribed_(std::move(prescribed)) {
    const std::size_t vertices = prescribed_.size() / 3;
    row_of_vertex_.assign(vertices, -1);
    free_row_.assign(vertices, -1);
    partly_prescribed_.assign(vertices, 0);
    prescribed_step_ = VecX::Zero(static_cast<Eigen::Index>(prescribed_.size()));
    for (std::size_t v = 0; v < vertices; ++v) {
        const int count = prescribed_[3 * v] + prescribed_[3 * v + 1] + prescribed_[3 * v + 2];
        if (count == 3)
            continue;
        row_of_vertex_[v] = row_count();
        free_row_[v] = count == 0 ? row_count() : -1;
        vertex_of_row_.push_back(static_cast<int>(v));
        partly_prescribed_[v] = count > 0;
    }
    for (int row = 0; row < row_count(); ++row)
        base_keys_.push_back(block_key(row, row));
    for (const Edge& pair : pairs) {
        const int a = row_of_vertex_[at(pair[0])];
        const int b = row_of_vertex_[at(pair[1])];
        if (a >= 0 && b >= 0)
            base_keys_.push_back(block_key(std::max(a, b), std::min(a, b)));
    }
    std::sort(base_keys_.begin(), base_keys_.end());
    base_keys_.erase(std::unique(base_keys_.begin(), base_keys_.end()), base_keys_.end());
    base_block_count_ = base_keys_.size();
    set_pattern(base_keys_);
}

void NewtonSystem::set_prescribed_step(const VecX& u) {
    assert(u.size() == static_cast<Eigen::Index>(prescribed_.size()));
    prescribed_step_ = u;
}

void NewtonSystem::begin(std::span<const Edge> extra_pairs) {
    reserve_pattern(extra_pairs);
    std::fill(values_.begin(), values_.end(), 0.0);
    coupling_.setZero(static_cast<Eigen::Index>(prescribed_.size()));
    for (int column = 0; column < row_count(); ++column) {
        const std::size_t vertex = at(vertex_of_row_[at(column)]);
        if (!partly_prescribed_[vertex])
            continue;
        Values diagonal = values_of(column, column);
        for (int a = 0; a < 3; ++a)
            if (prescribed_[3 * vertex + at(a)])
                diagonal(a, a) = 1;
    }
}

void NewtonSystem::reset_pattern() {
    if (block_rows_.size() > base_block_count_)
        set_pattern(base_keys_);
}

void NewtonSystem::reserve_pattern(std::span<const Edge> extra_pairs) {
    std::vector<std::uint64_t> needed;
    bool complete = true;
    for (const Edge& pair : extra_pairs) {
        const int a = row_of_vertex_[at(pair[0])];
        const int b = row_of_vertex_[at(pair[1])];
        if (a < 0 || b < 0)
            continue;
        needed.push_back(block_key(std::max(a, b), std::min(a, b)));
        complete = complete && find_block(std::max(a, b), std::min(a, b)) >= 0;
    }
    const std::size_t spare = block_rows_.size() - base_block_count_;
    const bool wasteful = spare > base_block_count_ / 4 && spare > 3 * needed.size();
    if (complete && !wasteful)
        return;
    std::sort(needed.begin(), needed.end());
    needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
    std::vector<std::uint64_t> keys;
    std::set_union(base_keys_.begin(), base_keys_.end(), needed.begin(), needed.end(), std::back_inserter(keys));
    if (!wasteful) {
        std::vector<std::uint64_t> grown;
        const std::vector<std::uint64_t> present = pattern_keys();
        std::set_union(keys.begin(), keys.end(), present.begin(), present.end(), std::back_inserter(grown));
        keys = std::move(grown);
    }
    set_pattern(keys);
}

std::vector<std::uint64_t> NewtonSystem::pattern_keys() const {
    std::vector<std::uint64_t> keys;
    keys.reserve(block_rows_.size());
    for (int column = 0; column < row_count(); ++column)
        for (int k = column_starts_[at(column)]; k < column_starts_[at(column) + 1]; ++k)
            keys.push_back(block_key(block_rows_[at(k)], column));
    return keys;
}

void NewtonSystem::set_pattern(const std::vector<std::uint64_t>& keys) {
    column_starts_.assign(at(row_count()) + 1, 0);
    block_rows_.clear();
    for (std::uint64_t key : keys) {
        block_rows_.push_back(static_cast<int>(key & 0xffffffffU));
        ++column_starts_[at(static_cast<int>(key >> 32)) + 1];
    }
    for (std::size_t c = 1; c < column_starts_.size(); ++c)
        column_starts_[c] += column_starts_[c - 1];
    values_.assign(9 * keys.size(), 0.0);
    ++pattern_version_;
}

void NewtonSystem::add_prescribed_block(int i, int j, const Mat3& block) {
    coupling_.segment<3>(3 * i) += block * prescribed_step_.segment<3>(3 * j);
    if (i != j)
        coupling_.segment<3>(3 * j) += block.transpose() * prescribed_step_.segment<3>(3 * i);
    const int row = row_of_vertex_[at(i)];
    const int column = row_of_vertex_[at(j)];
    if (row < 0 || column < 0)
        return;
    Values values = values_of(row, column);
    for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a)
            if (!(prescribed_[at(3 * i + a)] || prescribed_[at(3 * j + b)]))
                values(a, b) += block(a, b);
}

Mat3 NewtonSystem::block(int i, int j) const {
    const auto [start, stride] = place_of(row_of_vertex_[at(i)], row_of_vertex_[at(j)]);
    return Eigen::Map<const Mat3, 0, Eigen::OuterStride<>>(values_.data() + start, stride);
}

VecX NewtonSystem::gather(const VecX& vertices) const {
    VecX rows(3 * row_count());
    for (int row = 0; row < row_count(); ++row)
        for (int a = 0; a < 3; ++a) {
            const int scalar = 3 * vertex_of_row_[at(row)] + a;
            rows[3 * row + a] = prescribed_[at(scalar)] ? 0.0 : vertices[scalar];
        }
    return rows;
}

VecX NewtonSystem::scatter(const VecX& rows) const {
    VecX vertices = VecX::Zero(static_cast<Eigen::Index>(prescribed_.size()));
    for (int row = 0; row < row_count(); ++row)
        for (int a = 0; a < 3; ++a) {
            const int scalar = 3 * vertex_of_row_[at(row)] + a;
            if (!prescribed_[at(scalar)])
                vertices[scalar] = rows[3 * row + a];
        }
    return vertices;
}

} // namespace plisse
