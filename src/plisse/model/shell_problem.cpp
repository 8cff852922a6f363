#include <plisse/model/shell_problem.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <plisse/base/parallel.h>
#include <plisse/contact/candidates.h>
#include <plisse/decimate/level_prolongation.h>
#include <plisse/geometry/triangle_motion.h>
#include <plisse/model/barrier_stiffness.h>
#include <plisse/spatial/box.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

constexpr int chunk_size = 512;

/// Largest fraction of the motion over which no triangle comes near collapsing, and the first that would.
struct RegularStep {
    double length = 1;
    int face = -1;
};

RegularStep largest_regular_step(const std::vector<Face>& faces, const Positions& x, const Positions& d) {
    std::vector<RegularStep> limits(at(chunk_count(static_cast<int>(faces.size()), chunk_size)));
    parallel_chunks(static_cast<int>(faces.size()), chunk_size, [&](int chunk, int begin, int end) {
        RegularStep limit;
        for (int f = begin; f < end; ++f) {
            const Face& face = faces[at(f)];
            const Vec3 e1 = x.col(face[1]) - x.col(face[0]);
            const Vec3 e2 = x.col(face[2]) - x.col(face[0]);
            const Vec3 d1 = d.col(face[1]) - d.col(face[0]);
            const Vec3 d2 = d.col(face[2]) - d.col(face[0]);
            if (const double length = regular_step(e1, e2, d1, d2); length < limit.length)
                limit = {length, f};
        }
        limits[at(chunk)] = limit;
    });
    const auto shorter = [](const RegularStep& a, const RegularStep& b) { return a.length < b.length; };
    return limits.empty() ? RegularStep{} : *std::min_element(limits.begin(), limits.end(), shorter);
}

/// Of the body that asks for most.
double contact_stiffness(const Model& model) {
    double stiffness = 0;
    for (const Body& body : model.bodies) {
        const auto vertices = model.mesh.positions.middleCols(body.vertices.begin, body.vertices.size());
        stiffness = std::max(stiffness, barrier_stiffness(body.material, bounding_box(vertices).diagonal()));
    }
    return stiffness;
}

std::string place_in_words(const Vec3& place) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g})", place.x(), place.y(), place.z());
}

double largest_norm(const Positions& forces) {
    return forces.cols() ? forces.colwise().norm().maxCoeff() : 0.0;
}

} // namespace

struct ShellProblem::Carrier {
    Prolongation prolongation;
    NewtonSystem fine_hessian; ///< of the carried elastic energies; empty unless the curvature is Galerkin's
    GalerkinProduct product;
};

