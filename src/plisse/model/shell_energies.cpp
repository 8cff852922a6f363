#include <plisse/model/shell_energies.h>

#include <algorithm>

#include <plisse/mesh/connectivity.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

std::unique_ptr<MembraneEnergy> make_membrane(const Model& model, const Positions& rest, const std::vector<Face>& faces,
                                              const std::vector<int>& face_body) {
    MembraneMaterials materials;
    for (int body : face_body) {
        const Material& material = model.bodies[at(body)].material;
        const Lame lame = plane_stress_lame(material.youngs_modulus, material.poisson_ratio);
        materials.mu.push_back(lame.mu);
        materials.lambda.push_back(lame.lambda);
        materials.thickness.push_back(material.thickness);
    }
    return std::make_unique<MembraneEnergy>(rest, faces, std::move(materials));
}

/// The faces of bodies that bend, by one model.
struct BentFaces {
    std::vector<Face> faces;
    std::vector<int> body;          ///< of each
    std::vector<std::uint8_t> held; ///< whether one script holds the whole face
};

bool is_held(const Face& face, const LevelLayout& layout) {
    for (int v : face)
        for (int a = 0; a < 3; ++a)
            if (!layout.prescribed[at(3 * v + a)] ||
                layout.script_of[at(3 * v + a)] != layout.script_of[at(3 * face[0])])
                return false;
    return true;
}

BentFaces faces_bent_by(BendingModel bending, const Model& model, const LevelLayout& layout) {
    BentFaces bent;
    for (std::size_t f = 0; f < layout.body_faces.size(); ++f)
        if (const Material& material = model.bodies[at(layout.body_face_part[f])].material;
            material.bending == bending && material.bending_scale > 0) {
            bent.faces.push_back(layout.body_faces[f]);
            bent.body.push_back(layout.body_face_part[f]);
            bent.held.push_back(is_held(layout.body_faces[f], layout));
        }
    return bent;
}

double scaled_rigidity(const Material& material) {
    return material.bending_scale *
           bending_rigidity(material.youngs_modulus, material.poisson_ratio, material.thickness);
}

std::unique_ptr<HingeEnergy> make_hinges(const Model& model, const Positions& rest, const BentFaces& bent) {
    const Connectivity connectivity(static_cast<int>(rest.cols()), bent.faces);
    Hinges hinges = interior_hinges(connectivity, bent.faces);
    const std::vector<double> shares = hinge_shares(hinges, connectivity, bent.faces, rest);
    HingeMaterials materials;
    for (std::size_t h = 0; h < shares.size(); ++h) {
        const Body& body = model.bodies[at(bent.body[at(hinges.faces[h][0])])];
        materials.scaled_rigidity.push_back(shares[h] * scaled_rigidity(body.material));
        // Sheets can be flat, but not where they are joined.
        materials.flat.push_back(body.flat_rest_angles && !connectivity.is_curve_edge(hinges.edges[h]));
    }
    return std::make_unique<HingeEnergy>(rest, std::move(hinges.vertices), materials, HingeHessian::projected);
}

std::unique_ptr<KoiterBending> make_koiter(const Model& model, const Positions& rest, const BentFaces& bent) {
    KoiterMaterials materials;
    for (std::size_t f = 0; f < bent.faces.size(); ++f) {
        const Body& body = model.bodies[at(bent.body[f])];
        // A clamp holds normals too: without this they would give way by a turn within the row of faces behind it.
        constexpr double clamp = 1e4;
        materials.scaled_rigidity.push_back((bent.held[f] ? clamp : 1) * scaled_rigidity(body.material));
        materials.poisson_ratio.push_back(body.material.poisson_ratio);
        materials.flat.push_back(body.flat_rest_angles);
    }
    return std::make_unique<KoiterBending>(rest, bent.faces, materials);
}

} // namespace

ShellEnergies::ShellEnergies(const Model& model, const Positions& rest, const LevelLayout& layout, Parts parts)
    : model_(model), vertex_count_(static_cast<int>(rest.cols())) {
    const std::vector<Face>& faces = layout.body_faces;
    const std::vector<int>& face_body = layout.body_face_part;
    if (parts.membrane)
        add_term(make_membrane(model, rest, faces, face_body));
    if (parts.bending) {
        if (const BentFaces bent = faces_bent_by(BendingModel::hinge, model, layout); !bent.faces.empty())
            add_term(make_hinges(model, rest, bent));
        if (const BentFaces bent = faces_bent_by(BendingModel::koiter, model, layout); !bent.faces.empty())
            elastic_.push_back({nullptr, make_koiter(model, rest, bent)});
    }
    if (!parts.pressure)
        return;
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const auto& keys = model.bodies[b].pressure.keys;
        if (std::all_of(keys.begin(), keys.end(), [](const auto& key) { return key.value == 0; }))
            continue;
        std::vector<Face> of_body;
        for (std::size_t f = 0; f < faces.size(); ++f)
            if (face_body[f] == static_cast<int>(b))
                of_body.push_back(faces[f]);
        if (!boundary_pieces(Connectivity(vertex_count_, of_body)).empty()) {
            open_.push_back({static_cast<int>(b), std::move(of_body)});
            continue;
        }
        auto energy = std::make_unique<PressureEnergy>(rest, std::move(of_body));
        auto assembly = std::make_unique<ElementAssembly>(*energy, vertex_count_);
        closed_.push_back({static_cast<int>(b), std::move(energy), std::move(assembly)});
    }
}

void ShellEnergies::add_term(std::unique_ptr<ElementEnergy> energy) {
    auto assembly = std::make_unique<ElementAssembly>(*energy, vertex_count_);
    elastic_.push_back({std::move(energy), std::move(assembly)});
}

void ShellEnergies::set_time(double t) {
    for (ClosedBody& closed : closed_)
        closed.energy->set_pressure(model_.bodies[at(closed.body)].pressure.at(t));
}

double ShellEnergies::elastic_value(const Positions& y) const {
    double sum = 0;
    for (const Term& term : elastic_)
        sum += term.sum->value(y);
    return sum;
}

void ShellEnergies::add_elastic_gradient(const Positions& y, Positions& gradient) const {
    for (const Term& term : elastic_)
        term.sum->add_gradient(y, gradient);
}

double ShellEnergies::pressure_value(const Positions& y) const {
    double sum = 0;
    for (const ClosedBody& closed : closed_)
        sum += closed.assembly->value(y);
    return sum;
}

void ShellEnergies::add_pressure_gradient(const Positions& y, Positions& gradient) const {
    for (const ClosedBody& closed : closed_)
        closed.assembly->add_gradient(y, gradient);
}

void ShellEnergies::place_in(const NewtonSystem& system) {
    for (Term& term : elastic_)
        term.sum->place_in(system);
}

void ShellEnergies::add_hessian(const Positions& y, NewtonSystem& system, bool project) const {
    for (const Term& term : elastic_)
        term.sum->add_hessian(y, system, project);
}

std::vector<Edge> ShellEnergies::pairs() const {
    std::vector<Edge> all;
    for (const Term& term : elastic_) {
        const std::vector<Edge> pairs = term.sum->pairs();
        all.insert(all.end(), pairs.begin(), pairs.end());
    }
    return all;
}

Positions ShellEnergies::open_pressure_forces(const Positions& y, double t) const {
    Positions forces = Positions::Zero(3, y.cols());
    for (const OpenBody& open : open_)
        forces += pressure_forces(y, open.faces, model_.bodies[at(open.body)].pressure.at(t));
    return forces;
}

} // namespace plisse
