// What each prolongation operator does to a shell: the shape at rest, a smooth bend, the forces in it, and a run.
//     compare_operators SCENE.json OUT-DIR
// The scene has one body of one material. OUT-DIR gets the bent body as each operator carries it from level 0.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <plisse/base/error.h>
#include <plisse/decimate/level_prolongation.h>
#include <plisse/drive/run.h>
#include <plisse/energy/assembly.h>
#include <plisse/energy/hinge.h>
#include <plisse/energy/membrane.h>
#include <plisse/energy/neo_hookean.h>
#include <plisse/mesh/write_ply.h>
#include <plisse/scene/build_model.h>
#include <plisse/scene/read_scene.h>
#include <plisse/spatial/box.h>

namespace plisse::comparisons {

namespace {

struct NamedOperator {
    const char* name;
    ProlongationOperator kind;
};
constexpr NamedOperator operators[] = {{"shell", ProlongationOperator::shell},
                                       {"blend", ProlongationOperator::blend},
                                       {"intrinsic", ProlongationOperator::intrinsic},
                                       {"affine", ProlongationOperator::affine}};

/// Elastic forces of a body with its first material.
class ElasticForces {
public:
    ElasticForces(const Model& model, const Positions& rest, const std::vector<Face>& faces)
        : membrane_(rest, faces, membrane_materials(model, faces.size())), bending_(bending(model, rest, faces)),
          membrane_sum_(membrane_, static_cast<int>(rest.cols())),
          bending_sum_(bending_, static_cast<int>(rest.cols())) {}

    /// On every vertex, N.
    Positions at(const Positions& x) const {
        Positions forces = Positions::Zero(3, x.cols());
        membrane_sum_.add_gradient(x, forces);
        bending_sum_.add_gradient(x, forces);
        return forces;
    }

private:
    static MembraneMaterials membrane_materials(const Model& model, std::size_t count) {
        const Material& material = model.bodies.front().material;
        const Lame lame = plane_stress_lame(material.youngs_modulus, material.poisson_ratio);
        return {std::vector<double>(count, lame.mu), std::vector<double>(count, lame.lambda),
                std::vector<double>(count, material.thickness)};
    }
    static HingeEnergy bending(const Model& model, const Positions& rest, const std::vector<Face>& faces) {
        const Material& material = model.bodies.front().material;
        const double rigidity = material.bending_scale *
                                bending_rigidity(material.youngs_modulus, material.poisson_ratio, material.thickness);
        Hinges hinges = interior_hinges(Connectivity(static_cast<int>(rest.cols()), faces), faces);
        const std::size_t count = hinges.vertices.size();
        return {rest,
                std::move(hinges.vertices),
                {std::vector<double>(count, rigidity), std::vector<std::uint8_t>(count, 0)}};
    }

    MembraneEnergy membrane_;
    HingeEnergy bending_;
    ElementAssembly membrane_sum_, bending_sum_;
};

/// Bent about the z axis, by a third of a turn over the whole, about the plane through the middle.
Positions bent(const Positions& rest, const Box& box) {
    const Vec3 middle = box.center();
    const double radius = (box.high - box.low).x() / (2 * std::numbers::pi / 3);
    Positions x(3, rest.cols());
    for (int v = 0; v < rest.cols(); ++v) {
        const Vec3 from = rest.col(v) - middle;
        const double angle = from.x() / radius;
        x.col(v) = middle + Vec3((radius + from.y()) * std::sin(angle), (radius + from.y()) * std::cos(angle) - radius,
                                 from.z());
    }
    return x;
}

struct Difference {
    double mean, largest;
};
Difference difference(const Positions& a, const Positions& b) {
    const VecX distances = (a - b).colwise().norm().transpose();
    return {distances.mean(), distances.maxCoeff()};
}

double coarse_vertices_a_row(const Prolongation& prolongation) {
    double sum = 0;
    for (int i = 0; i < prolongation.fine_count(); ++i)
        sum += static_cast<double>(prolongation.stencils().of(i).size());
    return sum / prolongation.fine_count();
}

class Comparison {
public:
    Comparison(const Model& model, Context& context, std::filesystem::path folder)
        : model_(model), context_(context), folder_(std::move(folder)),
          discretization_(model, model.hierarchy.levels, context),
          box_(bounding_box(discretization_.mesh(discretization_.finest()).rest)),
          forces_(model, finest().rest, finest().faces), simulated_(simulate_level_0(context)) {}