ShellProblem::ShellProblem(const Discretization& discretization, int level, EnergiesOf energies_of, Context& context)
    : discretization_(discretization), context_(context), level_(level), dead_loads_(discretization),
      triangles_(discretization.mesh(level).rest, discretization.layout(level).body_faces),
      strain_limit_(discretization, level) {
    const Model& model = discretization.model();
    const HierarchyLevel& mesh = discretization.mesh(level);
    const LevelLayout& layout = discretization.layout(level);
    const Hierarchy& hierarchy = discretization.hierarchy();
    const int finest = discretization.finest();
    const LevelLayout& fine_layout = discretization.layout(finest);
    const bool proxy = level < finest && energies_of == EnergiesOf::finest;
    const bool bending_on_level = proxy && model.hierarchy.bending_on == BendingOn::level;

    if (level < finest) {
        Prolongation prolongation = prolongation_to_finest(hierarchy, level, model.hierarchy.prolongation);
        mass_ = prolongation.pull_back_values(dead_loads_.masses());
        if (proxy)
            carrier_ = std::make_unique<Carrier>(Carrier{std::move(prolongation), {}, {}});
    } else {
        mass_ = dead_loads_.masses();
    }

    pulls_ = Pulls(discretization, proxy ? finest : level);
    if (proxy) {
        elasticity_ = std::make_unique<ShellEnergies>(model, hierarchy.finest().rest, fine_layout,
                                                      ShellEnergies::Parts{true, !bending_on_level, true});
        if (bending_on_level)
            level_bending_ =
                std::make_unique<ShellEnergies>(model, mesh.rest, layout, ShellEnergies::Parts{false, true, false});
        if (!uses_galerkin()) {
            level_pulls_ = Pulls(discretization, level);
            curvature_ = std::make_unique<ShellEnergies>(model, mesh.rest, layout,
                                                         ShellEnergies::Parts{true, !bending_on_level, false});
        } else {
            carrier_->product =
                GalerkinProduct(carrier_->prolongation.stencils(), vertex_count(), elasticity_->pairs());
            carrier_->fine_hessian =
                NewtonSystem(std::vector<std::uint8_t>(3 * at(carrier_->prolongation.fine_count()), 0),
                             carrier_->product.fine_pairs());
        }
    } else {
        elasticity_ = std::make_unique<ShellEnergies>(model, mesh.rest, layout, ShellEnergies::Parts{});
    }

    std::vector<std::uint8_t> obstacle(at(model.part_count()), 0);
    for (int part = 0; part < model.part_count(); ++part)
        obstacle[at(part)] = model.is_obstacle(part);
    ContactOptions options;
    options.distance = model.contact.distance;
    options.thickness = model.contact.thickness;
    options.self = model.contact.self;
    options.stiffness = contact_stiffness(model);
    contact_ = std::make_unique<Contact>(CollisionMesh(mesh.rest, mesh.faces, mesh.part, obstacle), options);
    contact_->set_times(&context.times);
    friction_ = std::make_unique<Friction>(contact_->mesh(),
                                           FrictionOptions{model.contact.friction_velocity * model.solve.time_step,
                                                           friction_coefficients(model.contact, model.part_count())});
    build_system(layout.prescribed);

    estimate_round_off();
}

ShellProblem::~ShellProblem() = default;

/// Of elastic energies. It goes by the bodies' own size: an obstacle may be as large as a landscape.
void ShellProblem::estimate_round_off() {
    const HierarchyLevel& mesh = discretization_.mesh(level_);
    const std::vector<Body>& bodies = discretization_.model().bodies;
    std::vector<Box> boxes(bodies.size());
    for (std::size_t v = 0; v < mesh.part.size(); ++v)
        if (const auto part = at(mesh.part[v]); part < boxes.size())
            boxes[part].include(mesh.rest.col(static_cast<Eigen::Index>(v)));
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const double stiffness = bodies[b].material.youngs_modulus * bodies[b].material.thickness;
        const double diagonal = boxes[b].diagonal();
        force_round_off_ = std::max(force_round_off_, 1e-12 * stiffness * diagonal);
        value_round_off_ = std::max(value_round_off_, 1e-16 * stiffness * diagonal * diagonal);
    }
}

bool ShellProblem::uses_galerkin() const {
    return discretization_.model().solve.curvature != Curvature::own;
}

void ShellProblem::build_system(const std::vector<std::uint8_t>& prescribed) {
    std::vector<Edge> pairs;
    const auto append = [&](const std::vector<Edge>& more) { pairs.insert(pairs.end(), more.begin(), more.end()); };
    append(contact_->mesh().edges); // which contact couples too
    if (carrier_) {
        append(carrier_->product.pairs());
        if (curvature_)
            append(curvature_->pairs());
        if (level_bending_)
            append(level_bending_->pairs());
    } else {
        append(elasticity_->pairs());
    }
    for (int v = 0; v < vertex_count(); ++v)
        pairs.push_back({v, v});
    std::sort(pairs.begin(), pairs.end()); // blocks of neighbours near each other
    system_ = NewtonSystem(prescribed, pairs);

    if (carrier_ && !curvature_) {
        elasticity_->place_in(carrier_->fine_hessian);
        carrier_->product.place_in(system_);
    } else {
        (curvature_ ? curvature_ : elasticity_)->place_in(system_);
    }
    if (level_bending_)
        level_bending_->place_in(system_);
    strain_limit_.place_in(system_);
}

