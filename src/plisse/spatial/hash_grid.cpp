#include <plisse/spatial/hash_grid.h>

#include <bit>
#include <cassert>
#include <cmath>

namespace plisse {

namespace {

constexpr double most_cells_of_a_box = 512;

double cell_count(const std::array<std::int64_t, 3>& low, const std::array<std::int64_t, 3>& high) {
    double count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
        count *= static_cast<double>(std::max<std::int64_t>(0, high[axis] - low[axis] + 1));
    return count;
}

} // namespace

HashGrid::HashGrid(double cell_size, int id_capacity)
    : cells_per_length_(1 / cell_size), boxes_(static_cast<std::size_t>(id_capacity)),
      places_(static_cast<std::size_t>(id_capacity), Place::none),
      heads_(std::bit_ceil(static_cast<std::size_t>(4 * id_capacity + 16)), -1) {
    assert(cell_size > 0);
}

HashGrid::CellRange HashGrid::cells_of(const Box& box) const {
    const auto cell = [&](double coordinate) { // infinities of an empty box end at the clamp
        return static_cast<std::int64_t>(std::clamp(std::floor(coordinate * cells_per_length_), -1e15, 1e15));
    };
    return {{cell(box.low.x()), cell(box.low.y()), cell(box.low.z())},
            {cell(box.high.x()), cell(box.high.y()), cell(box.high.z())}};
}

std::size_t HashGrid::bucket(std::int64_t x, std::int64_t y, std::int64_t z) const {
    std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL +
                      static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fULL +
                      static_cast<std::uint64_t>(z) * 0x165667b19e3779f9ULL;
    h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ULL;
    return static_cast<std::size_t>(h >> 32) & (heads_.size() - 1);
}

template <typename Visit>
void HashGrid::for_each_bucket(const CellRange& cells, const Visit& visit) const {
    for (std::int64_t z = cells.low[2]; z <= cells.high[2]; ++z)
        for (std::int64_t y = cells.low[1]; y <= cells.high[1]; ++y)
            for (std::int64_t x = cells.low[0]; x <= cells.high[0]; ++x)
                visit(bucket(x, y, z));
}

void HashGrid::link(std::size_t bucket, int id) {
    int entry = free_entry_;
    if (entry < 0) {
        entry = static_cast<int>(entries_.size());
        entries_.push_back({});
    } else {
        free_entry_ = entries_[static_cast<std::size_t>(entry)].next;
    }
    entries_[static_cast<std::size_t>(entry)] = {id, heads_[bucket]};
    heads_[bucket] = entry;
}

void HashGrid::unlink(std::size_t bucket, int id) {
    int* place = &heads_[bucket];
    while (entries_[static_cast<std::size_t>(*place)].id != id)
        place = &entries_[static_cast<std::size_t>(*place)].next;
    const int entry = *place;
    *place = entries_[static_cast<std::size_t>(entry)].next;
    entries_[static_cast<std::size_t>(entry)].next = free_entry_;
    free_entry_ = entry;
}

void HashGrid::insert(int id, const Box& box) {
    assert(!contains(id));
    const auto i = static_cast<std::size_t>(id);
    boxes_[i] = box;
    ++size_;
    const CellRange cells = cells_of(box);
    if (cell_count(cells.low, cells.high) > most_cells_of_a_box) {
        places_[i] = Place::apart;
        apart_.push_back(id);
        return;
    }
    places_[i] = Place::cells;
    for_each_bucket(cells, [&](std::size_t bucket) { link(bucket, id); });
}

void HashGrid::remove(int id) {
    assert(contains(id));
    const auto i = static_cast<std::size_t>(id);
    if (places_[i] == Place::apart)
        std::erase(apart_, id);
    else
        for_each_bucket(cells_of(boxes_[i]), [&](std::size_t bucket) { unlink(bucket, id); });
    places_[i] = Place::none;
    --size_;
}

void HashGrid::update(int id, const Box& box) {
    assert(contains(id));
    const auto i = static_cast<std::size_t>(id);
    if (places_[i] == Place::cells && cells_of(box) == cells_of(boxes_[i])) {
        boxes_[i] = box;
        return;
    }
    remove(id);
    insert(id, box);
}

void HashGrid::query(const Box& box, std::vector<int>& ids) const {
    ids.clear();
    const CellRange cells = cells_of(box);
    if (cell_count(cells.low, cells.high) > static_cast<double>(size_)) {
        for (std::size_t i = 0; i < boxes_.size(); ++i)
            if (places_[i] != Place::none && boxes_[i].overlaps(box))
                ids.push_back(static_cast<int>(i));
        return;
    }
    for (int id : apart_)
        if (boxes_[static_cast<std::size_t>(id)].overlaps(box))
            ids.push_back(id);
    for_each_bucket(cells, [&](std::size_t bucket) {
        for (int entry = heads_[bucket]; entry >= 0;) {
            const auto [id, next] = entries_[static_cast<std::size_t>(entry)];
            if (boxes_[static_cast<std::size_t>(id)].overlaps(box))
                ids.push_back(id);
            entry = next;
        }
    });
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

} // namespace plisse
