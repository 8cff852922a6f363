#include "check_command.h"

#include <memory>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <plisse/mesh/check_mesh.h>
#include <plisse/mesh/read_mesh.h>
#include <plisse/scene/load_part.h>
#include <plisse/scene/mesh_check_json.h>
#include <plisse/spatial/intersections.h>

#include "exit_status.h"

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

struct CheckArguments {
    std::vector<std::string> files;
    bool json = false;
};

struct CheckedMesh {
    std::string file;
    MeshFile read;
    MeshCheck check;
};

/// A face of the first mesh that meets a face of the second.
struct Meeting {
    std::size_t mesh_a, mesh_b;
    int face_a, face_b;
};

std::vector<CheckedMesh> check_each(const std::vector<std::string>& files) {
    std::vector<CheckedMesh> meshes;
    for (const std::string& file : files) {
        MeshFile read = read_mesh(file);
        const MeshCheck check = check_mesh(read.mesh);
        meshes.push_back({file, std::move(read), check});
    }
    return meshes;
}

/// Intersections between different meshes; those within one are in its own check.
std::vector<Meeting> find_meetings(const std::vector<CheckedMesh>& meshes) {
    if (meshes.size() < 2)
        return {};
    TriangleMesh all;
    std::vector<std::size_t> mesh_of_face;
    std::vector<int> first_face;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        first_face.push_back(all.face_count());
        append_mesh(all, meshes[m].read.mesh);
        mesh_of_face.resize(all.faces.size(), m);
    }
    const auto of_mesh = [&](int face) { return mesh_of_face[static_cast<std::size_t>(face)]; };
    std::vector<Meeting> meetings;
    for (const auto& [a, b] :
         intersecting_pairs(all.positions, all.faces, [&](int p, int q) { return of_mesh(p) == of_mesh(q); }))
        meetings.push_back({of_mesh(a), of_mesh(b), a - first_face[of_mesh(a)], b - first_face[of_mesh(b)]});
    return meetings;
}

bool all_usable(const std::vector<CheckedMesh>& meshes, const std::vector<Meeting>& meetings) {
    return meetings.empty() &&
           std::all_of(meshes.begin(), meshes.end(), [](const CheckedMesh& mesh) { return mesh.check.usable(); });
}

Json mesh_json(const CheckedMesh& mesh) {
    Json json = {{"file", mesh.file}, {"usable", mesh.check.usable()}};
    json.update(counts_json(mesh.check));
    json["places"] = {{"non_manifold_edges", mesh.check.non_manifold_edges},
                      {"inconsistent_edges", mesh.check.inconsistent_edges},
                      {"non_manifold_vertices", mesh.check.non_manifold_vertices},
                      {"degenerate_faces", mesh.check.degenerate_faces},
                      {"duplicate_faces", mesh.check.duplicate_faces},
                      {"intersecting_faces", mesh.check.intersecting_faces}};
    json["notes"] = mesh.read.notes;
    return json;
}

/// Sums over all meshes, then each mesh, then the intersections between meshes.
Json report_json(const std::vector<CheckedMesh>& meshes, const std::vector<Meeting>& meetings) {
    Json json = {{"usable", all_usable(meshes, meetings)}};
    for (const CheckedMesh& mesh : meshes) {
        const Json counts = counts_json(mesh.check);
        for (const auto& [key, count] : counts.items())
            json[key] = json.value(key, 0) + count.get<int>();
    }
    json["intersecting_face_pairs"] = json["intersecting_face_pairs"].get<std::size_t>() + meetings.size();
    json["meshes"] = Json::array();
    for (const CheckedMesh& mesh : meshes)
        json["meshes"].push_back(mesh_json(mesh));
    json["between"] = Json::array();
    for (const Meeting& m : meetings)
        json["between"].push_back({{"file_a", meshes[m.mesh_a].file},
                                   {"face_a", m.face_a},
                                   {"file_b", meshes[m.mesh_b].file},
                                   {"face_b", m.face_b}});
    return json;
}

void print_text(const std::vector<CheckedMesh>& meshes, const std::vector<Meeting>& meetings) {
    for (const CheckedMesh& mesh : meshes) {
        const MeshCheck& c = mesh.check;
        fmt::print("{}: {} vertices, {} faces, components: {}, boundary loops: {}, Euler characteristic: {}, "
                   "vertices no face uses: {}\n",
                   mesh.file, c.vertices, c.faces, c.components, c.boundary_loops, c.euler_characteristic,
                   c.unreferenced_vertices);
        fmt::print("  non-manifold edges: {}, non-manifold vertices: {}, inconsistent edges: {}, degenerate faces: {}, "
                   "duplicate faces: {}, intersecting face pairs: {}\n",
                   c.non_manifold_edges.size(), c.non_manifold_vertices.size(), c.inconsistent_edges.size(),
                   c.degenerate_faces.size(), c.duplicate_faces.size(), c.intersecting_faces.size());
        for (const std::string& note : mesh.read.notes)
            fmt::print("  note: {}\n", note);
        if (!c.non_manifold_edges.empty())
            fmt::print("  {} sheets are joined at the non-manifold edges: a body may be so\n", c.sheets);
        for (const std::string& finding : describe_findings(c, mesh.read.mesh))
            fmt::print("  {}\n", finding);
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(meetings.size(), 5); ++i)
        fmt::print("face {} of {} meets face {} of {}\n", meetings[i].face_a, meshes[meetings[i].mesh_a].file,
                   meetings[i].face_b, meshes[meetings[i].mesh_b].file);
    if (meshes.size() > 1)
        fmt::print("intersecting face pairs between meshes: {}\n", meetings.size());
    fmt::print("{}\n", all_usable(meshes, meetings) ? "usable" : "not usable");
}

void check_files(const CheckArguments& arguments) {
    const std::vector<CheckedMesh> meshes = check_each(arguments.files);
    const std::vector<Meeting> meetings = find_meetings(meshes);
    if (arguments.json)
        fmt::print("{}\n", report_json(meshes, meetings).dump(2));
    else
        print_text(meshes, meetings);
    if (!all_usable(meshes, meetings))
        throw ExitStatus{ExitCode::failed};
}

} // namespace

void add_check_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("check", "Says whether meshes, taken together, are usable");
    auto arguments = std::make_shared<CheckArguments>();
    command->add_option("MESH", arguments->files, "OBJ, PLY, STL or OFF files")->required();
    command->add_flag("--json", arguments->json, "prints one JSON object");
    command->callback([arguments] { check_files(*arguments); });
}

} // namespace plisse
