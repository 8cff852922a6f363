#include <plisse/linalg/newton_system.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <numeric>
#include <utility>

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
    number_base_blocks(pairs);
    set_extra_blocks({});
}

void NewtonSystem::number_base_blocks(std::span<const Edge> pairs) {
    std::vector<std::pair<std::uint64_t, std::size_t>> keys; // with their places in the order asked for
    for (const Edge& pair : pairs) {
        const int a = row_of_vertex_[at(pair[0])];
        const int b = row_of_vertex_[at(pair[1])];
        if (a >= 0 && b >= 0)
            keys.emplace_back(block_key(std::max(a, b), std::min(a, b)), keys.size());
    }
    for (int row = 0; row < row_count(); ++row)
        keys.emplace_back(block_key(row, row), keys.size());
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
               keys.end());
    std::vector<std::pair<std::size_t, std::size_t>> places; // in the order asked for, and in the pattern
    for (const auto& [key, place] : keys) {
        places.emplace_back(place, base_keys_.size());
        base_keys_.push_back(key);
    }
    std::sort(places.begin(), places.end());
    base_numbers_.resize(places.size());
    for (std::size_t number = 0; number < places.size(); ++number)
        base_numbers_[places[number].second] = static_cast<int>(number);
}

void NewtonSystem::set_prescribed_step(const VecX& u) {
    assert(u.size() == static_cast<Eigen::Index>(prescribed_.size()));
    prescribed_step_ = u;
}

void NewtonSystem::begin(std::span<const Edge> extra_pairs) {
    reserve_pattern(extra_pairs);
    std::fill(blocks_.begin(), blocks_.end(), Mat3::Zero());
    coupling_.setZero(static_cast<Eigen::Index>(prescribed_.size()));
    for (int column = 0; column < row_count(); ++column) {
        const std::size_t vertex = at(vertex_of_row_[at(column)]);
        if (!partly_prescribed_[vertex])
            continue;
        Mat3& diagonal = blocks_[at(number_of(column, column))];
        for (int a = 0; a < 3; ++a)
            if (prescribed_[3 * vertex + at(a)])
                diagonal(a, a) = 1;
    }
}

void NewtonSystem::reset_pattern() {
    if (!extra_keys_.empty())
        set_extra_blocks({});
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
    const bool wasteful = extra_keys_.size() > base_keys_.size() / 4 && extra_keys_.size() > 3 * needed.size();
    if (complete && !wasteful)
        return;
    std::sort(needed.begin(), needed.end());
    needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
    std::vector<std::uint64_t> extra;
    std::set_difference(needed.begin(), needed.end(), base_keys_.begin(), base_keys_.end(), std::back_inserter(extra));
    if (!wasteful) {
        std::vector<std::uint64_t> grown;
        std::set_union(extra.begin(), extra.end(), extra_keys_.begin(), extra_keys_.end(), std::back_inserter(grown));
        extra = std::move(grown);
    }
    set_extra_blocks(std::move(extra));
}

void NewtonSystem::set_extra_blocks(std::vector<std::uint64_t> keys) {
    extra_keys_ = std::move(keys);
    const std::size_t base = base_keys_.size(), count = base + extra_keys_.size();
    column_starts_.assign(at(row_count()) + 1, 0);
    block_rows_.clear();
    block_numbers_.clear();
    for (std::size_t b = 0, e = 0; b + e < count;) {
        const bool is_base = e == extra_keys_.size() || (b < base && base_keys_[b] < extra_keys_[e]);
        const std::uint64_t key = is_base ? base_keys_[b] : extra_keys_[e];
        block_numbers_.push_back(is_base ? base_numbers_[b++] : static_cast<int>(base + e++));
        block_rows_.push_back(static_cast<int>(key & 0xffffffffU));
        ++column_starts_[at(static_cast<int>(key >> 32)) + 1];
    }
    std::partial_sum(column_starts_.begin(), column_starts_.end(), column_starts_.begin());
    blocks_.assign(count, Mat3::Zero());
    ++pattern_version_;
}

int NewtonSystem::base_block(int i, int j) const {
    const int row = free_row_[at(i)], column = free_row_[at(j)];
    if (row < 0 || column < 0)
        return -1;
    const auto found = std::lower_bound(base_keys_.begin(), base_keys_.end(), block_key(row, column));
    assert(found != base_keys_.end() && *found == block_key(row, column) && "a pair the system was not made with");
    return base_numbers_[static_cast<std::size_t>(found - base_keys_.begin())];
}

void NewtonSystem::append_base_blocks(std::span<const int> vertices, std::vector<int>& numbers) const {
    for_each_lower_block(vertices, [&](int i, int j, int, int) { numbers.push_back(base_block(i, j)); });
}

void NewtonSystem::add_prescribed_block(int i, int j, const Mat3& block) {
    coupling_.segment<3>(3 * i) += block * prescribed_step_.segment<3>(3 * j);
    if (i != j)
        coupling_.segment<3>(3 * j) += block.transpose() * prescribed_step_.segment<3>(3 * i);
    const int row = row_of_vertex_[at(i)];
    const int column = row_of_vertex_[at(j)];
    if (row < 0 || column < 0)
        return;
    Mat3& values = blocks_[at(number_of(row, column))];
    for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a)
            if (!(prescribed_[at(3 * i + a)] || prescribed_[at(3 * j + b)]))
                values(a, b) += block(a, b);
}

VecX NewtonSystem::multiply(const VecX& rows) const {
    assert(rows.size() == 3 * row_count());
    VecX product = VecX::Zero(rows.size());
    for (int column = 0; column < row_count(); ++column) {
        const Vec3 factor = rows.segment<3>(3 * column);
        Vec3 sum = Vec3::Zero();
        for (int k = column_starts_[at(column)]; k < column_starts_[at(column) + 1]; ++k) {
            const Mat3& block = blocks_[at(block_numbers_[at(k)])];
            const int row = block_rows_[at(k)];
            product.segment<3>(3 * row) += block * factor;
            if (row != column)
                sum += block.transpose() * rows.segment<3>(3 * row);
        }
        product.segment<3>(3 * column) += sum;
    }
    return product;
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
