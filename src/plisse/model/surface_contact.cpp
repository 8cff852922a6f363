#include <plisse/model/surface_contact.h>

#include <algorithm>

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
    rest << model.surface.positions, model.obstacles.positions;
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

} // namespace

SurfaceContact::SurfaceContact(const SubdivisionModel& model, Context& context)
    : limit_count_(model.surface.vertex_count()), obstacles_(model.obstacles.positions),
      contact_(collision_mesh(model), contact_options(model)), hessian_(free_system(contact_.mesh())) {
    hessian_.set_prescribed_step(VecX::Zero(contact_.mesh().rest.size()));
    contact_.set_times(&context.times);
}

Positions SurfaceContact::with_obstacles(const Positions& limit_points) const {
    Positions all(3, limit_points.cols() + obstacles_.cols());
    all << limit_points, obstacles_;
    return all;
}

const NewtonSystem& SurfaceContact::hessian(const Positions& surface, bool project) {
    hessian_.begin(contact_.coupled_pairs(surface));
    contact_.add_hessian(surface, hessian_, project);
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
    return shared_.contact().value(surface(q));
}

void LevelContact::add_gradient(const Positions& q, Positions& gradient) {
    Positions forces = Positions::Zero(3, to_surface_.rows());
    shared_.contact().add_gradient(surface(q), forces);
    gradient += forces * to_surface_;
}

double LevelContact::max_step(const Positions& q, const Positions& d) {
    const Positions motion = d * to_surface_.transpose();
    return shared_.contact().max_step(surface(q), motion);
}

const std::vector<Edge>& LevelContact::find_hessian(const Positions& q, bool project) {
    coupled_.clear();
    found_ = nullptr;
    if (shared_.contact().active_pair_count(surface(q)) == 0)
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

} // namespace plisse
