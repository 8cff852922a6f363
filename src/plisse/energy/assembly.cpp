#include <plisse/energy/assembly.h>

#include <array>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

constexpr int group_size = 32; // 100 kB of blocks of hinges, and groups enough for many threads
constexpr std::size_t most_unknowns = 3 * ElementEnergy::most_vertices;

} // namespace

ElementAssembly::ElementAssembly(const ElementEnergy& energy, int vertex_count)
    : energy_(energy), elements_(energy.element_count(), vertex_count, group_size,
                                 [&energy](int element) { return energy.vertices(element); }) {}

double ElementAssembly::value(const Positions& x) const {
    return parallel_sum(energy_.element_count(), [&](int element) { return energy_.value(element, x); });
}

void ElementAssembly::add_gradient(const Positions& x, Positions& gradient) const {
    elements_.for_each([&](int element) {
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
    elements_.for_each([&](int element) {
        std::array<double, most_unknowns * most_unknowns> local;
        energy_.hessian(element, x, project, local.data());
        const std::span<const int> vertices = energy_.vertices(element);
        const auto unknowns = static_cast<Eigen::Index>(3 * vertices.size());
        system.add(vertices, elements_.block_numbers(element),
                   Eigen::Map<const Eigen::MatrixXd>(local.data(), unknowns, unknowns));
    });
}

} // namespace plisse
