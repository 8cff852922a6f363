#include <plisse/subdivide/control_mesh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <plisse/base/error.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Lays ghost faces around a mesh. Each boundary side h has two slots for ghosts: 2 h beyond its start, 2 h + 1 beyond
/// its end. Slots that are the same vertex are joined.
class GhostRing {
public:
    explicit GhostRing(const QuadMesh& quads)
        : quads_(quads), connectivity_(quads.vertex_count(), quads.faces), joined_(2 * at(connectivity_.side_count())),
          number_(joined_.size(), -1) {
        std::iota(joined_.begin(), joined_.end(), 0);
    }

    ControlCage run() {
        cage_.mesh.faces = quads_.faces;
        cage_.mesh.domain_face_count = quads_.face_count();
        cage_.mesh.domain_vertex_count = quads_.vertex_count();
        for (int v = 0; v < quads_.vertex_count(); ++v)
            if (connectivity_.is_boundary_vertex(v))
                add_boundary_vertex(v);
        join_slots();
        add_faces();
        place_ghosts();
        return std::move(cage_);
    }

private:
    /// A boundary vertex with the boundary sides that end and begin there; the surface is on their left.
    struct BoundaryVertex {
        int vertex, in, out;
        int faces;
        int corner_ghost; ///< across a convex corner
    };

    static int start_slot(int side) { return 2 * side; }
    static int end_slot(int side) { return 2 * side + 1; }

    std::string vertex_text(int v) const {
        const Vec3 p = quads_.positions.col(v);
        return fmt::format("vertex {} at ({:.6g}, {:.6g}, {:.6g})", v, p.x(), p.y(), p.z());
    }

    void add_boundary_vertex(int v) {
        const std::vector<int> star = connectivity_.star(v);
        const BoundaryVertex corner = {v, QuadConnectivity::previous(star.back()), star[0],
                                       static_cast<int>(star.size()), -1};
        if (corner.faces > 3)
            throw InputError("", fmt::format("{} faces meet on the boundary in {}", corner.faces, vertex_text(v)),
                             "let one to three faces meet there");
        if (corner.faces == 3 && angle(star) < 1.25 * std::numbers::pi)
            throw InputError("", "three faces meet on the boundary in " + vertex_text(v) + ", which is no inner corner",
                             "let two faces meet where the boundary runs on, one at an outer corner");
        boundary_.push_back(corner);
    }

    /// Of the surface at a vertex.
    double angle(const std::vector<int>& star) const {
        double sum = 0;
        for (int h : star) {
            const Vec3 p = quads_.positions.col(connectivity_.from(h));
            const Vec3 a = quads_.positions.col(connectivity_.to(h)) - p;
            const Vec3 b = quads_.positions.col(connectivity_.from(QuadConnectivity::previous(h))) - p;
            sum += std::atan2(a.cross(b).norm(), a.dot(b));
        }
        return sum;
    }

    int root(int slot) const {
        while (joined_[at(slot)] != slot)
            slot = joined_[at(slot)];
        return slot;
    }
    void join(int a, int b) {
        const int first = root(a), second = root(b);
        joined_[at(std::max(first, second))] = std::min(first, second);
    }

    void join_slots() {
        std::vector<int> reentrant_end(at(connectivity_.side_count()), -1);
        for (const BoundaryVertex& b : boundary_) {
            if (b.faces == 2)
                join(end_slot(b.in), start_slot(b.out));
            if (b.faces != 3)
                continue;
            join(start_slot(b.in), end_slot(b.out));
            for (int side : {b.in, b.out}) {
                if (reentrant_end[at(side)] >= 0)
                    throw InputError("",
                                     "a slot or hole is one face wide between " + vertex_text(b.vertex) + " and " +
                                         vertex_text(reentrant_end[at(side)]),
                                     "subdivide the mesh once");
                reentrant_end[at(side)] = b.vertex;
            }
        }
        reentrant_end_ = std::move(reentrant_end);
    }

    int ghost(int slot) {
        int& number = number_[at(root(slot))];
        if (number < 0)
            number = new_ghost();
        return number;
    }
    int new_ghost() { return cage_.mesh.domain_vertex_count + ghost_count_++; }

