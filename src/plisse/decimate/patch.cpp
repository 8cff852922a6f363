#include <plisse/decimate/patch.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace plisse {

FaceShape face_shape(const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 a = q - p, b = r - p;
    const Vec3 normal = a.cross(b);
    const double twice_area = normal.norm();
    if (!(twice_area > 0))
        return {};
    const double edges_squared = a.squaredNorm() + b.squaredNorm() + (r - q).squaredNorm();
    return {normal / twice_area, 2 * std::sqrt(3.0) * twice_area / edges_squared};
}

namespace {

bool holds(const Face& face, int vertex) {
    return face[0] == vertex || face[1] == vertex || face[2] == vertex;
}

} // namespace

int Patch::place(int sheet, int vertex) const {
    const auto first = places.begin() + place_starts[static_cast<std::size_t>(sheet)];
    const auto last = places.begin() + place_starts[static_cast<std::size_t>(sheet) + 1];
    return static_cast<int>(std::lower_bound(first, last, vertex) - places.begin());
}

bool Patch::doubles_a_face() const {
    for (std::size_t n = 0; n < faces_of_i.size(); ++n)
        for (std::size_t m = faces_of_i.size(); m < after.size(); ++m)
            if (holds(after[n], after[m][0]) && holds(after[n], after[m][1]) && holds(after[n], after[m][2]))
                return true;
    return false;
}

void Patch::collect(const DynamicFaces& faces, int center, std::vector<Neighbour>& neighbours) {
    neighbours.clear();
    for (int f : faces.vertex_faces(center))
        for (int v : faces.face(f)) {
            if (v == center)
                continue;
            const auto known = std::find_if(neighbours.begin(), neighbours.end(),
                                            [v](const Neighbour& neighbour) { return neighbour.vertex == v; });
            if (known == neighbours.end())
                neighbours.push_back({v, 1});
            else
                ++known->faces;
        }
}

int Patch::curve_neighbour(const std::vector<Neighbour>& neighbours, int other_than) {
    int lowest = -1;
    for (const Neighbour& neighbour : neighbours)
        if (neighbour.faces != 2 && neighbour.vertex != other_than && (lowest < 0 || neighbour.vertex < lowest))
            lowest = neighbour.vertex;
    return lowest;
}

bool Patch::curves_meet() const {
    return std::any_of(around_i_.begin(), around_i_.end(), [&](const Neighbour& of_i) {
        return of_i.faces != 2 && std::any_of(around_j_.begin(), around_j_.end(), [&](const Neighbour& of_j) {
                   return of_j.vertex == of_i.vertex && of_j.faces != 2;
               });
    });
}

/// Faces that share a plain edge at i or j are of one sheet.
void Patch::find_sheets() {
    const auto branches = [](const std::vector<Neighbour>& around) {
        return std::any_of(around.begin(), around.end(), [](const Neighbour& n) { return n.faces > 2; });
    };
    sheet_count = 1;
    if (!branches(around_i_) && !branches(around_j_)) {
        sheets.assign(before_.size(), 0);
        return;
    }
    sheets.resize(before_.size());
    std::iota(sheets.begin(), sheets.end(), 0); // a sheet goes by one of its faces until all are known
    join_within_sheets(i, around_i_);
    join_within_sheets(j, around_j_);
    std::vector<int> with_dead;
    for (std::size_t d = 0; d < dead_faces.size(); ++d)
        if (std::find(with_dead.begin(), with_dead.end(), sheets[d]) == with_dead.end())
            with_dead.push_back(sheets[d]);
    for (int& sheet : sheets) {
        const auto found = std::find(with_dead.begin(), with_dead.end(), sheet);
        sheet = found == with_dead.end() ? at_rest : static_cast<int>(found - with_dead.begin());
    }
    sheet_count = static_cast<int>(with_dead.size());
}

void Patch::join_within_sheets(int center, const std::vector<Neighbour>& neighbours) {
    for (const Neighbour& neighbour : neighbours) {
        if (neighbour.faces != 2)
            continue;
        int first = -1;
        for (std::size_t n = 0; n < before_.size(); ++n) {
            if (!holds(before_[n], center) || !holds(before_[n], neighbour.vertex))
                continue;
            const int sheet = sheets[n];
            if (first >= 0)
                std::replace(sheets.begin(), sheets.end(), sheet, first);
            else
                first = sheet;
        }
    }
}

void Patch::list_places() {
    places.clear();
    place_starts.assign(1, 0);
    for (int sheet = 0; sheet < sheet_count; ++sheet) {
        const auto first = static_cast<std::ptrdiff_t>(places.size());
        for (std::size_t n = 0; n < before_.size(); ++n)
            for (int v : before_[n])
                if (sheets[n] == sheet && v != i && v != j)
                    places.push_back(v);
        std::sort(places.begin() + first, places.end());
        places.erase(std::unique(places.begin() + first, places.end()), places.end());
        place_starts.push_back(static_cast<int>(places.size()));
    }
}

void Patch::gather(const DynamicFaces& faces, int edge_i, int edge_j, int merged_k) {
    i = edge_i;
    j = edge_j;
    k = merged_k;
    dead_faces.clear();
    faces_of_i.clear();
    faces_of_j.clear();
    after.clear();
    const auto add_after = [&](int f, int from, std::vector<int>& list) {
        list.push_back(f);
        Face& corners = after.emplace_back(faces.face(f));
        *std::find(corners.begin(), corners.end(), from) = k;
    };
    for (int f : faces.vertex_faces(i)) {
        if (holds(faces.face(f), j))
            dead_faces.push_back(f);
        else
            add_after(f, i, faces_of_i);
    }
    for (int f : faces.vertex_faces(j))
        if (!holds(faces.face(f), i))
            add_after(f, j, faces_of_j);

    collect(faces, i, around_i_);
    collect(faces, j, around_j_);
    ring.clear();
    for (const auto* around : {&around_i_, &around_j_})
        for (const Neighbour& neighbour : *around)
            if (neighbour.vertex != i && neighbour.vertex != j)
                ring.push_back(neighbour.vertex);
    std::sort(ring.begin(), ring.end());
    const auto distinct = std::unique(ring.begin(), ring.end());
    common_neighbours = static_cast<int>(ring.end() - distinct);
    ring.erase(distinct, ring.end());
    beyond_i = is_curve_edge() ? curve_neighbour(around_i_, j) : -1;
    beyond_j = is_curve_edge() ? curve_neighbour(around_j_, i) : -1;
    meets_itself = is_curve_edge() && curves_meet();
    before_.clear();
    for (const auto* list : {&dead_faces, &faces_of_i, &faces_of_j})
        for (int f : *list)
            before_.push_back(faces.face(f));
    find_sheets();
    list_places();
}

} // namespace plisse