void ShellProblem::begin_step(const Positions& current, const Positions& anchor, double t, double h, bool is_first) {
    set_step(current, anchor, t, h);
    begin_friction(current, {current, {}}, is_first);
}

void ShellProblem::begin_settling_step(const Positions& current, double t, double h, const FrictionMemory& memory) {
    set_step(current, current, t, h);
    begin_friction(current, memory, memory.reference.cols() == 0);
}

void ShellProblem::begin_relaxation(const Positions& current, const std::vector<std::uint8_t>& held, double least_room,
                                    double stiffening) {
    assert(!carrier_);
    strain_limit_.raise(current, least_room, stiffening);
    build_system(held);
    targets_ = as_vector(current);
    anchor_ = current;
    const double h = discretization_.model().solve.time_step;
    inverse_h_squared_ = 1 / (h * h);
    gravity_forces_ = load_forces_ = Positions::Zero(3, current.cols());
    pulls_ = Pulls();
    contact_->forget();
    x_memo_.resize(3, 0);
}

void ShellProblem::begin_friction(const Positions& current, const FrictionMemory& memory, bool is_first) {
    if (!friction_->possible())
        return;
    friction_->begin(memory);
    friction_->lag(contact_->active_pairs(current), current, is_first ? Friction::first_grip : 1);
}

void ShellProblem::remember_friction(const VecX& x) {
    if (!friction_->possible())
        return;
    const Positions& points = level_positions(x);
    friction_->remember(contact_->active_pairs(points), points);
}

bool ShellProblem::update_friction(const VecX& x, double share) {
    if (!friction_->possible())
        return false;
    const Positions& points = level_positions(x);
    friction_->lag(contact_->active_pairs(points), points, 1, share);
    return true;
}

void ShellProblem::set_step(const Positions& current, const Positions& anchor, double t, double h) {
    targets_ = as_vector(discretization_.script(level_, t));
    anchor_ = anchor;
    inverse_h_squared_ = 1 / (h * h);
    elasticity_->set_time(t);
    gravity_forces_ = dead_loads_.weight(t);
    load_forces_ = dead_loads_.loads(t);
    pulls_.set_time(t);
    if (!carrier_ && level_ < discretization_.finest()) {
        const Prolongation prolongation =
            prolongation_to_finest(discretization_.hierarchy(), level_, ProlongationOperator::intrinsic);
        gravity_forces_ = prolongation.pull_back_lagged(gravity_forces_);
        load_forces_ = prolongation.pull_back_lagged(load_forces_);
    }
    system_.reset_pattern();
    contact_->forget();
    x_memo_.resize(3, 0);
    const VecX x = as_vector(current);
    load_forces_ += elasticity_->open_pressure_forces(carried(x), t);
}

const Positions& ShellProblem::level_positions(const VecX& x) {
    const auto points = as_positions(x);
    if (x_memo_.cols() != points.cols() || x_memo_ != points) {
        x_memo_ = points;
        if (carrier_)
            y_memo_ = carrier_->prolongation.apply(x_memo_);
    }
    return x_memo_;
}

const Positions& ShellProblem::carried(const VecX& x) {
    level_positions(x);
    return carrier_ ? y_memo_ : x_memo_;
}

Positions ShellProblem::pull_back(const VecX& x, const Positions& carried_gradient) {
    if (!carrier_)
        return carried_gradient;
    if (discretization_.model().solve.gradient == GradientKind::lagged)
        return carrier_->prolongation.pull_back_lagged(carried_gradient);
    return carrier_->prolongation.pull_back(level_positions(x), carried_gradient);
}

