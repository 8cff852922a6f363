#include <plisse/mesh/relax.h>

#include <algorithm>
#include <queue>

#include <plisse/mesh/portable_math.h>

namespace plisse {

namespace {

Vec3 face_area_vector(const PatchMesh& mesh, int face) {
    const auto [a, b, c] = mesh.faces[static_cast<std::size_t>(face)];
    return area_vector(mesh.point(a), mesh.point(b), mesh.point(c));
}

/// Whether the area vector lies within 70 degrees of another, so that the surface does not fold there.
bool faces_along(const Vec3& area, const Vec3& direction) {
    constexpr double squared_cosine = 0.12;
    const double product = dot(area, direction);
    return product > 0 && product * product > squared_cosine * dot(area, area) * dot(direction, direction);
}

/// Whether the angles at p and q, opposite the edge a b, add to more than pi: their cotangents to less than zero.
bool angles_exceed_pi(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q) {
    constexpr double round_off = 1e-9;
    const double cos_p = dot(a - p, b - p);
    const double cos_q = dot(a - q, b - q);
    if (cos_p >= 0 && cos_q >= 0)
        return false;
    const double sin_p = length(cross(a - p, b - p));
    const double sin_q = length(cross(a - q, b - q));
    return cos_p * sin_q + cos_q * sin_p < -round_off * sin_p * sin_q;
}

bool flip_improves(const PatchMesh& mesh, int corner) {
    const int other = mesh.twin(corner);
    if (other < 0)
        return false;
    const Vec3& a = mesh.point(mesh.vertex(corner));
    const Vec3& b = mesh.point(mesh.vertex(other));
    const Vec3& p = mesh.point(mesh.vertex(PatchMesh::previous(corner)));
    const Vec3& q = mesh.point(mesh.vertex(PatchMesh::previous(other)));
    if (!angles_exceed_pi(a, b, p, q) || !mesh.can_flip(corner))
        return false;
    const Vec3 now = area_vector(a, b, p) + area_vector(b, a, q);
    return faces_along(area_vector(a, q, p), now) && faces_along(area_vector(b, p, q), now);
}

/// Flips what the half-edges on the stack, and then their neighbours, need; calls changed(face) for each face that did.
template <typename Changed>
void legalise(PatchMesh& mesh, std::vector<int>& stack, const Changed& changed) {
    // Projection onto a curved surface spoils the proof that flips end, so a bound stands in for it.
    for (std::size_t left = 40 * mesh.faces.size() + 1000; !stack.empty() && left > 0;) {
        const int corner = stack.back();
        stack.pop_back();
        if (!flip_improves(mesh, corner))
            continue;
        --left;
        const int f = corner / 3;
        const int g = mesh.twin(corner) / 3;
        mesh.flip(corner);
        changed(f);
        changed(g);
        for (int outer : {3 * f, 3 * f + 2, 3 * g, 3 * g + 2})
            stack.push_back(outer);
    }
    stack.clear();
}

/// Where relaxation would have a vertex: the area-weighted mean of its faces' centroids.
Vec3 ring_centroid(const PatchMesh& mesh, int vertex) {
    Vec3 sum = Vec3::Zero();
    double weight = 0;
    const Vec3& v = mesh.point(vertex);
    mesh.around(vertex, [&](int corner) {
        const Vec3& a = mesh.point(mesh.vertex(PatchMesh::next(corner)));
        const Vec3& b = mesh.point(mesh.vertex(PatchMesh::previous(corner)));
        const double area = length(area_vector(v, a, b));
        sum += area * (a + b + v);
        weight += area;
    });
    return sum / (3 * weight);
}

bool move_is_safe(const PatchMesh& mesh, int vertex, const Vec3& target) {
    bool safe = true;
    mesh.around(vertex, [&](int corner) {
        const Vec3& a = mesh.point(mesh.vertex(PatchMesh::next(corner)));
        const Vec3& b = mesh.point(mesh.vertex(PatchMesh::previous(corner)));
        safe = safe && faces_along(area_vector(target, a, b), area_vector(mesh.point(vertex), a, b));
    });
    return safe;
}

void relax_vertex(PatchMesh& mesh, int vertex, const Projection& project) {
    // A centroid counts the vertex itself with a third; stepping further makes up for most of that.
    constexpr double stretch = 1.4;
    const Vec3 start = mesh.point(vertex);
    const Vec3 step = stretch * (ring_centroid(mesh, vertex) - start);
    for (double share : {1.0, 0.5, 0.25}) {
        const Vec3 target = project(mesh.vertex_patch[static_cast<std::size_t>(vertex)], start + share * step);
        if (move_is_safe(mesh, vertex, target)) {
            mesh.points[static_cast<std::size_t>(vertex)] = target;
            return;
        }
    }
}

Vec3 random_inner_point(const PatchMesh& mesh, int face, Random& random) {
    const auto [a, b, c] = mesh.faces[static_cast<std::size_t>(face)];
    const double wa = random.uniform(0.5, 1);
    const double wb = random.uniform(0.5, 1);
    const double wc = random.uniform(0.5, 1);
    return (wa * mesh.point(a) + wb * mesh.point(b) + wc * mesh.point(c)) / (wa + wb + wc);
}

/// The faces by area, largest first; entries of faces that have changed since are passed over.
class LargestFaces {
public:
    explicit LargestFaces(const PatchMesh& mesh) : mesh_(mesh) {
        for (int f = 0; f < mesh.face_count(); ++f)
            update(f);
    }

    void update(int face) {
        const auto f = static_cast<std::size_t>(face);
        if (f >= area_.size())
            area_.resize(f + 1, 0.0);
        const double area = 0.5 * length(face_area_vector(mesh_, face));
        total_ += area - area_[f];
        area_[f] = area;
        queue_.emplace(area, face);
    }

    double total() const { return total_; }

    int take() {
        while (queue_.top().first != area_[static_cast<std::size_t>(queue_.top().second)])
            queue_.pop();
        const int face = queue_.top().second;
        queue_.pop();
        return face;
    }

private:
    const PatchMesh& mesh_;
    std::vector<double> area_;
    double total_ = 0;
    std::priority_queue<std::pair<double, int>> queue_;
};

} // namespace

void make_delaunay(PatchMesh& mesh) {
    std::vector<int> stack;
    for (int corner = 3 * mesh.face_count() - 1; corner >= 0; --corner)
        if (mesh.twin(corner) > corner)
            stack.push_back(corner);
    legalise(mesh, stack, [](int) {});
}

void refine(PatchMesh& mesh, double face_area, const Projection& project, Random& random) {
    make_delaunay(mesh);
    LargestFaces largest(mesh);
    std::vector<int> stack;
    while (largest.total() > face_area * (mesh.face_count() + 1)) {
        const int face = largest.take();
        const int patch = mesh.face_patch[static_cast<std::size_t>(face)];
        mesh.insert(face, project(patch, random_inner_point(mesh, face, random)));
        const int second = mesh.face_count() - 2;
        for (int f : {face, second, second + 1}) {
            largest.update(f);
            stack.push_back(3 * f);
        }
        legalise(mesh, stack, [&](int f) { largest.update(f); });
    }
}

void relax(PatchMesh& mesh, int rounds, const Projection& project) {
    for (int round = 0; round < rounds; ++round) {
        for (int v = 0; v < mesh.vertex_count(); ++v)
            if (mesh.vertex_patch[static_cast<std::size_t>(v)] != PatchMesh::fixed)
                relax_vertex(mesh, v, project);
        make_delaunay(mesh);
    }
}

} // namespace plisse
