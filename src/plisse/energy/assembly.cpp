#include <plisse/energy/assembly.h>

#include <algorithm>
#include <array>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

constexpr int grain = 64;
constexpr std::size_t most_unknowns = 3 * ElementEnergy::most_vertices;

/// Runs body(element) over all elements, colour after colour.
template <typename Body>
void for_each_element(const Coloring& coloring, const Body& body) {
    for (int color = 0; color < coloring.color_count(); ++color) {
        const std::span<const int> elements = coloring.elements(color);
        parallel_for(static_cast<int>(elements.size()), grain,
                     [&](int i) { body(elements[static_cast<std::size_t>(i)]); });
    }
}

} // namespace

ElementAssembly::ElementAssembly(const ElementEnergy& energy, int vertex_count)
    : energy_(energy), coloring_(color_elements(energy.element_count(), vertex_count,
                                                [&](int element) { return energy.vertices(element); })) {}

double ElementAssembly::value(const Positions& x) const {
    return parallel_sum(energy_.element_count(), [&](int element) { return energy_.value(element, x); });
}

void ElementAssembly::add_gradient(const Positions& x, Positions& gradient) const {
    for_each_element(coloring_, [&](int element) {
        std::array<double, most_unknowns> local;
        energy_.gradient(element, x, local.data());
        const double* share = local.data();
        for (int v : energy_.vertices(element)) {
            gradient.col(v) += Eigen::Map<const Vec3>(share);
            share += 3;
        }
    });
}

void ElementAssembly::add_hessian(const Positions& x, NewtonSystem& system, bool project) const {
    for_each_element(coloring_, [&](int element) {
        std::array<double, most_unknowns * most_unknowns> local;
        energy_.hessian(element, x, project, local.data());
        const std::span<const int> vertices = energy_.vertices(element);
        if (vertices.size() == 3)
            system.add(vertices, Eigen::Map<const Eigen::Matrix<double, 9, 9>>(local.data()));
        else
            system.add(vertices, Eigen::Map<const Eigen::Matrix<double, 12, 12>>(local.data()));
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
