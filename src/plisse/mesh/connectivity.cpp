#include <plisse/mesh/connectivity.h>

#include <algorithm>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include <plisse/mesh/unions.h>

namespace plisse {

namespace {

struct HalfEdge {
    Edge edge;
    int face;
    int corner;
};

std::vector<HalfEdge> sorted_half_edges(std::span<const Face> faces) {
    std::vector<HalfEdge> half_edges;
    half_edges.reserve(3 * faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = faces[f][static_cast<std::size_t>(k)];
            const int b = faces[f][static_cast<std::size_t>((k + 1) % 3)];
            half_edges.push_back({{std::min(a, b), std::max(a, b)}, static_cast<int>(f), k});
        }
    std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& p, const HalfEdge& q) {
        return std::tie(p.edge, p.face, p.corner) < std::tie(q.edge, q.face, q.corner);
    });
    return half_edges;
}

} // namespace

Connectivity::Connectivity(int vertex_count, std::span<const Face> faces) : face_edges_(faces.size()) {
    for (const HalfEdge& half : sorted_half_edges(faces)) {
        const auto f = static_cast<std::size_t>(half.face);
        if (edges_.empty() || edges_.back() != half.edge) {
            edges_.push_back(half.edge);
            edge_offsets_.push_back(static_cast<int>(edge_faces_.size()));
        }
        face_edges_[f][static_cast<std::size_t>(half.corner)] = edge_count() - 1;
        edge_faces_.push_back(half.face);
        opposite_.push_back(faces[f][static_cast<std::size_t>((half.corner + 2) % 3)]);
    }
    edge_offsets_.push_back(static_cast<int>(edge_faces_.size()));

    vertex_faces_offsets_.assign(static_cast<std::size_t>(vertex_count) + 1, 0);
    for (const Face& face : faces)
        for (int v : face)
            ++vertex_faces_offsets_[static_cast<std::size_t>(v) + 1];
    std::partial_sum(vertex_faces_offsets_.begin(), vertex_faces_offsets_.end(), vertex_faces_offsets_.begin());
    vertex_faces_.resize(3 * faces.size());
    std::vector<int> next(vertex_faces_offsets_.begin(), vertex_faces_offsets_.end() - 1);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int v : faces[f])
            vertex_faces_[static_cast<std::size_t>(next[static_cast<std::size_t>(v)]++)] = static_cast<int>(f);
}

std::vector<int> Connectivity::non_manifold_edges() const {
    std::vector<int> result;
    for (int e = 0; e < edge_count(); ++e)
        if (edge_faces(e).size() > 2)
            result.push_back(e);
    return result;
}

std::vector<std::vector<int>> boundary_loops(const Connectivity& connectivity, std::span<const Face> faces) {
    std::unordered_map<int, int> successor; // along the boundary, surface on the left
    for (int e = 0; e < connectivity.edge_count(); ++e) {
        if (!connectivity.is_boundary_edge(e))
            continue;
        const Face& face = faces[static_cast<std::size_t>(connectivity.edge_faces(e)[0])];
        const int opposite = connectivity.opposite(e)[0];
        for (std::size_t k = 0; k < 3; ++k)
            if (face[k] != opposite && face[(k + 1) % 3] != opposite)
                successor[face[k]] = face[(k + 1) % 3];
    }
    std::vector<int> starts;
    for (const auto& [from, to] : successor)
        starts.push_back(from);
    std::sort(starts.begin(), starts.end());
    std::vector<std::vector<int>> loops;
    for (int start : starts) {
        if (!successor.contains(start))
            continue;
        std::vector<int>& loop = loops.emplace_back();
        for (int v = start; successor.contains(v);) {
            loop.push_back(v);
            const int next = successor.at(v);
            successor.erase(v);
            v = next;
        }
    }
    return loops;
}

std::vector<std::vector<int>> boundary_pieces(const Connectivity& connectivity) {
    std::vector<Face> edges;
    for (int e = 0; e < connectivity.edge_count(); ++e)
        if (connectivity.is_boundary_edge(e)) {
            const auto [a, b] = connectivity.edges()[static_cast<std::size_t>(e)];
            edges.push_back({a, b, b});
        }
    const std::vector<int> piece = components(connectivity.vertex_count(), edges);
    std::vector<std::vector<int>> pieces;
    for (std::size_t v = 0; v < piece.size(); ++v) {
        if (piece[v] < 0)
            continue;
        pieces.resize(std::max(pieces.size(), static_cast<std::size_t>(piece[v]) + 1));
        pieces[static_cast<std::size_t>(piece[v])].push_back(static_cast<int>(v));
    }
    return pieces;
}

std::vector<int> components(int vertex_count, std::span<const Face> faces) {
    Unions unions(vertex_count);
    std::vector<bool> used(static_cast<std::size_t>(vertex_count), false);
    for (const Face& face : faces)
        for (int v : face) {
            used[static_cast<std::size_t>(v)] = true;
            unions.join(face[0], v);
        }
    std::vector<int> number(static_cast<std::size_t>(vertex_count), -1);
    int next = 0;
    for (int v = 0; v < vertex_count; ++v) {
        if (!used[static_cast<std::size_t>(v)])
            continue;
        const int r = unions.root(v);
        if (r == v)
            number[static_cast<std::size_t>(v)] = next++;
        else
            number[static_cast<std::size_t>(v)] = number[static_cast<std::size_t>(r)];
    }
    return number;
}

} // namespace plisse
