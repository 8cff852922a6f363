#include <plisse/mesh/generate.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <plisse/base/error.h>
#include <plisse/mesh/mesh_formats.h>
#include <plisse/mesh/portable_math.h>
#include <plisse/mesh/shapes.h>
#include <plisse/spatial/intersections.h>

namespace plisse {

namespace {

constexpr double most_vertices = 5e6;

[[noreturn]] void refuse(const std::string& what, const std::string& remedy) {
    throw InputError("", what, remedy);
}

void require_positive(const char* name, double value) {
    if (!(value > 0) || !std::isfinite(value))
        refuse(fmt::format("the generator's {} is {}", name, value), "give a positive number of metres");
}

void require(bool holds, const std::string& what, const std::string& remedy) {
    if (!holds)
        refuse(what, remedy);
}

/// Checks the shape's own fields; returns its area, roughly.
double checked_area(const GeneratorOptions& o) {
    switch (o.shape) {
    case GeneratorShape::sheet:
        require_positive("size x", o.size.x());
        require_positive("size z", o.size.y());
        return o.size.x() * o.size.y();
    case GeneratorShape::box:
        require_positive("size x", o.size.x());
        require_positive("size y", o.size.y());
        require_positive("size z", o.size.z());
        return 2 * (o.size.x() * o.size.y() + o.size.y() * o.size.z() + o.size.z() * o.size.x());
    case GeneratorShape::sphere:
        require_positive("radius", o.radius);
        return 4 * pi * o.radius * o.radius;
    case GeneratorShape::cylinder:
        require_positive("radius", o.radius);
        require_positive("height", o.height);
        return 2 * pi * o.radius * (o.height + (o.caps ? o.radius : 0));
    case GeneratorShape::dome:
        require_positive("radius", o.radius);
        require(o.angle_deg > 0 && o.angle_deg <= 175, fmt::format("the dome's angle_deg is {}", o.angle_deg),
                "give an angle above 0 and at most 175 degrees, or use a sphere");
        return 2 * pi * o.radius * o.radius * (1 - cos_sin_turns(o.angle_deg / 360).cos);
    case GeneratorShape::torus:
        require_positive("radius", o.radius);
        require_positive("tube", o.tube);
        require(o.tube < o.radius, fmt::format("the torus' tube {} is not below its radius {}", o.tube, o.radius),
                "give a tube smaller than the radius");
        return 4 * pi * pi * o.radius * o.tube;
    case GeneratorShape::annulus:
        require_positive("inner", o.inner);
        require_positive("outer", o.outer);
        require(o.inner < o.outer, fmt::format("the annulus' inner {} is not below its outer {}", o.inner, o.outer),
                "give an inner radius smaller than the outer");
        return pi * (o.outer * o.outer - o.inner * o.inner);
    case GeneratorShape::pumpkin:
        require_positive("radius", o.radius);
        require_positive("height", o.height);
        require(o.lobes >= 3 && o.lobes <= 100, fmt::format("the pumpkin's lobes are {}", o.lobes),
                "give 3 to 100 lobes");
        return 2 * pi * o.radius * (o.radius + o.height);
    case GeneratorShape::star:
        break;
    }
    require_positive("radius", o.radius);
    require_positive("height", o.height);
    require(o.points >= 3 && o.points <= 1000, fmt::format("the star's points are {}", o.points),
            "give 3 to 1000 points");
    require(o.depth > 0 && o.depth < 1, fmt::format("the star's depth is {}", o.depth), "give a share between 0 and 1");
    require(std::abs(o.twist_deg) < 180, fmt::format("the star's twist_deg is {}", o.twist_deg),
            "give an angle between -180 and 180 degrees: at half a turn the walls meet");
    return 2 * pi * o.radius * (o.radius + o.height) + 2 * o.points * o.radius * o.depth * o.height;
}

void check_options(const GeneratorOptions& options) {
    require(options.pattern != Pattern::quad, "the sheet is one of quads, and this takes triangles",
            "give the pattern \"regular\" or \"irregular\", or the method rmtr");
    require_positive("edge_length", options.edge_length);
    const double area = checked_area(options);
    const auto& [nx, nz] = options.cells;
    const bool by_cells =
        options.shape == GeneratorShape::sheet && options.pattern == Pattern::regular && (nx != 0 || nz != 0);
    if (by_cells) {
        require(nx > 0 && nz > 0, fmt::format("the sheet's cells are {} by {}", nx, nz),
                "give two positive numbers of cells");
        require((nx + 1.0) * (nz + 1.0) <= most_vertices, fmt::format("{} by {} cells are too many", nx, nz),
                "stay below 5 million vertices");
        return;
    }
    const double edge = options.edge_length;
    require(
        area / (row_height * edge * edge) <= most_vertices,
        fmt::format("edge_length {} makes more than 5 million vertices", edge),
        fmt::format("give an edge_length of at least {:.2g}", std::sqrt(area / (row_height * most_vertices)) * 1.01));
}

/// The options with an edge length that the shape can have: a torus with fewer than eight edges around its tube would
/// meet itself.
GeneratorOptions with_possible_edge(GeneratorOptions options) {
    if (options.shape == GeneratorShape::torus)
        options.edge_length = std::min(options.edge_length, 0.75 * options.tube);
    return options;
}

Shape make_shape(const GeneratorOptions& options) {
    switch (options.shape) {
    case GeneratorShape::sheet:
        return flat_sheet(options);
    case GeneratorShape::box:
        return box(options);
    case GeneratorShape::star:
        return star(options);
    case GeneratorShape::sphere:
        return options.pattern == Pattern::regular ? icosphere(options) : revolved(options);
    default:
        return revolved(options);
    }
}

/// The vertices by rings about vertex 0, each before those that are further away.
std::vector<int> ring_order(const PatchMesh& mesh) {
    std::vector<std::vector<int>> neighbours(mesh.points.size());
    for (const Face& face : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k) {
            neighbours[static_cast<std::size_t>(face[k])].push_back(face[(k + 1) % 3]);
            neighbours[static_cast<std::size_t>(face[k])].push_back(face[(k + 2) % 3]);
        }
    std::vector<int> order = {0};
    std::vector<bool> seen(mesh.points.size(), false);
    seen[0] = true;
    for (std::size_t i = 0; i < order.size(); ++i)
        for (int v : neighbours[static_cast<std::size_t>(order[i])])
            if (!seen[static_cast<std::size_t>(v)]) {
                seen[static_cast<std::size_t>(v)] = true;
                order.push_back(v);
            }
    return order;
}

/// The same mesh, numbered so that neighbours lie close in memory.
PatchMesh renumbered(const PatchMesh& mesh) {
    PatchMesh result;
    std::vector<int> number(mesh.points.size());
    for (int v : ring_order(mesh))
        number[static_cast<std::size_t>(v)] =
            result.add_vertex(mesh.point(v), mesh.vertex_patch[static_cast<std::size_t>(v)]);
    std::vector<std::pair<Face, int>> faces;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        Face face = mesh.faces[f];
        for (int& v : face)
            v = number[static_cast<std::size_t>(v)];
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        faces.emplace_back(face, mesh.face_patch[f]);
    }
    std::sort(faces.begin(), faces.end());
    for (const auto& [face, patch] : faces)
        result.add_face(face, patch);
    result.connect();
    return result;
}

void make_irregular(PatchMesh& mesh, const Projection& project, const GeneratorOptions& options) {
    // Irregular triangles of this area have a mean edge of edge_length.
    constexpr double area_share = 0.97;
    constexpr int rounds = 40;
    const double face_area = area_share * row_height / 2 * options.edge_length * options.edge_length;
    Random random(options.seed);
    mesh.connect();
    refine(mesh, face_area, project, random);
    mesh = renumbered(mesh);
    relax(mesh, rounds, project);
}

/// A thin or much twisted star needs edges short beside the gaps between its walls.
void refuse_meeting_walls(const TriangleMesh& mesh) {
    if (!intersecting_pairs(mesh.positions, mesh.faces, {}, 1).empty())
        refuse("the star's walls meet in a mesh as coarse as this", "give a smaller edge_length, twist_deg or depth");
}

} // namespace

TriangleMesh generate_mesh(const GeneratorOptions& requested) {
    check_options(requested);
    const GeneratorOptions options = with_possible_edge(requested);
    Shape shape = make_shape(options);
    if (options.pattern == Pattern::irregular)
        make_irregular(shape.mesh, shape.project, options);
    TriangleMesh mesh;
    mesh.positions = to_positions(shape.mesh.points);
    mesh.faces = std::move(shape.mesh.faces);
    if (options.shape == GeneratorShape::star)
        refuse_meeting_walls(mesh);
    return mesh;
}

} // namespace plisse
