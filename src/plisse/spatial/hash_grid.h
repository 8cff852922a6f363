#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <plisse/spatial/box.h>

namespace plisse {

/// Boxes that come, move and go, found by place: a uniform grid whose cells are hashed into buckets. Answers depend on
/// the boxes alone, never on the order in which they came.
class HashGrid {
public:
    /// cell_size: edge of a cell, > 0, best about the size of the boxes; id_capacity: ids are in [0, id_capacity).
    HashGrid(double cell_size, int id_capacity);

    /// Adds a box under an id that is not in use. An empty box is kept and never found.
    void insert(int id, const Box& box);
    void remove(int id);
    /// Moves the box of an id in use.
    void update(int id, const Box& box);

    bool contains(int id) const { return places_[static_cast<std::size_t>(id)] != Place::none; }
    const Box& box(int id) const { return boxes_[static_cast<std::size_t>(id)]; }
    int size() const { return size_; }

    /// Ids of the boxes that touch `box`, ascending, each once; `ids` is cleared first. Safe from several threads at
    /// once as long as nothing changes.
    void query(const Box& box, std::vector<int>& ids) const;

private:
    /// A box that would fill many cells is listed apart and looked at in every query.
    enum class Place : std::uint8_t { none, cells, apart };
    struct CellRange {
        std::array<std::int64_t, 3> low, high;
        bool operator==(const CellRange&) const = default;
    };
    struct Entry {
        int id, next;
    };

    CellRange cells_of(const Box& box) const;
    std::size_t bucket(std::int64_t x, std::int64_t y, std::int64_t z) const;
    template <typename Visit>
    void for_each_bucket(const CellRange& cells, const Visit& visit) const;
    void link(std::size_t bucket, int id);
    void unlink(std::size_t bucket, int id);

    double cells_per_length_;
    std::vector<Box> boxes_;
    std::vector<Place> places_;
    std::vector<int> apart_;
    std::vector<int> heads_; // per bucket, its first entry or -1
    std::vector<Entry> entries_;
    int free_entry_ = -1;
    int size_ = 0;
};

} // namespace plisse
