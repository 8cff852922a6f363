#include <plisse/mesh/patch_mesh.h>

#include <algorithm>
#include <cassert>
#include <tuple>

#include <plisse/mesh/portable_math.h>

namespace plisse {

int PatchMesh::add_vertex(const Vec3& point, int patch) {
    points.push_back(point);
    vertex_patch.push_back(patch);
    return vertex_count() - 1;
}

void PatchMesh::add_face(const Face& face, int patch) {
    faces.push_back(face);
    face_patch.push_back(patch);
}

void PatchMesh::zip(std::span<const int> lower, std::span<const int> upper, int patch) {
    const auto squared = [&](int a, int b) {
        const Vec3 d = point(a) - point(b);
        return dot(d, d);
    };
    std::size_t i = 0;
    std::size_t j = 0;
    while (i + 1 < lower.size() || j + 1 < upper.size()) {
        const bool lower_advances =
            j + 1 == upper.size() ||
            (i + 1 < lower.size() && squared(lower[i + 1], upper[j]) <= squared(lower[i], upper[j + 1]));
        if (lower_advances) {
            add_face({lower[i], lower[i + 1], upper[j]}, patch);
            ++i;
        } else {
            add_face({lower[i], upper[j + 1], upper[j]}, patch);
            ++j;
        }
    }
}

void PatchMesh::connect() {
    struct Half {
        int low, high, corner;
    };
    std::vector<Half> halves;
    vertex_corner_.assign(points.size(), -1);
    twins_.assign(3 * faces.size(), -1);
    for (int corner = 0; corner < 3 * face_count(); ++corner) {
        const int a = vertex(corner);
        const int b = vertex(next(corner));
        halves.push_back({std::min(a, b), std::max(a, b), corner});
        vertex_corner_[static_cast<std::size_t>(a)] = corner;
    }
    std::sort(halves.begin(), halves.end(), [](const Half& p, const Half& q) {
        return std::tie(p.low, p.high, p.corner) < std::tie(q.low, q.high, q.corner);
    });
    for (std::size_t k = 1; k < halves.size(); ++k)
        if (halves[k].low == halves[k - 1].low && halves[k].high == halves[k - 1].high) {
            assert(twin(halves[k - 1].corner) < 0 && vertex(halves[k].corner) != vertex(halves[k - 1].corner));
            link(halves[k - 1].corner, halves[k].corner);
        }
}

void PatchMesh::link(int corner, int twin) {
    twins_[static_cast<std::size_t>(corner)] = twin;
    if (twin >= 0)
        twins_[static_cast<std::size_t>(twin)] = corner;
}

void PatchMesh::place(int face, const Face& vertices) {
    faces[static_cast<std::size_t>(face)] = vertices;
    for (int k = 0; k < 3; ++k)
        vertex_corner_[static_cast<std::size_t>(vertices[static_cast<std::size_t>(k)])] = 3 * face + k;
}

bool PatchMesh::joined(int a, int b) const {
    const int first = vertex_corner_[static_cast<std::size_t>(a)];
    int corner = first;
    do { // one way round
        if (vertex(next(corner)) == b || vertex(previous(corner)) == b)
            return true;
        corner = twin(previous(corner));
    } while (corner >= 0 && corner != first);
    if (corner == first)
        return false;
    for (corner = twin(first); corner >= 0; corner = twin(corner)) { // and from the start the other way, to the border
        corner = next(corner);
        if (vertex(next(corner)) == b)
            return true;
    }
    return false;
}

bool PatchMesh::can_flip(int corner) const {
    const int other = twin(corner);
    return other >= 0 && face_patch[face_of(corner)] == face_patch[face_of(other)] &&
           !joined(vertex(previous(corner)), vertex(previous(other)));
}

void PatchMesh::flip(int corner) {
    const int other = twin(corner);
    const int f = corner / 3;
    const int g = other / 3;
    const int a = vertex(corner);
    const int b = vertex(other);
    const int p = vertex(previous(corner));
    const int q = vertex(previous(other));
    const int beyond_bp = twin(next(corner));
    const int beyond_pa = twin(previous(corner));
    const int beyond_aq = twin(next(other));
    const int beyond_qb = twin(previous(other));
    place(f, {a, q, p});
    place(g, {b, p, q});
    link(3 * f, beyond_aq);
    link(3 * f + 1, 3 * g + 1);
    link(3 * f + 2, beyond_pa);
    link(3 * g, beyond_bp);
    link(3 * g + 2, beyond_qb);
}

int PatchMesh::insert(int face, const Vec3& new_point) {
    const auto [a, b, c] = faces[static_cast<std::size_t>(face)];
    const int patch = face_patch[static_cast<std::size_t>(face)];
    const int beyond_bc = twin(3 * face + 1);
    const int beyond_ca = twin(3 * face + 2);
    const int v = add_vertex(new_point, patch);
    const int second = face_count();
    const int third = second + 1;
    vertex_corner_.push_back(-1);
    twins_.resize(twins_.size() + 6, -1);
    add_face({b, c, v}, patch);
    add_face({c, a, v}, patch);
    place(face, {a, b, v});
    place(second, {b, c, v});
    place(third, {c, a, v});
    link(3 * second, beyond_bc);
    link(3 * third, beyond_ca);
    link(3 * face + 1, 3 * second + 2);
    link(3 * second + 1, 3 * third + 2);
    link(3 * third + 1, 3 * face + 2);
    return v;
}

} // namespace plisse
