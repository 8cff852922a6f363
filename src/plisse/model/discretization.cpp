#include <plisse/model/discretization.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>

#include <plisse/base/error.h>
#include <plisse/decimate/level_prolongation.h>
#include <plisse/linalg/linear_solver.h>
#include <plisse/mesh/connectivity.h>
#include <plisse/model/finest_model.h>
#include <plisse/spatial/intersections.h>
#include <plisse/subdivide/subdivide.h>

#include <fmt/format.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Positions at rest with every obstacle where its script has it at t = 0.
Positions posed_rest(const Model& model) {
    Positions rest = model.mesh.positions;
    for (const Obstacle& obstacle : model.obstacles)
        for (int v = obstacle.vertices.begin; v < obstacle.vertices.end; ++v)
            rest.col(v) = obstacle.motion.apply(model.mesh.positions.col(v), 0);
    return rest;
}

int body_vertex_count(const Model& model) {
    return model.bodies.empty() ? 0 : model.bodies.back().vertices.end;
}

/// Numbers sets of handles: vertices with the same one may merge.
class HandleLabels {
public:
    explicit HandleLabels(std::vector<std::vector<int>>& handles_of_label) : handles_(handles_of_label) {}

    /// Of each vertex; -1: no handle.
    std::vector<int> of_vertices(const Model& model) {
        std::vector<std::vector<int>> handles_of_vertex(at(model.mesh.vertex_count()));
        for (std::size_t h = 0; h < model.handles.size(); ++h)
            for (int v : model.handles[h].vertices)
                handles_of_vertex[at(v)].push_back(static_cast<int>(h));
        std::vector<int> labels;
        for (const std::vector<int>& handles : handles_of_vertex)
            labels.push_back(label_of(handles));
        return labels;
    }

    /// Of what both have.
    int shared(int a, int b) {
        std::vector<int> handles;
        std::set_intersection(handles_[at(a)].begin(), handles_[at(a)].end(), handles_[at(b)].begin(),
                              handles_[at(b)].end(), std::back_inserter(handles));
        return label_of(handles);
    }

private:
    int label_of(const std::vector<int>& handles) {
        if (handles.empty())
            return -1;
        const auto [entry, fresh] = numbers_.try_emplace(handles, static_cast<int>(handles_.size()));
        if (fresh)
            handles_.push_back(handles);
        return entry->second;
    }

    std::vector<std::vector<int>>& handles_; ///< of each label, ascending
    std::map<std::vector<int>, int> numbers_;
};

/// Coarsening an obstacle this small saves nothing and costs its shape: a box would lose its faces' planes, and what it
/// presses slips out.
constexpr int least_decimated_obstacle = 300;

DecimationResult build_hierarchy(const Model& model, const Positions& rest, const std::vector<int>& labels,
                                 int level_count, Context& context, HierarchyStore* store) {
    const std::vector<int> part = model.vertex_parts();
    std::vector<std::uint8_t> frozen(at(model.part_count()), 0);
    DecimationOptions options;
    options.levels = level_count;
    options.coarsest_vertices = model.hierarchy.coarsest_vertices;
    options.obstacle_part.assign(at(model.part_count()), 0);
    for (std::size_t o = 0; o < model.obstacles.size(); ++o) {
        const Obstacle& obstacle = model.obstacles[o];
        options.obstacle_part[model.bodies.size() + o] = 1;
        frozen[model.bodies.size() + o] = !obstacle.progressive || obstacle.vertices.size() < least_decimated_obstacle;
    }
    // Without coarser levels there is nothing to keep.
    DecimationResult result = decimate_once({rest, model.mesh.faces, part, labels, frozen}, options, context,
                                            level_count > 1 ? store : nullptr);
    const DecimationSummary& summary = result.summary;
    if (summary.ran_dry)
        context.on_message(
            fmt::format("the coarsest level has {} vertices, not the {} asked for: no further edge can be "
                        "collapsed without harm to the shape",
                        summary.reached_vertices.front(), summary.wanted_vertices.front()));
    return result;
}

} // namespace

