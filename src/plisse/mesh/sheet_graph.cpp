#include <plisse/mesh/sheet_graph.h>

#include <algorithm>

#include <plisse/mesh/unions.h>

namespace plisse {

namespace {

/// The edges at each vertex that do not have two faces.
std::vector<std::vector<int>> curve_edges_around(const Connectivity& connectivity) {
    std::vector<std::vector<int>> around(static_cast<std::size_t>(connectivity.vertex_count()));
    for (int e = 0; e < connectivity.edge_count(); ++e)
        if (connectivity.is_curve_edge(e))
            for (int v : connectivity.edges()[static_cast<std::size_t>(e)])
                around[static_cast<std::size_t>(v)].push_back(e);
    return around;
}

/// Whether one curve runs through the vertex from the first of its curve edges to the second, and each of its sheets
/// there has both on its border.
bool runs_through(const Connectivity& connectivity, int vertex, std::span<const int> curve_edges) {
    if (curve_edges.size() != 2)
        return false;
    const auto first = connectivity.edge_faces(curve_edges[0]), second = connectivity.edge_faces(curve_edges[1]);
    if (first.size() != second.size())
        return false;
    const auto around = connectivity.vertex_faces(vertex);
    const auto place = [&](int face) {
        return static_cast<int>(std::lower_bound(around.begin(), around.end(), face) - around.begin());
    };
    Unions fans(static_cast<int>(around.size()));
    for (int face : around)
        for (int e : connectivity.face_edges()[static_cast<std::size_t>(face)]) {
            const Edge& ends = connectivity.edges()[static_cast<std::size_t>(e)];
            if ((ends[0] == vertex || ends[1] == vertex) && !connectivity.is_curve_edge(e))
                fans.join(place(connectivity.edge_faces(e)[0]), place(connectivity.edge_faces(e)[1]));
        }
    const auto roots = [&](std::span<const int> faces) {
        std::vector<int> result;
        for (int face : faces)
            result.push_back(fans.root(place(face)));
        std::sort(result.begin(), result.end());
        return result;
    };
    const std::vector<int> at_first = roots(first);
    return at_first == roots(second) && std::adjacent_find(at_first.begin(), at_first.end()) == at_first.end();
}

} // namespace

SheetGraph sheet_graph(const Connectivity& connectivity) {
    SheetGraph graph;
    Unions sheets(connectivity.face_count()), curves(connectivity.edge_count());
    for (int e = 0; e < connectivity.edge_count(); ++e)
        if (!connectivity.is_curve_edge(e))
            sheets.join(connectivity.edge_faces(e)[0], connectivity.edge_faces(e)[1]);
    const auto around = curve_edges_around(connectivity);
    for (int v = 0; v < connectivity.vertex_count(); ++v) {
        const std::vector<int>& edges = around[static_cast<std::size_t>(v)];
        if (runs_through(connectivity, v, edges))
            curves.join(edges[0], edges[1]);
        else
            graph.corners += !edges.empty();
    }
    for (int f = 0; f < connectivity.face_count(); ++f)
        graph.sheets += sheets.root(f) == f;
    for (int e = 0; e < connectivity.edge_count(); ++e)
        graph.curves += connectivity.is_curve_edge(e) && curves.root(e) == e;
    return graph;
}

} // namespace plisse