double ShellProblem::value(const VecX& x) {
    const EnergyBreakdown parts = energies(x);
    const Positions& points = level_positions(x);
    double inertia = 0;
    for (int v = 0; v < points.cols(); ++v)
        inertia += mass_[v] * (points.col(v) - anchor_.col(v)).squaredNorm();
    return parts.elastic + parts.strain_limit + parts.contact + parts.friction + parts.gravity + parts.loads +
           0.5 * inverse_h_squared_ * inertia;
}

EnergyBreakdown ShellProblem::energies(const VecX& x) {
    EnergyBreakdown parts;
    {
        PhaseScope scope(context_.times, Phase::elastic);
        const Positions& y = carried(x);
        parts.elastic = elasticity_->elastic_value(y);
        parts.gravity = -gravity_forces_.cwiseProduct(y).sum();
        parts.loads = elasticity_->pressure_value(y) - load_forces_.cwiseProduct(y).sum() + pulls_.value(y);
        if (level_bending_)
            parts.elastic += level_bending_->elastic_value(x_memo_);
        parts.strain_limit = strain_limit_.value(x_memo_);
    }
    if (!std::isfinite(parts.elastic + parts.strain_limit))
        return parts;
    const Positions& points = level_positions(x);
    parts.contact = contact_->value(points);
    PhaseScope scope(context_.times, Phase::contact);
    parts.friction = friction_->value(points);
    return parts;
}

void ShellProblem::gradient(const VecX& x, VecX& gradient) {
    const Positions& points = level_positions(x);
    Positions sum;
    {
        PhaseScope scope(context_.times, Phase::elastic);
        const Positions& y = carried(x);
        Positions on_carrier = -gravity_forces_ - load_forces_;
        elasticity_->add_elastic_gradient(y, on_carrier);
        elasticity_->add_pressure_gradient(y, on_carrier);
        pulls_.add_gradient(y, on_carrier);
        sum = pull_back(x, on_carrier);
        if (level_bending_)
            level_bending_->add_elastic_gradient(points, sum);
        strain_limit_.add_gradient(points, sum);
        for (int v = 0; v < points.cols(); ++v)
            sum.col(v) += inverse_h_squared_ * mass_[v] * (points.col(v) - anchor_.col(v));
    }
    contact_->add_gradient(points, sum);
    PhaseScope scope(context_.times, Phase::contact);
    friction_->add_gradient(points, sum);
    gradient = as_vector(sum);
}

NodalForces ShellProblem::forces(const VecX& x) {
    const Positions& points = level_positions(x);
    const Positions& y = carried(x);
    NodalForces result;
    Positions elastic = Positions::Zero(3, y.cols());
    elasticity_->add_elastic_gradient(y, elastic);
    result.elastic = pull_back(x, elastic);
    if (level_bending_)
        level_bending_->add_elastic_gradient(points, result.elastic);
    result.elastic *= -1;
    result.strain_limit = Positions::Zero(3, vertex_count());
    strain_limit_.add_gradient(points, result.strain_limit);
    result.strain_limit *= -1;
    Positions against_loads = Positions::Zero(3, y.cols());
    elasticity_->add_pressure_gradient(y, against_loads);
    pulls_.add_gradient(y, against_loads);
    result.loads = pull_back(x, load_forces_ - against_loads);
    result.gravity = pull_back(x, gravity_forces_);
    result.contact = Positions::Zero(3, vertex_count());
    contact_->add_gradient(points, result.contact);
    result.contact *= -1;
    result.friction = Positions::Zero(3, vertex_count());
    friction_->add_gradient(points, result.friction);
    result.friction *= -1;
    return result;
}

std::vector<Edge> ShellProblem::coupled_pairs(const Positions& points) {
    std::vector<Edge> pairs = contact_->coupled_pairs(points);
    PhaseScope scope(context_.times, Phase::contact);
    friction_->append_coupled_pairs(pairs);
    return pairs;
}

