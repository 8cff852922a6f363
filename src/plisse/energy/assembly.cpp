#include <plisse/energy/assembly.h>

#include <algorithm>
#include <array>
#include <cassert>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

constexpr int group_size = 32; // 100 kB of blocks of hinges, and groups enough for many threads
constexpr std::size_t most_unknowns = 3 * ElementEnergy::most_vertices;

} // namespace

ElementAssembly::ElementAssembly(const ElementEnergy& energy, int vertex_count)
    : energy_(energy), groups_(color_groups(energy.element_count(), vertex_count, group_size,
                                            [&](int element) { return energy.vertices(element); })) {}

/// Runs body(element) over all elements, colour after colour.
template <typename Body>
void ElementAssembly::for_each_element(const Body& body) const {
    const Coloring& coloring = groups_.coloring;
    for (int color = 0; color < coloring.color_count(); ++color) {
        const std::span<const int> groups = coloring.elements(color);
        parallel_for(static_cast<int>(groups.size()), 1, [&](int g) {
            for (int element : groups_.group(groups[static_cast<std::size_t>(g)]))
                body(element);
        });
    }
}

double ElementAssembly::value(const Positions& x) const {
    return parallel_sum(energy_.element_count(), [&](int element) { return energy_.value(element, x); });
}

void ElementAssembly::add_gradient(const Positions& x, Positions& gradient) const {
    for_each_element([&](int element) {
        std::array<double, most_unknowns> local;
        energy_.gradient(element, x, local.data());
        const double* share = local.data();
        for (int v : energy_.vertices(element)) {
            gradient.col(v) += Eigen::Map<const Vec3>(share);
            share += 3;
        }
    });
}

void ElementAssembly::place_in(const NewtonSystem& system) {
    block_numbers_.clear();
    block_starts_.clear();
    for (int element = 0; element < energy_.element_count(); ++element) {
        block_starts_.push_back(block_numbers_.size());
        system.append_base_blocks(energy_.vertices(element), block_numbers_);
    }
}

void ElementAssembly::add_hessian(const Positions& x, NewtonSystem& system, bool project) const {
    assert(block_starts_.size() == static_cast<std::size_t>(energy_.element_count()) && "place_in comes first");
    for_each_element([&](int element) {
        std::array<double, most_unknowns * most_unknowns> local;
        energy_.hessian(element, x, project, local.data());
        const std::span<const int> vertices = energy_.vertices(element);
        const int* numbers = block_numbers_.data() + block_starts_[static_cast<std::size_t>(element)];
        const auto unknowns = static_cast<Eigen::Index>(3 * vertices.size());
        system.add(vertices, numbers, Eigen::Map<const Eigen::MatrixXd>(local.data(), unknowns, unknowns));
    });
}

std::vector<Edge> ElementAssembly::pairs() const {
    std::vector<Edge> pairs;
    for (int element = 0; element < energy_.element_count(); ++element) {
        const std::span<const int> vertices = energy_.vertices(element);
        for (std::size_t j = 1; j < vertices.size(); ++j)
            for (std::size_t i = 0; i < j; ++i)
                pairs.push_back({std::min(vertices[i], vertices[j]), std::max(vertices[i], vertices[j])});
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

} // namespace plisse
