#include <plisse/exports/write_gltf.h>

#include <cstdint>
#include <string_view>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/exports/gltf_buffer.h>
#include <plisse/exports/parts.h>
#include <plisse/exports/unfinished_files.h>
#include <plisse/exports/vertex_normals.h>
#include <plisse/mesh/binary_bytes.h>

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

/// Viewers keep morph targets as layers of one texture; graphics cards rarely have more layers.
constexpr std::size_t most_states = 2048;
/// A .glb counts its bytes in 32 bits; some room is left for its JSON.
constexpr double most_bytes = 4.0e9;

bool is_binary(const std::filesystem::path& path) {
    return path.extension() == ".glb" || path.extension() == ".GLB";
}

/// A part as glTF wants it: a vertex has one place on the texture, so those on seams are doubled.
struct Shape {
    const PartMesh* part = nullptr;
    bool moves = false;
    std::vector<int> source; ///< of each vertex: that of the part; empty where they are the same
    Eigen::Matrix3Xf first_points, first_normals;

    std::size_t vertex_count() const { return source.empty() ? part->vertices.size() : source.size(); }
    const std::vector<Face>& faces() const { return source.empty() ? part->faces : part->texture.faces; }
    Eigen::Matrix3Xf spread(const Eigen::Matrix3Xf& of_part) const {
        return source.empty() ? of_part : Eigen::Matrix3Xf(of_part(Eigen::all, source));
    }
    Eigen::Matrix3Xf points(const Positions& positions) const { return spread(part->points_of(positions)); }
    Eigen::Matrix3Xf normals(const Positions& positions) const {
        return spread(vertex_normals(positions(Eigen::all, part->vertices), part->faces));
    }
};

std::vector<Shape> make_shapes(const Animation& animation, const std::vector<PartMesh>& parts) {
    const std::vector<bool> moving = find_moving_parts(animation, parts);
    std::vector<Shape> shapes;
    for (std::size_t p = 0; p < parts.size(); ++p)
        shapes.push_back({&parts[p], moving[p], parts[p].texture.vertices, {}, {}});
    return shapes;
}

void expect_readable_size(const std::filesystem::path& path, std::size_t states, const std::vector<Shape>& shapes) {
    if (states > most_states)
        throw InputError(path.string(), fmt::format("{} states are more morph targets than viewers take", states),
                         fmt::format("export at most {}, or another format", most_states));
    constexpr double vertex_bytes = 6 * sizeof(float), texture_bytes = 2 * sizeof(float);
    double bytes = static_cast<double>(states * states) * sizeof(float);
    for (const Shape& shape : shapes) {
        const auto vertices = static_cast<double>(shape.vertex_count());
        bytes += vertices * (texture_bytes + vertex_bytes * (shape.moves ? static_cast<double>(states) : 1.0));
        bytes += static_cast<double>(shape.faces().size()) * sizeof(Face);
    }
    if (bytes > most_bytes)
        throw InputError(path.string(), fmt::format("glTF would need {:.1f} GB, and can hold 4", bytes / 1e9),
                         "export fewer states, a coarser level, or another format");
}

Json material_of(const PartMesh& part) {
    return {{"name", part.name},
            {"doubleSided", true},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {part.color[0], part.color[1], part.color[2], 1.0}},
              {"metallicFactor", 0.0},
              {"roughnessFactor", 0.8}}}};
}

Json first_mesh(Shape& shape, const Positions& positions, std::size_t material, GltfBuffer& buffer) {
    shape.first_points = shape.points(positions);
    shape.first_normals = shape.normals(positions);
    Json attributes = {{"POSITION", buffer.add_positions(shape.first_points)},
                       {"NORMAL", buffer.add_vectors(shape.first_normals)}};
    if (!shape.part->texture.empty())
        attributes["TEXCOORD_0"] = buffer.add_texture_points(shape.part->texture.points);
    Json primitive = {
        {"attributes", attributes}, {"indices", buffer.add_corners(shape.faces())}, {"material", material}};
    return {{"name", shape.part->name}, {"primitives", Json::array({std::move(primitive)})}};
}

/// Differences from the first state.
Json morph_target(const Shape& shape, const Positions& positions, GltfBuffer& buffer) {
    return {{"POSITION", buffer.add_positions(shape.points(positions) - shape.first_points)},
            {"NORMAL", buffer.add_vectors(shape.normals(positions) - shape.first_normals)}};
}

void add_morph_targets(const Animation& animation, const std::vector<Shape>& shapes, Json& meshes, GltfBuffer& buffer) {
    for (std::size_t k = 1; k < animation.size(); ++k) {
        const Positions positions = animation.state(k).positions;
        for (std::size_t p = 0; p < shapes.size(); ++p)
            if (shapes[p].moves) {
                meshes[p]["primitives"][0]["targets"].push_back(morph_target(shapes[p], positions, buffer));
                meshes[p]["extras"]["targetNames"].push_back(fmt::format("t = {:.6g} s", animation.times[k]));
            }
    }
}

