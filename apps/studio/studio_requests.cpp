// What pages ask for by HTTP.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/mesh/check_mesh.h>
#include <plisse/mesh/mesh_formats.h>
#include <plisse/scene/mesh_check_json.h>
#include <plisse/scene/read_scene.h>
#include <plisse/spatial/box.h>

#include "scene_files.h"
#include "studio.h"

namespace plisse::studio {

namespace {

using Json = nlohmann::ordered_json;

/// A scene to begin with for a mesh that was sent: it hangs by nothing and falls onto a floor.
Json scene_of(const std::string& name, const std::string& file, const TriangleMesh& mesh) {
    const Box box = bounding_box(mesh.positions);
    const Vec3 center = 0.5 * (box.low + box.high);
    const double size = box.diagonal();
    const double floor = box.low.y() - 0.05 * size;
    const int levels = std::clamp(
        1 + static_cast<int>(std::lround(std::log(std::max(1.0, mesh.vertex_count() / 500.0)) / std::log(3.0))), 1, 6);
    return {{"plisse", 1},
            {"name", name},
            {"bodies", {{{"name", name}, {"mesh", file}, {"material", "cotton"}}}},
            {"obstacles",
             {{{"name", "floor"},
               {"mesh", {{"generate", "sheet"}, {"size", {3 * size, 3 * size}}, {"edge_length", 0.25 * size}}},
               {"transform", {{"translate", {center.x(), floor, center.z()}}}}}}},
            {"contact", {{"distance", 2e-3 * size}, {"friction", 0.3}}},
            {"hierarchy", {{"levels", levels}, {"coarsest_vertices", 500}}},
            {"solve", {{"time_step", 0.04}, {"duration", 1}, {"frame_interval", 0.04}}}};
}

/// The faces where it shows that the mesh cannot be used.
std::vector<int> marked_faces(const TriangleMesh& mesh, const MeshCheck& check) {
    std::vector<int> faces(check.degenerate_faces.begin(), check.degenerate_faces.end());
    for (const auto& pair : check.intersecting_faces)
        faces.insert(faces.end(), pair.begin(), pair.end());
    const auto touches = [](const Face& face, int v) { return std::find(face.begin(), face.end(), v) != face.end(); };
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Face& face = mesh.faces[f];
        const bool at_edge =
            std::any_of(check.inconsistent_edges.begin(), check.inconsistent_edges.end(),
                        [&](const auto& edge) { return touches(face, edge[0]) && touches(face, edge[1]); });
        const bool at_vertex = std::any_of(check.non_manifold_vertices.begin(), check.non_manifold_vertices.end(),
                                           [&](int v) { return touches(face, v); });
        if (at_edge || at_vertex)
            faces.push_back(static_cast<int>(f));
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
}

HttpAnswer unusable_answer(const std::string& message, const Json& findings) {
    HttpAnswer answer = refusal(422, message);
    answer.body = Json{{"ok", false}, {"message", message}, {"findings", findings}}.dump();
    return answer;
}

HttpAnswer ok_answer() {
    HttpAnswer answer;
    answer.body = R"({"ok": true})";
    return answer;
}

} // namespace

void Studio::on_request(HttpRequest request, Reply reply) {
    if (request.method == "GET")
        return reply(answer(request));
    const auto work = [this, request = std::move(request), reply] {
        try {
            reply(request.path == "/api/mesh" ? open_mesh(request.query, request.body) : open_scene_text(request.body));
        } catch (const InputError& error) {
            set_state(session_ ? State::idle : State::empty);
            reply(refusal(422, error.what()));
        }
    };
    tasks_.post({0, std::nullopt, work, Clock::now()}, true);
}

HttpAnswer Studio::answer(const HttpRequest& request) const {
    HttpAnswer answer;
    const auto rest_of = [&](std::string_view folder) -> std::string {
        return request.path.starts_with(folder) ? request.path.substr(folder.size()) : "";
    };
    if (request.path == "/api/gallery") {
        answer.body = gallery_json();
    } else if (const std::string picture = rest_of("/api/gallery/"); picture.ends_with(".png")) {
        const GalleryScene* scene = find_gallery_scene(picture.substr(0, picture.size() - 4));
        if (!scene || scene->picture.empty())
            return refusal(404, "there is no such picture");
        answer.content_type = "image/png";
        answer.body.assign(scene->picture.begin(), scene->picture.end());
    } else if (request.path == "/api/files") {
        answer.body = folder_.list();
    } else if (const std::string name = rest_of("/api/files/"); !name.empty()) {
        answer.file = folder_.file(name);
        if (answer.file.empty())
            return refusal(404, "nothing of this name has been saved");
        answer.content_type = "application/octet-stream";
        answer.download_name = name;
    } else {
        return refusal(404, "there is nothing here");
    }
    return answer;
}

HttpAnswer Studio::open_mesh(const std::map<std::string, std::string>& query, const std::string& bytes) {
    const auto given = query.find("name");
    const std::string name = given == query.end() ? "" : given->second;
    if (!is_plain_name(name))
        throw InputError("name", "this cannot name a mesh", "give a plain file name with its extension");
    const MeshFile read = parse_mesh(bytes, name);
    if (const MeshCheck check = check_mesh(read.mesh); !check.usable()) {
        const Board::Picture picture = projector_.unusable(read.mesh, marked_faces(read.mesh, check));
        board_.set_picture(picture);
        for (ClientId client : board_.clients())
            board_.show(client, picture);
        Json findings = counts_json(check);
        findings["meshes"] = {{{"notes", describe_findings(check, read.mesh)}}};
        return unusable_answer("this mesh cannot be used", findings);
    }
    const std::string file = folder_.keep_mesh(name, bytes);
    const std::string stem = std::filesystem::path(name).stem().string();
    begin(parse_scene(stem + ".json", scene_of(stem, file, read.mesh).dump(), folder_.files()), stem, State::idle);
    return ok_answer();
}

HttpAnswer Studio::open_scene_text(const std::string& text) {
    const Scene scene = parse_scene("the scene", text, folder_.files());
    expect_no_other_files(scene, {}, folder_.files());
    begin(scene, scene.name, State::idle);
    return ok_answer();
}

} // namespace plisse::studio
