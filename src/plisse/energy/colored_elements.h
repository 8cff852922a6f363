#pragma once

#include <functional>
#include <span>
#include <vector>

#include <plisse/base/parallel.h>
#include <plisse/linalg/coloring.h>
#include <plisse/linalg/newton_system.h>

namespace plisse {

/// The elements of an energy by their vertices: loops that add to vertices in parallel, with the same bits for any
/// number of threads, and the places of the elements' blocks in a Newton system. Elements are grouped and the groups
/// coloured once, so that those of one colour share no vertex, and colours are added in turn.
class ColoredElements {
public:
    using VerticesOf = std::function<std::span<const int>(int)>;
    /// vertices_of(e): vertices of element e in [0, vertex_count), distinct; they must not change. group_size: elements
    /// that one thread takes at a time.
    ColoredElements(int element_count, int vertex_count, int group_size, VerticesOf vertices_of);

    /// Runs body(element) over all elements, colour after colour.
    template <typename Body>
    void for_each(const Body& body) const {
        const Coloring& coloring = groups_.coloring;
        for (int color = 0; color < coloring.color_count(); ++color) {
            const std::span<const int> groups = coloring.elements(color);
            parallel_for(static_cast<int>(groups.size()), 1, [&](int g) {
                for (int element : groups_.group(groups[static_cast<std::size_t>(g)]))
                    body(element);
            });
        }
    }

    /// Finds the elements' blocks in the system, which was made with pairs().
    void place_in(const NewtonSystem& system);
    /// Of an element's blocks, in the order in which NewtonSystem::add wants them; place_in comes first.
    const int* block_numbers(int element) const;
    /// Pairs of vertices that elements share, lower first, ascending.
    std::vector<Edge> pairs() const;

private:
    int element_count_;
    VerticesOf vertices_of_;
    ColoredGroups groups_;
    std::vector<int> block_numbers_;
    std::vector<std::size_t> block_starts_; ///< of each element's in block_numbers_
};

} // namespace plisse
