#include <plisse/scene/load_part.h>

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <plisse/mesh/check_mesh.h>
#include <plisse/mesh/read_mesh.h>

namespace plisse {

namespace {

TriangleMesh generate(const Scene& scene, const GeneratorOptions& options, const std::string& pointer) {
    try {
        return generate_mesh(options);
    } catch (const InputError& error) {
        throw scene.error_at(pointer, error);
    }
}

std::filesystem::path existing_file(const Scene& scene, const std::string& file, const std::string& pointer) {
    std::filesystem::path path = scene.folder / file;
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        throw scene.error_at(pointer, fmt::format("there is no file {}", path.string()),
                             "give a path relative to the scene file");
    return path;
}

TriangleMesh read_file(const Scene& scene, const std::string& file, const std::string& pointer, Context& context) {
    const std::filesystem::path path = existing_file(scene, file, pointer);
    MeshFile read = read_mesh(path);
    for (const std::string& note : read.notes)
        context.on_message(fmt::format("{}: {}", path.string(), note));
    return std::move(read.mesh);
}

QuadMesh generate_quads(const Scene& scene, const GeneratorOptions& options, const std::string& pointer) {
    if (options.pattern != Pattern::quad)
        throw scene.error_at(pointer, "the method rmtr takes a mesh of quads",
                             "give a sheet of the pattern \"quad\", or an OBJ file of quads");
    std::array<int, 2> cells = options.cells;
    for (int axis = 0; axis < 2; ++axis)
        if (int& count = cells[static_cast<std::size_t>(axis)]; count == 0)
            count = std::max(1, static_cast<int>(std::lround(options.size[axis] / options.edge_length)));
    return quad_sheet({options.size.x(), options.size.y()}, cells);
}

void transform_positions(Positions& positions, const TransformSpec& transform) {
    const Mat3 linear = transform.scale * rotation_xyz(transform.rotate_deg);
    for (Eigen::Index i = 0; i < positions.cols(); ++i)
        positions.col(i) = (linear * positions.col(i) + transform.translate).eval();
}

std::size_t element_count(const TriangleMesh& mesh, MeshAttribute::Domain domain) {
    switch (domain) {
    case MeshAttribute::Domain::vertex:
        return static_cast<std::size_t>(mesh.vertex_count());
    case MeshAttribute::Domain::face:
        return mesh.faces.size();
    case MeshAttribute::Domain::corner:
        return 3 * mesh.faces.size();
    }
    return 0;
}

MeshAttribute* find_attribute(TriangleMesh& mesh, const std::string& name, MeshAttribute::Domain domain) {
    for (MeshAttribute& attribute : mesh.attributes)
        if (attribute.name == name && attribute.domain == domain)
            return &attribute;
    return nullptr;
}

/// The whole mesh's attribute that continues one of a part, made with zeros when it is new.
MeshAttribute& matching_attribute(TriangleMesh& whole, const MeshAttribute& of_part) {
    MeshAttribute wanted = of_part;
    MeshAttribute* found = find_attribute(whole, wanted.name, wanted.domain);
    if (found && found->width != wanted.width) {
        wanted.name += fmt::format("_{}", wanted.width);
        found = find_attribute(whole, wanted.name, wanted.domain);
    }
    if (found)
        return *found;
    wanted.values.assign(element_count(whole, wanted.domain) * static_cast<std::size_t>(wanted.width), 0.0);
    return whole.attributes.emplace_back(std::move(wanted));
}

} // namespace

TriangleMesh load_mesh(const Scene& scene, const MeshSpec& spec, const TransformSpec& transform,
                       const std::string& pointer, Context& context) {
    TriangleMesh mesh =
        spec.is_file() ? read_file(scene, spec.file, pointer, context) : generate(scene, spec.generator, pointer);
    transform_positions(mesh.positions, transform);
    return mesh;
}

QuadMesh load_quad_mesh(const Scene& scene, const MeshSpec& spec, const TransformSpec& transform,
                        const std::string& pointer) {
    QuadMesh mesh = spec.is_file() ? read_quad_mesh(existing_file(scene, spec.file, pointer))
                                   : generate_quads(scene, spec.generator, pointer);
    transform_positions(mesh.positions, transform);
    return mesh;
}

void expect_usable(const Scene& scene, const TriangleMesh& mesh, const MeshSpec& spec, const std::string& pointer,
                   bool allow_self_intersection) {
    MeshCheck check = check_mesh(mesh);
    if (allow_self_intersection)
        check.intersecting_faces.clear();
    if (check.usable())
        return;
    const std::string wrong = fmt::format("{}", fmt::join(describe_findings(check, mesh), ", "));
    const std::string right = "repair the mesh (`plisse check` lists everything)";
    if (spec.is_file())
        throw InputError((scene.folder / spec.file).string(), wrong, right);
    throw scene.error_at(pointer, wrong, right);
}

void expect_same_connectivity(const Scene& scene, const TriangleMesh& mesh, const TriangleMesh& other,
                              const std::string& pointer) {
    if (other.vertex_count() == mesh.vertex_count() && other.faces == mesh.faces)
        return;
    throw scene.error_at(pointer,
                         fmt::format("the connectivity is not that of the body's mesh: {} vertices and {} faces, "
                                     "expected {} and {} with the same corners in the same order",
                                     other.vertex_count(), other.face_count(), mesh.vertex_count(), mesh.face_count()),
                         "give a mesh that differs in positions only");
}

void append_mesh(TriangleMesh& whole, const TriangleMesh& part) {
    for (const MeshAttribute& attribute : part.attributes)
        matching_attribute(whole, attribute);
    const int offset = whole.vertex_count();
    whole.positions.conservativeResize(3, offset + part.vertex_count());
    whole.positions.rightCols(part.vertex_count()) = part.positions;
    for (const Face& face : part.faces)
        whole.faces.push_back({face[0] + offset, face[1] + offset, face[2] + offset});
    for (const MeshAttribute& attribute : part.attributes) {
        MeshAttribute& joined = matching_attribute(whole, attribute);
        joined.values.insert(joined.values.end(), attribute.values.begin(), attribute.values.end());
        if (joined.number != attribute.number)
            joined.number = MeshAttribute::Number::real;
    }
    for (MeshAttribute& attribute : whole.attributes)
        attribute.values.resize(element_count(whole, attribute.domain) * static_cast<std::size_t>(attribute.width),
                                0.0);
}

} // namespace plisse