void ShellProblem::assemble(const VecX& x, NewtonSystem& system, bool project) {
    const Positions& points = level_positions(x);
    system.begin(coupled_pairs(points));
    {
        PhaseScope scope(context_.times, Phase::elastic);
        for (int v = 0; v < points.cols(); ++v)
            system.add_block(v, v, inverse_h_squared_ * mass_[v] * Mat3::Identity());
        if (!carrier_) {
            elasticity_->add_hessian(points, system, project);
            pulls_.add_hessian(system);
        } else if (curvature_) {
            curvature_->add_hessian(points, system, project);
            level_pulls_.add_hessian(system);
        } else {
            carrier_->fine_hessian.begin({});
            elasticity_->add_hessian(y_memo_, carrier_->fine_hessian, project);
            pulls_.add_hessian(carrier_->fine_hessian);
            carrier_->product.add(carrier_->prolongation.jacobian(points), carrier_->fine_hessian, system);
        }
        if (level_bending_)
            level_bending_->add_hessian(points, system, project);
        strain_limit_.add_hessian(points, system);
    }
    contact_->add_hessian(points, system, project);
    PhaseScope scope(context_.times, Phase::contact);
    friction_->add_hessian(points, system);
}

double ShellProblem::max_step(const VecX& x, const VecX& d) {
    const Positions direction = as_positions(d);
    const Positions points = level_positions(x);
    double alpha = contact_->max_step(points, direction);
    PhaseScope scope(context_.times, Phase::ccd);
    alpha *= strain_limit_.max_step(points, alpha * direction);
    alpha *= largest_regular_step(discretization_.layout(level_).body_faces, points, alpha * direction).length;
    if (carrier_) {
        const Positions& here = carried(x);
        const Positions there = carrier_->prolongation.apply(points + alpha * direction);
        alpha *= largest_regular_step(discretization_.layout(discretization_.finest()).body_faces, here, there - here)
                     .length;
    }
    return alpha;
}

StepLimit ShellProblem::step_limit(const VecX& x, const VecX& d) {
    const Positions points = level_positions(x);
    const auto pair = contact_->limiting_pair(points, as_positions(d));
    const Positions until_contact = (pair ? pair->step : 1.0) * as_positions(d);
    const double within_limit = strain_limit_.max_step(points, until_contact);
    const Positions motion = within_limit * until_contact;
    const auto collapsing = [&](int level, const Positions& here, const Positions& there) -> StepLimit {
        const auto& faces = discretization_.layout(level).body_faces;
        const int face = largest_regular_step(faces, here, there - here).face;
        if (face < 0)
            return {};
        return {"triangle", fmt::format("{} would collapse at {}", named_corners(level, faces[at(face)]),
                                        place_in_words(here.col(faces[at(face)][0])))};
    };
    StepLimit limit = collapsing(level_, points, points + motion);
    if (limit.cause.empty() && carrier_)
        limit = collapsing(discretization_.finest(), carried(x), carrier_->prolongation.apply(points + motion));
    if (limit.cause.empty() && within_limit < 1) {
        const StrainLimit::Excess worst = strain_limit_.excess(points + motion, 1);
        limit = {"strain limit", fmt::format("a face of {} is stretched to {:.6g} of {:.6g} at {}",
                                             discretization_.model().part_name(worst.body), worst.stretch, worst.limit,
                                             place_in_words(worst.place))};
    }
    if (limit.cause.empty() && pair)
        limit = {"contact", in_words(*pair)};
    return limit;
}

/// Corners (of a face, of an edge, or one alone) by their numbers on a level, with the name of their body or obstacle.
std::string ShellProblem::named_corners(int level, std::span<const int> corners) const {
    constexpr std::array kinds = {"vertex", "edge", "triangle"};
    return fmt::format("{} {} of {}", kinds[corners.size() - 1], fmt::join(corners, "-"),
                       discretization_.model().part_name(discretization_.mesh(level).part[at(corners[0])]));
}

