#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace plisse {

/// Sets of numbers that are joined.
class Unions {
public:
    explicit Unions(int count) : parent_(static_cast<std::size_t>(count)) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    /// The lowest member of the set.
    int root(int v) {
        while (parent_[static_cast<std::size_t>(v)] != v) {
            auto& p = parent_[static_cast<std::size_t>(v)];
            p = parent_[static_cast<std::size_t>(p)];
            v = p;
        }
        return v;
    }
    void join(int a, int b) {
        a = root(a);
        b = root(b);
        parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }

private:
    std::vector<int> parent_;
};

} // namespace plisse