/// At time k, target k - 1 alone.
std::vector<float> morph_weights(std::size_t states) {
    const std::size_t targets = states - 1;
    std::vector<float> weights(states * targets, 0.0F);
    for (std::size_t k = 1; k < states; ++k)
        weights[k * targets + k - 1] = 1;
    return weights;
}

/// One animation that plays all moving parts; the nodes of parts have the parts' numbers.
Json weight_animation(const Animation& animation, const std::vector<Shape>& shapes, GltfBuffer& buffer) {
    const std::vector<float> times(animation.times.begin(), animation.times.end());
    const int input = buffer.add_times(times);
    const int output = buffer.add_scalars(morph_weights(animation.size()));
    Json channels = Json::array();
    for (std::size_t p = 0; p < shapes.size(); ++p)
        if (shapes[p].moves)
            channels.push_back({{"sampler", 0}, {"target", {{"node", p}, {"path", "weights"}}}});
    const Json sampler = {{"input", input}, {"interpolation", "LINEAR"}, {"output", output}};
    return {{"name", animation.name}, {"samplers", Json::array({sampler})}, {"channels", std::move(channels)}};
}

Json make_document(const Animation& animation, std::vector<Shape>& shapes, GltfBuffer& buffer) {
    Json meshes = Json::array(), materials = Json::array(), nodes = Json::array(), children = Json::array();
    const Positions first = animation.state(0).positions;
    bool anything_moves = false;
    for (std::size_t p = 0; p < shapes.size(); ++p) {
        materials.push_back(material_of(*shapes[p].part));
        meshes.push_back(first_mesh(shapes[p], first, p, buffer));
        nodes.push_back({{"name", shapes[p].part->name}, {"mesh", p}});
        children.push_back(p);
        anything_moves = anything_moves || shapes[p].moves;
    }
    nodes.push_back({{"name", animation.name}, {"children", std::move(children)}});
    add_morph_targets(animation, shapes, meshes, buffer);

    Json document = {{"asset", {{"version", "2.0"}, {"generator", "plisse"}}},
                     {"scene", 0},
                     {"scenes", Json::array({{{"nodes", Json::array({shapes.size()})}}})},
                     {"nodes", std::move(nodes)},
                     {"meshes", std::move(meshes)},
                     {"materials", std::move(materials)}};
    if (anything_moves)
        document["animations"].push_back(weight_animation(animation, shapes, buffer));
    document["accessors"] = buffer.accessors();
    document["bufferViews"] = buffer.views();
    document["buffers"].push_back({{"byteLength", buffer.size()}});
    return document;
}

std::string text_of(const Json& document) {
    return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// A name as a relative reference.
std::string uri_of(const std::string& file) {
    std::string uri;
    for (char c : file) {
        const auto byte = static_cast<unsigned char>(c);
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           std::string_view("-._~").find(c) != std::string_view::npos;
        uri += plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
    }
    return uri;
}

void write_binary(OutputFile& file, std::string json, const std::filesystem::path& buffer_path,
                  std::uint64_t buffer_size) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    constexpr std::uint32_t magic = 0x46546C67, json_chunk = 0x4E4F534A, buffer_chunk = 0x004E4942;
    constexpr std::size_t headers = 12 + 8 + 8;
    std::string out;
    put_little_endian(out, magic);
    put_little_endian(out, std::uint32_t{2});
    put_little_endian(out, static_cast<std::uint32_t>(headers + json.size() + buffer_size));
    put_little_endian(out, static_cast<std::uint32_t>(json.size()));
    put_little_endian(out, json_chunk);
    out += json;
    put_little_endian(out, static_cast<std::uint32_t>(buffer_size));
    put_little_endian(out, buffer_chunk);
    file.write(out);
    file.append(buffer_path);
}

} // namespace

std::filesystem::path gltf_buffer_file(const std::filesystem::path& path) {
    return std::filesystem::path(path).replace_extension(".bin");
}

void write_gltf(const std::filesystem::path& path, const Animation& animation) {
    const std::vector<PartMesh> parts = split_parts(animation, animation.state(0));
    std::vector<Shape> shapes = make_shapes(animation, parts);
    expect_readable_size(path, animation.size(), shapes);

    UnfinishedFiles unfinished;
    const std::filesystem::path beside = gltf_buffer_file(path);
    const std::filesystem::path buffer_path =
        is_binary(path) ? unfinished.add_scratch(path) : unfinished.add_file(beside);
    GltfBuffer buffer(buffer_path);
    Json document = make_document(animation, shapes, buffer);
    buffer.close();
    OutputFile file(unfinished.add_file(path));
    if (is_binary(path)) {
        write_binary(file, text_of(document), buffer_path, buffer.size());
    } else {
        document["buffers"][0]["uri"] = uri_of(beside.filename().string());
        file.write(text_of(document));
    }
    file.close();
    unfinished.finish();
}

} // namespace plisse