Discretization::Discretization(const Model& model, int level_count, Context& context, HierarchyStore* store)
    : model_(model) {
    if (model.hierarchy.source == HierarchySource::loop)
        subdivide_model(level_count);
    else
        decimation_ = build_hierarchy(model_, posed_rest(model_), HandleLabels(handles_of_label_).of_vertices(model_),
                                      level_count, context, store);
    layouts_.resize(hierarchy().levels.size());
    for (int level = 0; level <= finest(); ++level)
        lay_out(level);
    if (hierarchy().is_subdivided())
        expect_no_intersections();
}

void Discretization::subdivide_model(int level_count) {
    HandleLabels labels(handles_of_label_);
    SubdivisionInput input;
    input.rest = posed_rest(model_);
    input.surface = {model_.mesh.faces, model_.vertex_parts(), labels.of_vertices(model_)};
    input.kept_part.assign(model_.bodies.size(), 0);
    input.kept_part.resize(at(model_.part_count()), 1);
    input.label_between = [&](int a, int b) { return labels.shared(a, b); };
    decimation_.hierarchy = subdivide(input, level_count);
    for (const HierarchyLevel& level : hierarchy().levels)
        decimation_.summary.wanted_vertices.push_back(static_cast<int>(level.rest.cols()));
    decimation_.summary.reached_vertices = decimation_.summary.wanted_vertices;
    start_on_input_ = input.rest;
    start_on_input_.leftCols(body_vertex_count(model_)) = model_.start.leftCols(body_vertex_count(model_));
    model_ = finest_model(model_, hierarchy(), subdivided_start(finest()), handles_of_label_);
}

// What is smoothed also shrinks, and may come to what lay beside it.
void Discretization::expect_no_intersections() const {
    for (int level = 1; level <= finest(); ++level) {
        const HierarchyLevel& fine = mesh(level);
        const auto pairs = intersecting_pairs(fine.rest, fine.faces, both_obstacles(level), 1);
        if (pairs.empty())
            continue;
        const Vec3 place = fine.rest.col(fine.faces[at(pairs.front()[0])][0]);
        throw InputError(model_.name,
                         fmt::format("level {}, subdivided, intersects itself at rest near ({:.6g}, {:.6g}, {:.6g})",
                                     level, place.x(), place.y(), place.z()),
                         "give a mesh that is finer there, or separate the surfaces");
    }
}

std::function<bool(int, int)> Discretization::both_obstacles(int level) const {
    return [&part = layout(level).face_part, this](int a, int b) {
        return model_.is_obstacle(part[at(a)]) && model_.is_obstacle(part[at(b)]);
    };
}

void Discretization::lay_out(int level) {
    const HierarchyLevel& mesh_of_level = mesh(level);
    LevelLayout& layout = layouts_[at(level)];
    const auto vertices = at(static_cast<int>(mesh_of_level.rest.cols()));
    std::vector<std::uint8_t> used(vertices, 0);
    for (const Face& face : mesh_of_level.faces) {
        const int part = mesh_of_level.part[at(face[0])];
        layout.face_part.push_back(part);
        for (int v : face)
            used[at(v)] = 1;
        if (model_.is_obstacle(part))
            continue;
        layout.body_faces.push_back(face);
        layout.body_face_part.push_back(part);
    }

    using Key = std::tuple<int, int, double, double, double>;
    std::map<Key, int> finest_at;
    const HierarchyLevel& fine = hierarchy().finest();
    for (int v = 0; v < fine.rest.cols(); ++v)
        if (fine.label[at(v)] >= 0)
            finest_at.try_emplace(
                {fine.part[at(v)], fine.label[at(v)], fine.rest(0, v), fine.rest(1, v), fine.rest(2, v)}, v);
    layout.source.assign(vertices, -1);
    layout.prescribed.assign(3 * vertices, 0);
    layout.script_of.assign(3 * vertices, 0);
    const int first_obstacle = static_cast<int>(model_.bodies.size());
    const int first_obstacle_script = static_cast<int>(model_.handles.size());
    for (std::size_t v = 0; v < vertices; ++v) {
        const int column = static_cast<int>(v);
        if (!used[v] || model_.is_obstacle(mesh_of_level.part[v]))
            std::fill_n(layout.prescribed.begin() + 3 * column, 3, std::uint8_t{1});
        if (model_.is_obstacle(mesh_of_level.part[v]))
            std::fill_n(layout.script_of.begin() + 3 * column, 3,
                        first_obstacle_script + mesh_of_level.part[v] - first_obstacle);
        if (mesh_of_level.label[v] < 0)
            continue;
        const auto& p = mesh_of_level.rest;
        layout.source[v] =
            finest_at.at({mesh_of_level.part[v], mesh_of_level.label[v], p(0, column), p(1, column), p(2, column)});
        for (int h : handles_of(level, column))
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (model_.handles[at(h)].axes[axis]) {
                    layout.prescribed[3 * v + axis] = 1;
                    layout.script_of[3 * v + axis] = h;
                }
    }
}

