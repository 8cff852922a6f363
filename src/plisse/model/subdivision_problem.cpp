#include <plisse/model/subdivision_problem.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace plisse {

namespace {

constexpr int quadrature_side = 3; // Gauss points of the elastic energy along a face's side
constexpr int mass_side = 4;       // and of products of two basis functions, for which they are exact

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

ShellSection section_of(const SubdivisionModel& model) {
    const Material& material = model.material;
    const auto response = [&] {
        switch (material.law) {
        case MaterialLaw::denim_table:
            return denim_table();
        case MaterialLaw::denim_stable:
            return denim_stable();
        case MaterialLaw::isotropic:
            break;
        }
        return isotropic_material(material.youngs_modulus, material.poisson_ratio);
    };
    return ShellSection(response(), material.thickness, model.solve.rmtr.thickness_points);
}

Eigen::SparseMatrix<double> mass_of(const SubdivisionModel& model, int level) {
    const Positions& rest = model.levels.rest(level);
    const SurfaceBasis basis = model.levels.surface_basis(level, mass_side);
    const double per_area = model.material.density * model.material.thickness;
    return per_area * consistent_matrix(surface_samples(basis, rest), static_cast<int>(rest.cols()));
}

using SampleRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

SampleRows rows_of(const SurfaceSamples& samples, int vertex_count) {
    SampleRows rows(samples.count(), vertex_count);
    rows.setFromTriplets(samples.values.begin(), samples.values.end());
    return rows;
}

SurfaceSamples carried_down(const SurfaceSamples& fine, const VertexWeights& subdivision) {
    const SampleRows rows = rows_of(fine, static_cast<int>(subdivision.rows())) * SampleRows(subdivision);
    SurfaceSamples coarse;
    coarse.weights = fine.weights;
    for (int r = 0; r < rows.outerSize(); ++r)
        for (SampleRows::InnerIterator entry(rows, r); entry; ++entry)
            coarse.values.emplace_back(r, entry.col(), entry.value());
    return coarse;
}

Edge ends_of(const ControlMesh& mesh, const BoundarySide& side) {
    const Quad& quad = mesh.faces[at(side.face)];
    return {quad[at(side.side)], quad[at((side.side + 1) % 4)]};
}

double mean_side(const SubdivisionModel& model) {
    const int finest = model.levels.level_count() - 1;
    const Positions points = model.levels.rest(finest) * model.levels.limit_points(finest).weights.transpose();
    const ControlMesh& mesh = model.levels.mesh(finest);
    double sum = 0;
    for (const BoundarySide& side : mesh.boundary) {
        const auto [a, b] = ends_of(mesh, side);
        sum += (points.col(a) - points.col(b)).norm();
    }
    return sum / static_cast<double>(mesh.boundary.size());
}

HeldPlaces held_on_finest(const SubdivisionModel& model) {
    const int finest = model.levels.level_count() - 1;
    const Positions& rest = model.levels.rest(finest);
    const BoundaryBasis basis = model.levels.boundary_basis(finest);
    const SampleRows limits = model.levels.limit_points(finest).weights;
    HeldPlaces held;
    for (std::size_t h = 0; h < model.handles.size(); ++h) {
        for (const int side : model.handles[h].sides) {
            const EdgeStencil& stencil = basis.stencil(side);
            append_edge(basis.control_points(side), stencil.value, stencil.tangent, basis.weights(), rest,
                        held.samples);
        }
        for (const int point : model.handles[h].points) {
            std::vector<int> control_points;
            std::vector<double> weights;
            for (SampleRows::InnerIterator entry(limits, point); entry; ++entry) {
                control_points.push_back(static_cast<int>(entry.col()));
                weights.push_back(entry.value());
            }
            held.samples.append(control_points, Eigen::Map<const VecX>(weights.data(), std::ssize(weights)),
                                mean_side(model));
        }
        held.handle.resize(at(held.samples.count()), static_cast<int>(h));
    }
    held.rest = rest * rows_of(held.samples, static_cast<int>(rest.cols())).transpose();
    return held;
}

} // namespace

std::vector<HeldPlaces> held_places(const SubdivisionModel& model) {
    std::vector<HeldPlaces> levels(at(model.levels.level_count()));
    levels.back() = held_on_finest(model);
    for (int l = model.levels.level_count() - 2; l >= 0; --l) {
        levels[at(l)] = levels[at(l + 1)];
        levels[at(l)].samples = carried_down(levels[at(l + 1)].samples, model.levels.subdivision(l));
    }
    return levels;
}

double boundary_penalty(const SubdivisionModel& model) {
    return model.solve.rmtr.penalty.value_or(std::pow(mean_side(model), -5));
}

SubdivisionProblem::SubdivisionProblem(const SubdivisionModel& model, int level, HeldPlaces held, double penalty,
                                       Context& context, SurfaceContact* contact, const VertexWeights& to_surface)
    : model_(model), held_(std::move(held)), penalty_(penalty), context_(context),
      basis_(model.levels.surface_basis(level, quadrature_side)),
      shell_(basis_, model.levels.rest(level), section_of(model), model.warp_on(level)), mass_(mass_of(model, level)),
      inertia_(mass_, model.levels.rest(level)), boundary_(held_.samples, penalty, model.levels.rest(level)),
      gravity_(Positions::Zero(3, mass_.cols())),
      contact_(contact ? std::make_unique<LevelContact>(*contact, to_surface) : nullptr),
      no_targets_(VecX::Zero(3 * mass_.cols())) {
    std::set<Edge> pairs;
    for (const AssembledEnergy* part : std::initializer_list<const AssembledEnergy*>{&shell_, &inertia_, &boundary_})
        for (const Edge& pair : part->pairs())
            pairs.insert(pair);
    const std::vector<Edge> sorted(pairs.begin(), pairs.end());
    system_ = NewtonSystem(std::vector<std::uint8_t>(at(static_cast<int>(no_targets_.size())), 0), sorted);
    system_.set_prescribed_step(no_targets_);
    shell_.place_in(system_);
    inertia_.place_in(system_);
    boundary_.place_in(system_);
}