std::string ShellProblem::in_words(const LimitingPair& pair) const {
    const CollisionMesh& mesh = contact_->mesh();
    const auto [first, second] = pair.primitives;
    const bool edges = pair.kind == StencilKind::edge_edge;
    const std::span<const int> one = edges ? std::span<const int>(mesh.edges[at(first)]) : std::span(&first, 1);
    const std::span<const int> other = edges ? std::span<const int>(mesh.edges[at(second)]) : mesh.faces[at(second)];
    return fmt::format("{} and {} are {:.3g} m apart at {}", named_corners(level_, one), named_corners(level_, other),
                       pair.gap, place_in_words(pair.place));
}

double ShellProblem::residual(const VecX& x) {
    const NodalForces nodal = forces(x);
    Positions total = nodal.total();
    const auto& prescribed = discretization_.layout(level_).prescribed;
    for (Eigen::Index i = 0; i < total.size(); ++i)
        if (prescribed[static_cast<std::size_t>(i)])
            total.data()[i] = 0;
    const double largest_total = largest_norm(total);
    const double largest_term =
        std::max({largest_norm(nodal.elastic), largest_norm(nodal.strain_limit), largest_norm(nodal.contact),
                  largest_norm(nodal.friction), largest_norm(nodal.gravity), largest_norm(nodal.loads)});
    return largest_total <= force_round_off_ ? 0.0 : largest_total / largest_term;
}

double ShellProblem::min_gap(const VecX& x) {
    return contact_->min_gap(level_positions(x));
}

VecX ShellProblem::vertex_gaps(const VecX& x) {
    VecX gaps = VecX::Constant(vertex_count(), std::numeric_limits<double>::quiet_NaN());
    for (const ActivePair& pair : contact_->active_pairs(level_positions(x))) {
        const double gap = std::sqrt(pair.separation.squared_distance) - std::sqrt(pair.parameters.least_squared);
        for (int v : pair.vertices)
            gaps[v] = std::fmin(gaps[v], gap); // a number rather than NaN
    }
    return gaps;
}

TightestPair ShellProblem::tightest_pair(const VecX& x) {
    const Positions& points = level_positions(x);
    const auto& prescribed = discretization_.layout(level_).prescribed;
    const auto is_free = [&](int v) {
        const auto first = prescribed.begin() + 3 * v;
        return std::find(first, first + 3, 0) != first + 3;
    };
    const ActivePair* found = nullptr;
    TightestPair tightest;
    for (const ActivePair& pair : contact_->active_pairs(points)) {
        const double least = std::sqrt(pair.parameters.least_squared);
        const double gap = std::sqrt(pair.separation.squared_distance) - least;
        const double share = gap / (std::sqrt(pair.parameters.activation_squared) - least);
        if (share < tightest.share && std::any_of(pair.vertices.begin(), pair.vertices.end(), is_free)) {
            found = &pair;
            tightest.gap = gap;
            tightest.share = share;
        }
    }
    if (found) {
        const Vec3 place = midpoint(found->separation, gather(points, found->vertices));
        const double distance = std::sqrt(found->separation.squared_distance);
        tightest.words = in_words({found->kind, found->primitives, 1, distance, place});
    }
    return tightest;
}

double ShellProblem::least_thickness_share(const VecX& x) {
    return contact_->least_thickness_share(level_positions(x));
}

void ShellProblem::enforce_thickness(double share, double stiffness_factor) {
    contact_->enforce(share, stiffness_factor);
}

double ShellProblem::max_stretch(const VecX& x) {
    return triangles_.largest_stretch(level_positions(x));
}

int ShellProblem::active_contacts(const VecX& x) {
    return contact_->active_pair_count(level_positions(x));
}

} // namespace plisse
