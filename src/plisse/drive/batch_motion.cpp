#include <plisse/drive/batch_motion.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

#include <plisse/base/parallel.h>
#include <plisse/contact/candidates.h>
#include <plisse/drive/pair_motion.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Which record of the batch moves a vertex, and where it still has to go.
struct Movers {
    std::unordered_map<int, int> record_of;
    bool moves(int v) const { return record_of.contains(v); }
};

class PairFinder {
public:
    PairFinder(const ExpandingMesh& mesh, const Movers& movers, double margin)
        : mesh_(mesh), movers_(movers), margin_(margin) {}

    Box reach(int v) const {
        Box box{mesh_.position(v), mesh_.position(v)};
        if (movers_.moves(v))
            box.include(mesh_.targets().col(v));
        return box;
    }

    /// Pairs of the primitives of the faces around i and j with those of faces near them.
    std::vector<MovingPair> find(const Collapse& collapse) const {
        std::vector<MovingPair> pairs;
        std::vector<int> near;
        for (int v : {collapse.i, collapse.j})
            for (int f : mesh_.faces().vertex_faces(v)) {
                mesh_.grid().query(mesh_.grid().box(f).inflated(margin_), near);
                for (int other : near)
                    if (other != f && !(mesh_.is_obstacle_face(f) && mesh_.is_obstacle_face(other)))
                        add_face_pair(mesh_.faces().face(f), mesh_.faces().face(other), pairs);
            }
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        return pairs;
    }

private:
    void add_face_pair(const Face& a, const Face& b, std::vector<MovingPair>& pairs) const {
        for (const auto& [point_face, face] : {std::pair(a, b), std::pair(b, a)})
            for (int v : point_face)
                if (std::find(face.begin(), face.end(), v) == face.end())
                    add(StencilKind::point_triangle, {v, face[0], face[1], face[2]}, 1, pairs);
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) {
                std::array<int, 4> edges = {a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]};
                if (edges[0] == edges[2] || edges[0] == edges[3] || edges[1] == edges[2] || edges[1] == edges[3])
                    continue;
                std::sort(edges.begin(), edges.begin() + 2);
                std::sort(edges.begin() + 2, edges.end());
                if (edges[2] < edges[0]) {
                    std::swap(edges[0], edges[2]);
                    std::swap(edges[1], edges[3]);
                }
                add(StencilKind::edge_edge, edges, 2, pairs);
            }
    }

    void add(StencilKind kind, std::array<int, 4> vertices, int first_count, std::vector<MovingPair>& pairs) const {
        if (kind == StencilKind::point_triangle)
            std::sort(vertices.begin() + 1, vertices.end());
        if (std::none_of(vertices.begin(), vertices.end(), [&](int v) { return movers_.moves(v); }))
            return;
        Box first, second;
        for (int k = 0; k < 4; ++k)
            (k < first_count ? first : second).include(reach(vertices[at(k)]));
        if (first.inflated(margin_).overlaps(second))
            pairs.push_back({kind, vertices});
    }

    const ExpandingMesh& mesh_;
    const Movers& movers_;
    double margin_;
};

/// Records that share pairs move together.
class Clusters {
public:
    explicit Clusters(int count) : parent_(at(count)) { std::iota(parent_.begin(), parent_.end(), 0); }
    int root(int r) {
        while (parent_[at(r)] != r)
            r = parent_[at(r)] = parent_[at(parent_[at(r)])];
        return r;
    }
    void join(int a, int b) {
        a = root(a);
        b = root(b);
        parent_[at(std::max(a, b))] = std::min(a, b);
    }

private:
    std::vector<int> parent_;
};

struct Cluster {
    std::vector<int> records; ///< positions in the batch
    std::vector<MovingPair> pairs;
};

std::vector<Cluster> cluster_records(const std::vector<std::vector<MovingPair>>& pairs, const Movers& movers) {
    const int count = static_cast<int>(pairs.size());
    Clusters clusters(count);
    for (int r = 0; r < count; ++r)
        for (const MovingPair& pair : pairs[at(r)])
            for (int v : pair.vertices)
                if (const auto found = movers.record_of.find(v); found != movers.record_of.end())
                    clusters.join(r, found->second);
    std::vector<Cluster> result;
    std::unordered_map<int, std::size_t> number;
    for (int r = 0; r < count; ++r) {
        const auto [entry, fresh] = number.try_emplace(clusters.root(r), result.size());
        if (fresh)
            result.emplace_back();
        Cluster& cluster = result[entry->second];
        cluster.records.push_back(r);
        cluster.pairs.insert(cluster.pairs.end(), pairs[at(r)].begin(), pairs[at(r)].end());
    }
    for (Cluster& cluster : result) {
        std::sort(cluster.pairs.begin(), cluster.pairs.end());
        cluster.pairs.erase(std::unique(cluster.pairs.begin(), cluster.pairs.end()), cluster.pairs.end());
    }
    return result;
}

} // namespace

BatchMotionResult move_batch(ExpandingMesh& mesh, const std::vector<int>& records, const BatchMotionOptions& options) {
    const auto& collapses = mesh.discretization().hierarchy().collapses;
    std::vector<const Collapse*> batch;
    Movers movers;
    for (int c : records) {
        const int number = static_cast<int>(batch.size());
        batch.push_back(&collapses[at(c)]);
        movers.record_of[batch.back()->i] = number;
        movers.record_of[batch.back()->j] = number;
    }
    const PairFinder finder(mesh, movers, options.margin);
    for (const Collapse* collapse : batch)
        for (int v : {collapse->i, collapse->j})
            mesh.update_boxes(mesh.faces().vertex_faces(v), [&](int w) { return finder.reach(w); });

    std::vector<std::vector<MovingPair>> pairs(batch.size());
    parallel_for(static_cast<int>(batch.size()), 4, [&](int r) { pairs[at(r)] = finder.find(*batch[at(r)]); });
    const std::vector<Cluster> clusters = cluster_records(pairs, movers);

    std::vector<int> stopped(clusters.size());
    parallel_for(static_cast<int>(clusters.size()), 1, [&](int c) {
        std::vector<int> vertices;
        for (int r : clusters[at(c)].records)
            vertices.insert(vertices.end(), {batch[at(r)]->i, batch[at(r)]->j});
        stopped[at(c)] = move_apart(mesh.positions(), mesh.targets(), mesh.rest(), vertices, clusters[at(c)].pairs,
                                    {options.reference_gap, 0});
    });

    BatchMotionResult result;
    result.min_gap = std::numeric_limits<double>::infinity();
    result.stopped_vertices = std::accumulate(stopped.begin(), stopped.end(), 0);
    for (std::size_t r = 0; r < batch.size(); ++r) {
        double least = std::numeric_limits<double>::infinity();
        for (const MovingPair& pair : pairs[r]) {
            const Stencil x = gather(mesh.positions(), pair.vertices);
            least = std::min(least, std::sqrt(separate(pair.kind, x).squared_distance));
        }
        result.min_gap = std::min(result.min_gap, least);
        if (least < options.least_gap)
            result.tight_records.push_back(records[r]);
    }
    for (const Collapse* collapse : batch)
        for (int v : {collapse->i, collapse->j})
            mesh.update_boxes(mesh.faces().vertex_faces(v), [&](int w) {
                return Box{mesh.position(w), mesh.position(w)};
            });
    return result;
}

} // namespace plisse
