#pragma once

#include <vector>

#include <plisse/contact/collision_mesh.h>
#include <plisse/geometry/ccd.h>

namespace plisse {

/// How far primitives are from other parts at rest, where that is little. Bodies that start close to each other repel
/// within a shorter range. Were it a matter of each pair's own distance at rest, the range would change from one edge
/// of the other part to the next as one slides over it; each primitive keeps what it has to the part as a whole.
class Clearances {
public:
    /// Looks for distances below `beyond`, m.
    Clearances(const CollisionMesh& mesh, double beyond);

    /// The lesser of what a vertex and a face, or two edges, of different parts have to each other's part, m: at most
    /// their own distance at rest. Infinity where both are beyond.
    double between(StencilKind kind, const std::array<int, 2>& primitives) const;

private:
    struct Clearance {
        int primitive, part;
        double distance; ///< m
    };
    /// What a vertex or an edge has, what it belongs to has too.
    void add_vertex(int vertex, int part, double distance);
    void add_edge(int edge, int part, double distance);
    static void keep_least(std::vector<Clearance>& clearances);
    static double find(const std::vector<Clearance>& clearances, int primitive, int part);
    int part_of(int vertex) const { return mesh_.part[static_cast<std::size_t>(vertex)]; }

    const CollisionMesh& mesh_;
    std::vector<Clearance> of_vertex_, of_face_, of_edge_; ///< by primitive, then part
};

} // namespace plisse
