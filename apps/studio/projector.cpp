#include "projector.h"

#include <algorithm>
#include <limits>

#include <plisse/picture/scalars.h>

#include "messages.h"

namespace plisse::studio {

namespace {

constexpr double not_there = std::numeric_limits<double>::quiet_NaN();
constexpr double cut = 0.01; // share of the largest values that the colours leave out

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// The mean over the faces around each vertex.
std::vector<double> on_vertices(const HierarchyLevel& mesh, const std::vector<double>& of_faces) {
    std::vector<double> sum(mesh.part.size(), 0), count(mesh.part.size(), 0);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (int v : mesh.faces[f]) {
            sum[at(v)] += of_faces[f];
            ++count[at(v)];
        }
    for (std::size_t v = 0; v < sum.size(); ++v)
        sum[v] /= count[v]; // 0 / 0 is not a number, which is what is meant
    return sum;
}

std::vector<double> coarsest_levels(const Hierarchy& hierarchy, int level) {
    const std::vector<int>& ids = hierarchy.levels[at(level)].vertex_ids;
    std::vector<double> levels(ids.size(), level);
    for (int l = level; l-- > 0;) {
        const std::vector<int>& coarser = hierarchy.levels[at(l)].vertex_ids;
        for (std::size_t v = 0; v < ids.size(); ++v)
            if (std::binary_search(coarser.begin(), coarser.end(), ids[v]))
                levels[v] = l;
    }
    return levels;
}

std::vector<double> values(StagedRun& run, int level, const Positions& x, ShownColor color,
                           const std::vector<double>& levels) {
    const HierarchyLevel& mesh = run.discretization().mesh(level);
    switch (color) {
    case ShownColor::none:
        break;
    case ShownColor::stretch:
        return on_vertices(mesh, largest_stretches(mesh.rest, x, mesh.faces));
    case ShownColor::curvature:
        return mean_curvatures(x, mesh.faces);
    case ShownColor::gap: {
        if (level != run.level())
            break;
        const VecX gaps = run.stepper().problem().vertex_gaps(run.stepper().unknowns());
        return {gaps.begin(), gaps.end()};
    }
    case ShownColor::level:
        return levels;
    }
    return std::vector<double>(mesh.part.size(), not_there);
}

/// Of bodies alone; obstacles have no colour.
Scalars scalars_of(StagedRun& run, int level, std::vector<double> values) {
    const HierarchyLevel& mesh = run.discretization().mesh(level);
    for (std::size_t v = 0; v < values.size(); ++v)
        if (run.discretization().model().is_obstacle(mesh.part[v]))
            values[v] = not_there;
    Scalars scalars;
    scalars.values = std::move(values);
    fit_range(scalars, {}, cut);
    return scalars;
}

} // namespace

const Projector::Mesh& Projector::mesh(const Discretization& discretization, int level) {
    const auto found = meshes_.find(level);
    if (found != meshes_.end())
        return found->second;
    const HierarchyLevel& shown = discretization.mesh(level);
    MeshMessage message;
    message.level = static_cast<std::uint32_t>(level);
    message.version = ++last_version_;
    message.vertices = static_cast<std::uint32_t>(shown.rest.cols());
    message.faces = shown.faces;
    message.parts = discretization.layout(level).face_part;
    return meshes_
        .emplace(level, Mesh{message.version, std::make_shared<const Bytes>(encode_mesh(message)),
                             coarsest_levels(discretization.hierarchy(), level)})
        .first->second;
}

Board::Picture Projector::picture(StagedRun& run, const Show& show) {
    LevelStepper& stepper = run.stepper();
    const bool prolonged = show.detail && run.level() < run.discretization().finest() &&
                           run.discretization().model().solve.method != Method::direct;
    const int level = prolonged ? run.discretization().finest() : run.level();
    const Positions x = prolonged ? stepper.problem().carried(stepper.unknowns()) : stepper.positions();
    const Mesh& shown = mesh(run.discretization(), level);

    PositionsMessage message;
    message.level = static_cast<std::uint32_t>(level);
    message.version = shown.version;
    message.step = static_cast<std::uint32_t>(run.log().level_report(run.level()).steps);
    message.t = stepper.progress().t;
    message.prolonged = prolonged;
    if (show.color == ShownColor::none)
        return {shown.version, shown.message, std::make_shared<const Bytes>(encode_positions(message, x))};
    const Scalars scalars = scalars_of(run, level, values(run, level, x, show.color, shown.levels));
    const ShownScalars colors{scalars.values, scalars.low, scalars.high};
    return {shown.version, shown.message, std::make_shared<const Bytes>(encode_positions(message, x, &colors))};
}

Board::Picture Projector::saved(const Discretization& discretization, int level, double t, const Positions& x) {
    const Mesh& shown = mesh(discretization, level);
    PositionsMessage message;
    message.level = static_cast<std::uint32_t>(level);
    message.version = shown.version;
    message.t = t;
    message.saved_frame = true;
    return {shown.version, shown.message, std::make_shared<const Bytes>(encode_positions(message, x))};
}

Board::Picture Projector::unusable(const TriangleMesh& mesh, const std::vector<int>& marked) {
    MeshMessage message;
    message.version = ++last_version_;
    message.vertices = static_cast<std::uint32_t>(mesh.vertex_count());
    message.faces = mesh.faces;
    const std::vector<int> parts(mesh.faces.size(), 0);
    message.parts = parts;
    message.unusable = true;
    message.marked = marked;
    PositionsMessage positions;
    positions.version = message.version;
    return {message.version, std::make_shared<const Bytes>(encode_mesh(message)),
            std::make_shared<const Bytes>(encode_positions(positions, mesh.positions))};
}

} // namespace plisse::studio