    void add_faces() {
        for (int h = 0; h < connectivity_.side_count(); ++h) {
            if (connectivity_.twin(h) >= 0)
                continue;
            cage_.mesh.boundary.push_back({h / 4, h % 4});
            if (reentrant_end_[at(h)] < 0)
                cage_.mesh.faces.push_back(
                    {connectivity_.to(h), connectivity_.from(h), ghost(start_slot(h)), ghost(end_slot(h))});
        }
        for (BoundaryVertex& b : boundary_) {
            if (b.faces == 3)
                cage_.mesh.faces.push_back(
                    {connectivity_.to(b.out), b.vertex, connectivity_.from(b.in), ghost(start_slot(b.in))});
            if (b.faces == 1) {
                b.corner_ghost = new_ghost();
                cage_.mesh.faces.push_back({b.vertex, ghost(end_slot(b.in)), b.corner_ghost, ghost(start_slot(b.out))});
            }
        }
        cage_.mesh.vertex_count = cage_.mesh.domain_vertex_count + ghost_count_;
    }

    void place_ghosts() {
        Positions& p = cage_.positions;
        p.resize(3, cage_.mesh.vertex_count);
        p.leftCols(quads_.vertex_count()) = quads_.positions;
        for (const BoundaryVertex& b : boundary_)
            place_beyond_edges(b);
        place_at_reentrant_corners();
        for (const BoundaryVertex& b : boundary_)
            if (b.faces == 1) // p = 2 p_0 - p_1 along both sides, with the twist of the face
                p.col(b.corner_ghost) = p.col(ghost(end_slot(b.in))) + p.col(ghost(start_slot(b.out))) +
                                        p.col(connectivity_.to(QuadConnectivity::next(b.out))) -
                                        p.col(connectivity_.from(b.in)) - p.col(connectivity_.to(b.out));
    }

    void place_beyond_edges(const BoundaryVertex& b) {
        Positions& p = cage_.positions;
        const auto reflected = [&](int v) { return 2 * p.col(b.vertex) - p.col(v); };
        if (b.faces == 2)
            p.col(ghost(start_slot(b.out))) = reflected(connectivity_.to(connectivity_.rotated(b.out)));
        if (b.faces == 1) {
            p.col(ghost(start_slot(b.out))) = reflected(connectivity_.from(b.in));
            p.col(ghost(end_slot(b.in))) = reflected(connectivity_.to(b.out));
        }
    }

    void place_at_reentrant_corners() {
        Positions& p = cage_.positions;
        std::map<int, std::vector<Vec3>> places; // of each ghost
        for (const BoundaryVertex& b : boundary_)
            if (b.faces == 3)
                places[ghost(start_slot(b.in))].emplace_back(p.col(connectivity_.from(b.in)) +
                                                             p.col(connectivity_.to(b.out)) - p.col(b.vertex));
        for (const auto& [g, of_corners] : places)
            p.col(g) = std::accumulate(of_corners.begin(), of_corners.end(), Vec3(Vec3::Zero())) /
                       static_cast<double>(of_corners.size());
    }

    const QuadMesh& quads_;
    QuadConnectivity connectivity_;
    std::vector<BoundaryVertex> boundary_;
    std::vector<int> joined_, number_;
    std::vector<int> reentrant_end_; ///< per boundary side: its end at a re-entrant corner, -1
    int ghost_count_ = 0;
    ControlCage cage_;
};

} // namespace

std::vector<Ghost> find_ghosts(const ControlMesh& mesh) {
    std::vector<Ghost> ghosts(at(mesh.ghost_count()), Ghost{Ghost::Kind::corner, -1});
    const auto is_domain = [&](int v) { return !mesh.is_ghost(v); };
    for (std::size_t f = at(mesh.domain_face_count); f < mesh.faces.size(); ++f)
        for (std::size_t k = 0; k < 4; ++k) {
            const Quad& face = mesh.faces[f];
            if (is_domain(face[k]))
                continue;
            Ghost& ghost = ghosts[at(face[k] - mesh.domain_vertex_count)];
            const int after = face[(k + 1) % 4], opposite = face[(k + 2) % 4], before = face[(k + 3) % 4];
            if (ghost.kind == Ghost::Kind::reentrant)
                continue;
            if (is_domain(after) && is_domain(before))
                ghost = {Ghost::Kind::reentrant, opposite};
            else if (is_domain(after) || is_domain(before))
                ghost = {Ghost::Kind::edge, is_domain(after) ? after : before};
            else if (ghost.kind == Ghost::Kind::corner)
                ghost.vertex = opposite;
        }
    return ghosts;
}

ControlCage with_ghost_ring(const QuadMesh& quads) {
    return GhostRing(quads).run();
}

} // namespace plisse