const std::vector<int>& Discretization::handles_of(int level, int vertex) const {
    const int label = mesh(level).label[at(vertex)];
    return label < 0 ? no_handles_ : handles_of_label_[at(label)];
}

Positions Discretization::script(int level, double t) const {
    const HierarchyLevel& mesh_of_level = mesh(level);
    Positions targets = mesh_of_level.rest;
    for (int v = 0; v < targets.cols(); ++v) {
        const int part = mesh_of_level.part[at(v)];
        if (model_.is_obstacle(part)) {
            const MotionTrack& motion = model_.obstacles[at(part) - model_.bodies.size()].motion;
            targets.col(v) = motion.apply(motion.undo(mesh_of_level.rest.col(v), 0), t);
        }
        for (int h : handles_of(level, v)) {
            const Handle& handle = model_.handles[at(h)];
            const Vec3 target = handle.motion.apply(model_.start.col(layout(level).source[at(v)]), t);
            for (int axis = 0; axis < 3; ++axis)
                if (handle.axes[at(axis)])
                    targets(axis, v) = target[axis];
        }
    }
    return targets;
}

Positions Discretization::start(int level) const {
    const int of_bodies = body_vertex_count(model_);
    const bool starts_at_rest = model_.start.leftCols(of_bodies) == model_.mesh.positions.leftCols(of_bodies);
    if (starts_at_rest)
        return mesh(level).rest;
    if (level == finest()) {
        Positions x = mesh(level).rest;
        x.leftCols(of_bodies) = model_.start.leftCols(of_bodies);
        return x;
    }
    return hierarchy().is_subdivided() ? subdivided_start(level) : restricted_start(level);
}

Positions Discretization::subdivided_start(int level) const {
    Positions x = start_on_input_;
    for (int l = 0; l < level; ++l)
        x = subdivided_positions(hierarchy(), l, x);
    return x;
}

// Least squares for the anchors, min sum_i |U x + a(x) - start_i|^2 with a held, repeated: a handful of rounds settles
// the offsets.
Positions Discretization::restricted_start(int level) const {
    const HierarchyLevel& coarse = mesh(level);
    const Positions target = start(finest());
    const Prolongation prolongation = prolongation_to_finest(hierarchy(), level, ProlongationOperator::shell);
    std::vector<std::uint8_t> fixed = layout(level).prescribed;
    Positions x = coarse.rest;
    for (std::size_t v = 0; v < coarse.label.size(); ++v)
        if (coarse.label[v] >= 0) {
            x.col(static_cast<int>(v)) = model_.start.col(layout(level).source[v]);
            std::fill_n(fixed.begin() + 3 * static_cast<std::ptrdiff_t>(v), 3, std::uint8_t{1});
        }
    const Connectivity connectivity(static_cast<int>(x.cols()), coarse.faces);
    NewtonSystem system(fixed, connectivity.edges());
    LinearSolver solver;
    system.begin({});
    for (const Anchor& anchor : coarse.to_finest) {
        if (anchor.face < 0)
            continue;
        const Face& face = coarse.faces[at(anchor.face)];
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (face[at(i)] >= face[at(j)])
                    system.add_block(face[at(i)], face[at(j)],
                                     anchor.weights[i] * anchor.weights[j] * Mat3::Identity());
    }
    solver.factorize(system);
    for (int round = 0; round < 8; ++round) {
        const Positions residual = target - prolongation.apply(x);
        const VecX step =
            system.scatter(solver.solve(system, system.gather(as_vector(prolongation.pull_back_lagged(residual)))));
        x += as_positions(step);
    }
    if (!intersecting_pairs(x, coarse.faces, both_obstacles(level), 1).empty())
        throw InputError(model_.name, fmt::format("the start shape intersects itself when carried to level {}", level),
                         "use fewer levels, more coarsest_vertices, or method `direct`");
    return x;
}

} // namespace plisse
