#include <benchmark/benchmark.h>

#include <array>

#include <plisse/base/random.h>
#include <plisse/energy/assembly.h>
#include <plisse/energy/hinge.h>
#include <plisse/energy/membrane.h>
#include <plisse/energy/pressure.h>

namespace plisse {
namespace {

/// A square sheet of n x n cells, and the same one crumpled: strains of a few per cent, hinges of about half a radian.
struct Sheet {
    explicit Sheet(int n) : rest(3, (n + 1) * (n + 1)) {
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n; ++j)
                rest.col(i * (n + 1) + j) << i, j, 0;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const int v = i * (n + 1) + j;
                faces.push_back({v, v + n + 1, v + n + 2});
                faces.push_back({v, v + n + 2, v + 1});
            }
        Random random(1);
        crumpled = rest.unaryExpr([&](double value) { return value + random.uniform(-0.2, 0.2); });
    }

    int vertex_count() const { return static_cast<int>(rest.cols()); }
    MembraneEnergy membrane() const {
        const Lame lame = plane_stress_lame(1, 0.3);
        return {rest,
                faces,
                {std::vector<double>(faces.size(), lame.mu), std::vector<double>(faces.size(), lame.lambda),
                 std::vector<double>(faces.size(), 0.01)}};
    }
    HingeEnergy hinges(HingeHessian kind) const {
        const Hinges edges = interior_hinges(Connectivity(vertex_count(), faces), faces);
        const auto count = static_cast<std::size_t>(edges.size());
        return {rest, edges.vertices, {std::vector<double>(count, 1.0), std::vector<std::uint8_t>(count, 0)}, kind};
    }

    Positions rest, crumpled;
    std::vector<Face> faces;
};

const Sheet& sheet() {
    static const Sheet made(64);
    return made;
}

/// Runs evaluate(element) over all elements again and again; "items" are elements.
template <typename Evaluate>
void run_elements(benchmark::State& state, const ElementEnergy& energy, const Evaluate& evaluate) {
    for (auto _ : state)
        for (int element = 0; element < energy.element_count(); ++element)
            evaluate(element);
    state.SetItemsProcessed(state.iterations() * energy.element_count());
}

void run_value(benchmark::State& state, const ElementEnergy& energy) {
    run_elements(state, energy, [&](int e) { benchmark::DoNotOptimize(energy.value(e, sheet().crumpled)); });
}

void run_gradient(benchmark::State& state, const ElementEnergy& energy) {
    std::array<double, 12> local;
    run_elements(state, energy, [&](int e) {
        energy.gradient(e, sheet().crumpled, local.data());
        benchmark::DoNotOptimize(local);
    });
}

void run_hessian(benchmark::State& state, const ElementEnergy& energy, bool project) {
    std::array<double, 144> local;
    run_elements(state, energy, [&](int e) {
        energy.hessian(e, sheet().crumpled, project, local.data());
        benchmark::DoNotOptimize(local);
    });
}

void membrane_value(benchmark::State& state) {
    run_value(state, sheet().membrane());
}
void membrane_gradient(benchmark::State& state) {
    run_gradient(state, sheet().membrane());
}
void membrane_hessian(benchmark::State& state) {
    run_hessian(state, sheet().membrane(), state.range(0) != 0);
}
void hinge_value(benchmark::State& state) {
    run_value(state, sheet().hinges(HingeHessian::projected));
}
void hinge_gradient(benchmark::State& state) {
    run_gradient(state, sheet().hinges(HingeHessian::projected));
}
void hinge_hessian_exact(benchmark::State& state) {
    run_hessian(state, sheet().hinges(HingeHessian::projected), false);
}
void hinge_hessian(benchmark::State& state) {
    run_hessian(state, sheet().hinges(static_cast<HingeHessian>(state.range(0))), true);
}
void pressure_hessian(benchmark::State& state) {
    run_hessian(state, PressureEnergy(sheet().rest, sheet().faces, 1), state.range(0) != 0);
}

void assembled_gradient(benchmark::State& state) {
    const HingeEnergy energy = sheet().hinges(HingeHessian::projected);
    const ElementAssembly assembly(energy, sheet().vertex_count());
    Positions gradient = Positions::Zero(3, sheet().vertex_count());
    for (auto _ : state)
        assembly.add_gradient(sheet().crumpled, gradient);
    state.SetItemsProcessed(state.iterations() * energy.element_count());
}

BENCHMARK(membrane_value);
BENCHMARK(membrane_gradient);
BENCHMARK(membrane_hessian)->ArgName("project")->Arg(0)->Arg(1);
BENCHMARK(hinge_value);
BENCHMARK(hinge_gradient);
BENCHMARK(hinge_hessian_exact);
BENCHMARK(hinge_hessian)->ArgName("kind")->Arg(0)->Arg(1);
BENCHMARK(pressure_hessian)->ArgName("project")->Arg(0)->Arg(1);
BENCHMARK(assembled_gradient);

} // namespace
} // namespace plisse
