#include <plisse/exports/texture_map.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace plisse {

namespace {

using Domain = MeshAttribute::Domain;

Vec2 value_at(const MeshAttribute& uv, std::size_t element) {
    return {uv.values[2 * element], uv.values[2 * element + 1]};
}

TextureMap map_of_vertices(const MeshAttribute& uv, const TriangleMesh& mesh) {
    TextureMap map;
    for (std::size_t v = 0; v < uv.values.size() / 2; ++v)
        map.points.push_back(value_at(uv, v));
    map.vertices.resize(map.points.size());
    std::iota(map.vertices.begin(), map.vertices.end(), 0);
    map.faces = mesh.faces;
    return map;
}

/// Its points are ordered by their vertices.
TextureMap map_of_corners(const MeshAttribute& uv, const TriangleMesh& mesh) {
    using Key = std::tuple<int, double, double>;
    const auto key_of = [&](std::size_t f, std::size_t corner) {
        const Vec2 point = value_at(uv, 3 * f + corner);
        return Key(mesh.faces[f][corner], point.x(), point.y());
    };
    std::map<Key, int> numbers;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t corner = 0; corner < 3; ++corner)
            numbers.emplace(key_of(f, corner), 0);

    TextureMap map;
    for (auto& [key, number] : numbers) {
        number = static_cast<int>(map.points.size());
        map.points.emplace_back(std::get<1>(key), std::get<2>(key));
        map.vertices.push_back(std::get<0>(key));
    }
    map.faces.resize(mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t corner = 0; corner < 3; ++corner)
            map.faces[f][corner] = numbers.at(key_of(f, corner));
    return map;
}

} // namespace

TextureMap texture_map(const TriangleMesh& mesh) {
    const auto uv = std::find_if(mesh.attributes.begin(), mesh.attributes.end(), [](const MeshAttribute& attribute) {
        return attribute.name == "uv" && attribute.width == 2 && attribute.domain != Domain::face;
    });
    if (uv == mesh.attributes.end())
        return {};
    return uv->domain == Domain::vertex ? map_of_vertices(*uv, mesh) : map_of_corners(*uv, mesh);
}

} // namespace plisse
