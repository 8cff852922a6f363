#include <plisse/model/surface_contact.h>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <plisse/model/barrier_stiffness.h>
#include <plisse/spatial/box.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

CollisionMesh collision_mesh(const SubdivisionModel& model) {
    const int limits = model.surface.vertex_count(), others = model.obstacles.vertex_count();
    Positions rest(3, limits + others);
    rest << model.surface.positions, model.obstacles_at(0);
    std::vector<Face> faces = model.surface.faces;
    for (const Face& face : model.obstacles.faces)
        faces.push_back({face[0] + limits, face[1] + limits, face[2] + limits});
    std::vector<int> part(at(limits), 0);
    part.insert(part.end(), model.obstacle_of_vertex.begin(), model.obstacle_of_vertex.end());
    for (int& number : std::span(part).subspan(at(limits)))
        ++number;
    std::vector<std::uint8_t> is_obstacle(1 + model.obstacle_names.size(), 1);
    is_obstacle.front() = 0;
    return CollisionMesh(std::move(rest), std::move(faces), std::move(part), std::move(is_obstacle));
}

ContactOptions contact_options(const SubdivisionModel& model) {
    ContactOptions options;
    options.distance = model.contact.distance;
    options.thickness = model.contact.thickness;
    options.self = model.contact.self;
    options.stiffness = barrier_stiffness(model.material, bounding_box(model.surface.positions).diagonal());
    return options;
}

NewtonSystem free_system(const CollisionMesh& mesh) {
    std::vector<Edge> pairs = mesh.edges;
    for (int v = 0; v < mesh.rest.cols(); ++v)
        pairs.push_back({v, v});
    std::sort(pairs.begin(), pairs.end());
    return NewtonSystem(std::vector<std::uint8_t>(3 * at(static_cast<int>(mesh.rest.cols())), 0), pairs);
}

VertexWeights with_empty_rows(VertexWeights weights, Eigen::Index rows) {
    weights.conservativeResize(rows, weights.cols());
    return weights;
}

FrictionOptions friction_options(const SubdivisionModel& model) {
    const auto parts = static_cast<int>(1 + model.obstacle_names.size());
    return {model.contact.friction_velocity * model.solve.time_step, friction_coefficients(model.contact, parts)};
}

} // namespace

SurfaceContact::SurfaceContact(const SubdivisionModel& model, Context& context)
    : model_(model), limit_count_(model.surface.vertex_count()), obstacles_(model.obstacles_at(0)),
      contact_(collision_mesh(model), contact_options(model)), friction_(contact_.mesh(), friction_options(model)),
      hessian_(free_system(contact_.mesh())) {
    hessian_.set_prescribed_step(VecX::Zero(contact_.mesh().rest.size()));
    contact_.set_times(&context.times);
}

Positions SurfaceContact::with_obstacles(const Positions& limit_points) const {
    Positions all(3, limit_points.cols() + obstacles_.cols());
    all << limit_points, obstacles_;
    return all;
}

Positions SurfaceContact::obstacle_motion(double t) const {
    Positions motion = Positions::Zero(3, limit_count_ + obstacles_.cols());
    motion.rightCols(obstacles_.cols()) = model_.obstacles_at(t) - obstacles_;
    return motion;
}

double SurfaceContact::move_obstacles(const Positions& limit_points, double t) {
    const Positions motion = obstacle_motion(t);
    if (motion.isZero(0))
        return 1;
    const double share = contact_.max_step(with_obstacles(limit_points), motion);
    if (share == 1)
        place_obstacles(t);
    else
        obstacles_ += share * motion.rightCols(obstacles_.cols());
    return share;
}

std::string SurfaceContact::held_up(const Positions& limit_points, double t) {
    const auto pair = contact_.limiting_pair(with_obstacles(limit_points), obstacle_motion(t));
    if (!pair)
        return {};
    const CollisionMesh& mesh = contact_.mesh();
    int part = 0;
    for (const int vertex : mesh.stencil_vertices(pair->kind, pair->primitives))
        part = std::max(part, mesh.part[at(vertex)]);
    return fmt::format("obstacle \"{}\" is held up by the cloth at ({:.4g}, {:.4g}, {:.4g})",
                       model_.obstacle_names[at(part - 1)], pair->place.x(), pair->place.y(), pair->place.z());
}