void SubdivisionProblem::begin_step(const SurfaceStep& step, Positions inertial) {
    has_inertia_ = step.time_step > 0;
    if (has_inertia_) {
        inertia_.set_time_step(step.time_step);
        inertia_.set_target(std::move(inertial));
    }
    gravity_ = DeadLoads(surface_weight(mass_, model_.gravity.at(step.t)));
    Positions targets = held_.rest;
    for (std::size_t p = 0; p < held_.handle.size(); ++p) {
        const auto column = static_cast<Eigen::Index>(p);
        targets.col(column) = model_.handles[at(held_.handle[p])].motion.apply(held_.rest.col(column), step.t);
    }
    boundary_.set_targets(std::move(targets));
    system_.reset_pattern();
    if (contact_)
        contact_->stand_alone();
}

template <typename Visit>
void SubdivisionProblem::for_each_part(const Visit& visit) const {
    visit(shell_);
    visit(boundary_);
    visit(gravity_);
    if (has_inertia_)
        visit(inertia_);
}

double SubdivisionProblem::value(const VecX& x) {
    const PhaseScope scope(context_.times, Phase::elastic);
    double sum = 0;
    for_each_part([&](const AssembledEnergy& part) { sum += part.value(as_positions(x)); });
    return contact_ && std::isfinite(sum) ? sum + contact_->value(as_positions(x)) : sum;
}

void SubdivisionProblem::gradient(const VecX& x, VecX& gradient) {
    const PhaseScope scope(context_.times, Phase::elastic);
    Positions sum = Positions::Zero(3, x.size() / 3);
    for_each_part([&](const AssembledEnergy& part) { part.add_gradient(as_positions(x), sum); });
    if (contact_)
        contact_->add_gradient(as_positions(x), sum);
    gradient = as_vector(sum);
}

void SubdivisionProblem::assemble(const VecX& x, NewtonSystem& system, bool project) {
    const PhaseScope scope(context_.times, Phase::elastic);
    static const std::vector<Edge> none;
    system.begin(contact_ ? contact_->find_hessian(as_positions(x), project) : none);
    for_each_part([&](const AssembledEnergy& part) { part.add_hessian(as_positions(x), system, project); });
    if (contact_)
        contact_->add_hessian(system);
}

double SubdivisionProblem::max_step(const VecX& x, const VecX& d) {
    return contact_ ? contact_->max_step(as_positions(x), as_positions(d)) : 1;
}

StepLimit SubdivisionProblem::step_limit(const VecX& x, const VecX& d) {
    return max_step(x, d) < 1 ? StepLimit{"contact", "surfaces are near each other"} : StepLimit{};
}

SubdivisionProblem::Energies SubdivisionProblem::energies(const VecX& x) {
    const Positions q = as_positions(x);
    const double friction = contact_ ? contact_->friction(q) : 0;
    return {shell_.value(q),
            gravity_.value(q),
            has_inertia_ ? inertia_.value(q) : 0,
            boundary_.value(q),
            contact_ ? contact_->value(q) - friction : 0,
            friction};
}

SubdivisionProblem::Holding SubdivisionProblem::holding(const VecX& x) const {
    Holding holding{boundary_.points(as_positions(x)), {}};
    const Eigen::Map<const VecX> lengths(held_.samples.weights.data(), std::ssize(held_.samples.weights));
    holding.forces = penalty_ * (boundary_.targets() - holding.places) * lengths.asDiagonal();
    return holding;
}

std::vector<double> SubdivisionProblem::away_from_targets(const VecX& x) const {
    const VecX away = (boundary_.targets() - boundary_.points(as_positions(x))).colwise().norm().transpose();
    return {away.begin(), away.end()};
}

double SubdivisionProblem::residual(const VecX& x) {
    Positions total = Positions::Zero(3, x.size() / 3);
    double largest = 0;
    const auto add = [&](auto& part) {
        Positions forces = Positions::Zero(3, x.size() / 3);
        part.add_gradient(as_positions(x), forces);
        largest = std::max(largest, forces.colwise().norm().maxCoeff());
        total += forces;
    };
    for_each_part([&](const AssembledEnergy& part) { add(part); });
    if (contact_)
        add(*contact_);
    return largest > 0 ? total.colwise().norm().maxCoeff() / largest : 0;
}

double SubdivisionProblem::largest_stretch(const VecX& x) const {
    const Positions q = as_positions(x);
    double largest = 0;
    for (int f = 0; f < basis_.face_count(); ++f)
        for (int p = 0; p < basis_.point_count(); ++p) {
            const Vec3 e = shell_.deformation(f, p, q).strain;
            const double principal = 0.5 * (e[0] + e[1]) + std::hypot(0.5 * (e[0] - e[1]), e[2]);
            largest = std::max(largest, principal);
        }
    return std::sqrt(1 + 2 * largest);
}

} // namespace plisse
