#include <plisse/mesh/shapes.h>

#include <algorithm>
#include <map>

#include <plisse/mesh/portable_math.h>

namespace plisse {

namespace {

/// Corners of the icosahedron on the unit sphere: the top, five above and five below the equator, the bottom.
std::array<Vec3, 12> icosahedron_corners() {
    const double y = std::sqrt(0.2);
    const double radius = 2 * y;
    std::array<Vec3, 12> corners;
    corners[0] = {0, 1, 0};
    corners[11] = {0, -1, 0};
    for (int i = 0; i < 5; ++i) {
        const CosSin above = cos_sin_turns(i / 5.0);
        const CosSin below = cos_sin_turns((i + 0.5) / 5.0);
        corners[static_cast<std::size_t>(1 + i)] = {radius * above.cos, y, -radius * above.sin};
        corners[static_cast<std::size_t>(6 + i)] = {radius * below.cos, -y, -radius * below.sin};
    }
    return corners;
}

std::vector<Face> icosahedron_faces() {
    std::vector<Face> faces;
    for (int i = 0; i < 5; ++i) {
        const int a = 1 + i;
        const int b = 1 + (i + 1) % 5;
        const int c = 6 + i;
        const int d = 6 + (i + 1) % 5;
        faces.push_back({0, a, b});
        faces.push_back({a, c, b});
        faces.push_back({b, c, d});
        faces.push_back({11, d, c});
    }
    return faces;
}

} // namespace

Shape icosphere(const GeneratorOptions& options) {
    const double radius = options.radius;
    const auto corners = icosahedron_corners();
    // n^2 equal triangles a face, their areas adding to the sphere's.
    const int n = divisions(radius * std::sqrt(pi / 5 / (row_height / 2)), options.edge_length);
    PatchMesh mesh;
    using Weights = std::array<std::pair<int, int>, 3>; // (corner, weight), which name a point from every face alike
    std::map<Weights, int> numbers;
    const auto vertex = [&](const Face& face, int wa, int wb) {
        Weights weights = {{{face[0], wa}, {face[1], wb}, {face[2], n - wa - wb}}};
        for (auto& [corner, weight] : weights)
            corner = weight == 0 ? -1 : corner;
        std::sort(weights.begin(), weights.end());
        const auto [place, is_new] = numbers.try_emplace(weights, mesh.vertex_count());
        if (is_new) {
            Vec3 p = Vec3::Zero();
            for (const auto& [corner, weight] : weights)
                if (weight > 0)
                    p += weight * corners[static_cast<std::size_t>(corner)];
            mesh.add_vertex(p * (radius / length(p)), 0);
        }
        return place->second;
    };
    for (const Face& face : icosahedron_faces())
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                const int a = vertex(face, n - i - j, i);
                const int b = vertex(face, n - i - j - 1, i + 1);
                const int c = vertex(face, n - i - j - 1, i);
                mesh.add_face({a, b, c}, 0);
                if (i + j + 2 <= n)
                    mesh.add_face({b, vertex(face, n - i - j - 2, i + 1), c}, 0);
            }
    return {std::move(mesh), [](int, const Vec3& p) { return p; }};
}

} // namespace plisse
