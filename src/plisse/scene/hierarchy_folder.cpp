#include <plisse/scene/hierarchy_folder.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <plisse/decimate/level_attributes.h>
#include <plisse/mesh/read_mesh.h>
#include <plisse/mesh/write_ply.h>
#include <plisse/scene/json_document.h>
#include <plisse/scene/whole_file.h>

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

std::filesystem::path level_file(const std::filesystem::path& folder, std::size_t level) {
    return folder / fmt::format("level-{}.ply", level);
}

Json map_json(const std::vector<Anchor>& anchors) {
    Json faces = Json::array(), weights = Json::array();
    for (const Anchor& anchor : anchors) {
        faces.push_back(anchor.face);
        weights.push_back({anchor.weights[0], anchor.weights[1], anchor.weights[2]});
    }
    return {{"faces", std::move(faces)}, {"weights", std::move(weights)}};
}

std::vector<Anchor> anchors_from(const Json& map) {
    const Json &faces = map.at("faces"), &weights = map.at("weights");
    std::vector<Anchor> anchors(faces.size());
    for (std::size_t i = 0; i < anchors.size(); ++i) {
        faces.at(i).get_to(anchors[i].face);
        for (std::size_t k = 0; k < 3; ++k)
            weights.at(i).at(k).get_to(anchors[i].weights[static_cast<Eigen::Index>(k)]);
    }
    return anchors;
}

/// Whether each anchor names a face of `coarse` and there is one for every vertex of `fine`.
bool fits(const std::vector<Anchor>& anchors, const TriangleMesh& coarse, const TriangleMesh& fine) {
    if (static_cast<int>(anchors.size()) != fine.vertex_count())
        return false;
    for (const Anchor& anchor : anchors)
        if (anchor.face < -1 || anchor.face >= coarse.face_count() || !anchor.weights.allFinite())
            return false;
    return true;
}

} // namespace

void write_hierarchy(const std::filesystem::path& folder, const DecimationResult& decimation,
                     const std::vector<MeshAttribute>& attributes) {
    const Hierarchy& hierarchy = decimation.hierarchy;
    Json map = {
        {"format", 1}, {"levels", hierarchy.level_count()}, {"to_finest", Json::array()}, {"to_next", Json::array()}};
    for (std::size_t l = 0; l < hierarchy.levels.size(); ++l) {
        const HierarchyLevel& level = hierarchy.levels[l];
        const bool finest = l + 1 == hierarchy.levels.size();
        write_ply(level_file(folder, l),
                  {level.rest, level.faces, attributes_on(hierarchy, static_cast<int>(l), attributes)});
        if (finest)
            continue;
        map["to_finest"].push_back(map_json(level.to_finest));
        map["to_next"].push_back(map_json(level.to_next));
    }
    write_file_atomically(folder / "hierarchy.bin", to_bytes(decimation));
    write_file_atomically(folder / "map.json", map.dump() + "\n");
}

HierarchyFiles read_hierarchy(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "map.json";
    const std::string bytes = read_bytes(file);
    const InputError broken(file.string(), "this is not the map of a hierarchy, or not of the meshes beside it",
                            "give a folder that `plisse hierarchy` wrote");
    HierarchyFiles files;
    try {
        const Json map = Json::parse(bytes);
        const auto levels = map.at("levels").get<std::size_t>();
        if (levels < 1 || map.at("to_finest").size() != levels - 1 || map.at("to_next").size() != levels - 1)
            throw broken;
        for (std::size_t l = 0; l < levels; ++l)
            files.levels.push_back(read_mesh(level_file(folder, l)).mesh);
        for (std::size_t l = 0; l + 1 < levels; ++l) {
            files.to_finest.push_back(anchors_from(map.at("to_finest").at(l)));
            files.to_next.push_back(anchors_from(map.at("to_next").at(l)));
            if (!fits(files.to_finest[l], files.levels[l], files.levels.back()) ||
                !fits(files.to_next[l], files.levels[l], files.levels[l + 1]))
                throw broken;
        }
    } catch (const Json::exception&) {
        throw broken;
    }
    return files;
}

Hierarchy read_collapses(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "hierarchy.bin";
    auto decimation = from_bytes(read_bytes(file));
    if (!decimation)
        throw InputError(file.string(), "the file is damaged, or another version of plisse wrote it",
                         "write the folder again with `plisse hierarchy`");
    return std::move(decimation->hierarchy);
}

} // namespace plisse
