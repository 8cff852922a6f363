#include <plisse/decimate/dynamic_faces.h>

#include <algorithm>
#include <cassert>

namespace plisse {

namespace {

constexpr Face absent{-1, -1, -1};

void insert_sorted(std::vector<int>& list, int value) {
    list.insert(std::lower_bound(list.begin(), list.end(), value), value);
}

void erase_sorted(std::vector<int>& list, int value) {
    list.erase(std::lower_bound(list.begin(), list.end(), value));
}

} // namespace

DynamicFaces::DynamicFaces(std::span<const Face> faces, int vertex_id_count)
    : faces_(faces.size(), absent), vertex_faces_(vertex_id_count) {
    for (std::size_t f = 0; f < faces.size(); ++f)
        add_face(static_cast<int>(f), faces[f]);
}

DynamicFaces::DynamicFaces(const Hierarchy& hierarchy, int level)
    : faces_(hierarchy.finest().faces.size(), absent),
      vertex_faces_(hierarchy.finest().vertex_ids.size() + hierarchy.collapses.size()) {
    const HierarchyLevel& start = hierarchy.levels[level];
    for (std::size_t f = 0; f < start.faces.size(); ++f) {
        const Face& face = start.faces[f];
        add_face(start.face_ids[f], {start.vertex_ids[face[0]], start.vertex_ids[face[1]], start.vertex_ids[face[2]]});
    }
}

void DynamicFaces::ring(int vertex, std::vector<int>& ring) const {
    ring.clear();
    for (int f : vertex_faces_[vertex])
        for (int v : faces_[f])
            if (v != vertex)
                ring.push_back(v);
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
}

int DynamicFaces::edge_face_count(int a, int b) const {
    return static_cast<int>(std::count_if(vertex_faces_[a].begin(), vertex_faces_[a].end(), [&](int f) {
        return std::find(faces_[f].begin(), faces_[f].end(), b) != faces_[f].end();
    }));
}

void DynamicFaces::add_face(int face, const Face& corners) {
    faces_[face] = corners;
    for (int v : corners)
        insert_sorted(vertex_faces_[v], face);
}

void DynamicFaces::remove_face(int face) {
    for (int v : faces_[face])
        erase_sorted(vertex_faces_[v], face);
    faces_[face] = absent;
}

void DynamicFaces::replace_corner(std::span<const int> faces, int from, int to) {
    for (int f : faces) {
        *std::find(faces_[f].begin(), faces_[f].end(), from) = to;
        erase_sorted(vertex_faces_[from], f);
        insert_sorted(vertex_faces_[to], f);
    }
}

void DynamicFaces::collapse(const Collapse& collapse) {
    assert(!has_vertex(collapse.k));
    for (int f : collapse.dead_faces)
        remove_face(f);
    replace_corner(collapse.faces_of_i, collapse.i, collapse.k);
    replace_corner(collapse.faces_of_j, collapse.j, collapse.k);
    assert(!has_vertex(collapse.i) && !has_vertex(collapse.j));
}

void DynamicFaces::expand(const Collapse& collapse) {
    assert(is_legal(collapse) && !has_vertex(collapse.i) && !has_vertex(collapse.j));
    replace_corner(collapse.faces_of_i, collapse.k, collapse.i);
    replace_corner(collapse.faces_of_j, collapse.k, collapse.j);
    for (std::size_t d = 0; d < collapse.dead_faces.size(); ++d)
        add_face(collapse.dead_faces[d], collapse.dead_corners[d]);
    assert(!has_vertex(collapse.k));
}

bool DynamicFaces::is_legal(const Collapse& collapse) const {
    return has_vertex(collapse.k) &&
           std::all_of(collapse.ring.begin(), collapse.ring.end(), [&](int v) { return has_vertex(v); });
}

} // namespace plisse