    void print_all() {
        fmt::print("| operator | vertices a row | rest shape lost, % of the diagonal | bend off, mean / largest, % | "
                   "noise of the forces in the bend, times the true ones | level 0: residual, iterations | the run |\n"
                   "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
        for (const NamedOperator& each : operators)
            print(each);
    }

private:
    const HierarchyLevel& finest() const { return discretization_.mesh(discretization_.finest()); }

    /// A state that no operator had a part in: level 0 simulated for itself.
    Positions simulate_level_0(Context& context) const {
        Model model = model_;
        model.solve.method = Method::direct;
        model.solve.level = 0;
        Recorder recorder;
        return run(model, {}, recorder, context).positions;
    }

    void print(const NamedOperator& each) {
        const Prolongation prolongation = prolongation_to_finest(discretization_.hierarchy(), 0, each.kind);
        const Positions& coarse = discretization_.mesh(0).rest;
        const Positions truth = bent(finest().rest, box_);
        const Positions carried = prolongation.apply(bent(coarse, box_));
        TriangleMesh mesh;
        mesh.positions = carried;
        mesh.faces = finest().faces;
        write_ply(folder_ / (std::string(each.name) + ".ply"), mesh);
        const Positions true_forces = forces_.at(truth);
        const Difference rest = difference(prolongation.apply(coarse), finest().rest);
        const Difference bend = difference(carried, truth);
        const double simulated_forces = forces_.at(prolongation.apply(simulated_)).norm();
        if (each.kind == ProlongationOperator::shell)
            shell_forces_ = simulated_forces;
        fmt::print("| {} | {:.3g} | {:.2g} | {:.2g} / {:.2g} | {:.3g} | {:.3g} |", each.name,
                   coarse_vertices_a_row(prolongation), percent(rest.largest), percent(bend.mean),
                   percent(bend.largest), (forces_.at(carried) - true_forces).norm() / true_forces.norm(),
                   simulated_forces / shell_forces_);
        std::fflush(stdout);
        print_run(each);
    }

    void print_run(const NamedOperator& each) {
        Model model = model_;
        model.hierarchy.prolongation = each.kind;
        model.solve.curvature = Curvature::own; // as in the paper; affine's rows are too dense for the other
        Recorder recorder;
        const RunReport report = run(model, {}, recorder, context_).report;
        const LevelReport& preview = report.levels.front();
        fmt::print(" {:.2g}, {}{} | {}, {} pairs, {:.0f} s |\n", preview.residual, preview.newton_iterations,
                   preview.equilibrium ? "" : ", no equilibrium", run_status_name(report.status),
                   report.intersecting_pairs, report.wall_seconds);
        std::fflush(stdout);
    }

    double percent(double distance) const { return 100 * distance / box_.diagonal(); }

    const Model& model_;
    Context& context_;
    std::filesystem::path folder_;
    Discretization discretization_;
    Box box_;
    ElasticForces forces_;
    Positions simulated_;     ///< of level 0
    double shell_forces_ = 0; ///< on the finest mesh, as shell carries that state to it, N
};

void compare(const std::string& scene, const std::string& folder) {
    std::filesystem::create_directories(folder);
    Context context;
    const Model model = build_model(read_scene(scene), context);
    Comparison(model, context, folder).print_all();
}

} // namespace

} // namespace plisse::comparisons

int main(int argc, char** argv) {
    if (argc != 3) {
        fmt::print(stderr, "usage: compare_operators SCENE.json OUT-DIR\n");
        return 2;
    }
    try {
        plisse::comparisons::compare(argv[1], argv[2]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "compare_operators: {}\n", error.what());
        return 2;
    }
    return 0;
}