void SurfaceContact::begin_step(const Positions& limit_points, FrictionMemory memory, double grip) {
    contact_.forget();
    hessian_.reset_pattern();
    friction_.begin(std::move(memory));
    lag_friction(limit_points, grip, 1);
}

bool SurfaceContact::update_friction(const Positions& limit_points, double share) {
    lag_friction(limit_points, 1, share);
    return friction_.possible();
}

void SurfaceContact::lag_friction(const Positions& limit_points, double grip, double share) {
    if (!friction_.possible())
        return;
    const Positions surface = with_obstacles(limit_points);
    friction_.lag(contact_.active_pairs(surface), surface, grip, share);
    rubbing_pairs_.clear();
    friction_.append_coupled_pairs(rubbing_pairs_);
}

double SurfaceContact::value(const Positions& surface) {
    return contact_.value(surface) + friction_.value(surface);
}

void SurfaceContact::add_gradient(const Positions& surface, Positions& gradient) {
    contact_.add_gradient(surface, gradient);
    friction_.add_gradient(surface, gradient);
}

bool SurfaceContact::acts(const Positions& surface) {
    return !rubbing_pairs_.empty() || contact_.active_pair_count(surface) > 0;
}

const NewtonSystem& SurfaceContact::hessian(const Positions& surface, bool project) {
    std::vector<Edge> coupled = contact_.coupled_pairs(surface);
    coupled.insert(coupled.end(), rubbing_pairs_.begin(), rubbing_pairs_.end());
    hessian_.begin(coupled);
    contact_.add_hessian(surface, hessian_, project);
    friction_.add_hessian(surface, hessian_);
    return hessian_;
}

LevelContact::LevelContact(SurfaceContact& contact, VertexWeights to_surface)
    : shared_(contact), to_surface_(with_empty_rows(std::move(to_surface), contact.contact().mesh().rest.cols())),
      product_(to_surface_) {}

void LevelContact::stand_alone() {
    q0_.resize(3, 0);
    q_memo_.resize(3, 0);
}

void LevelContact::correct(Positions q0, Positions base) {
    q0_ = std::move(q0);
    base_ = std::move(base);
    q_memo_.resize(3, 0);
}

Positions LevelContact::limit_points(const Positions& q) const {
    if (q0_.cols() == 0)
        return (q * to_surface_.transpose()).leftCols(shared_.limit_count());
    return base_ + ((q - q0_) * to_surface_.transpose()).leftCols(shared_.limit_count());
}

const Positions& LevelContact::surface(const Positions& q) {
    if (q_memo_.cols() != q.cols() || q_memo_ != q) {
        q_memo_ = q;
        surface_memo_ = shared_.with_obstacles(limit_points(q));
    }
    return surface_memo_;
}

double LevelContact::value(const Positions& q) {
    return shared_.value(surface(q));
}

void LevelContact::add_gradient(const Positions& q, Positions& gradient) {
    Positions forces = Positions::Zero(3, to_surface_.rows());
    shared_.add_gradient(surface(q), forces);
    gradient += forces * to_surface_;
}

double LevelContact::max_step(const Positions& q, const Positions& d) {
    const Positions motion = d * to_surface_.transpose();
    return shared_.contact().max_step(surface(q), motion);
}

const std::vector<Edge>& LevelContact::find_hessian(const Positions& q, bool project) {
    coupled_.clear();
    found_ = nullptr;
    if (!shared_.acts(surface(q)))
        return coupled_;
    found_ = &product_.compute(shared_.hessian(surface(q), project));
    for_each_block([&](int row, int column, const Mat3&) { coupled_.push_back({column, row}); });
    return coupled_;
}

void LevelContact::add_hessian(NewtonSystem& system) const {
    if (found_)
        for_each_block([&](int row, int column, const Mat3& block) { system.add_block(row, column, block); });
}

template <typename Visit>
void LevelContact::for_each_block(const Visit& visit) const {
    const NewtonSystem& h = *found_;
    for (int column = 0; column < h.row_count(); ++column)
        for (int k = h.column_starts()[at(column)]; k < h.column_starts()[at(column) + 1]; ++k) {
            const Mat3& block = h.blocks()[at(h.block_numbers()[at(k)])];
            if (!block.isZero(0))
                visit(h.block_rows()[at(k)], column, block);
        }
}

double LevelContact::min_gap(const Positions& q) {
    return shared_.contact().min_gap(surface(q));
}

double LevelContact::friction(const Positions& q) {
    return shared_.friction().value(surface(q));
}

} // namespace plisse
