#include <plisse/subdivide/loop_step.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <plisse/mesh/connectivity.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// What a vertex of valence n takes of each neighbour.
double neighbour_weight(int n) {
    const double c = 3.0 / 8 + std::cos(2 * std::numbers::pi / n) / 4;
    return (5.0 / 8 - c * c) / n;
}

/// Fine vertices are numbered first all coarse ones, then all edges; the order of parts comes last.
class Divider {
public:
    Divider(const LabelledSurface& coarse, const std::vector<std::uint8_t>& kept_part,
            const LabelBetween& label_between)
        : coarse_(coarse), kept_part_(kept_part), vertex_count_(static_cast<int>(coarse.part.size())),
          connectivity_(vertex_count_, coarse.faces), smooth_edge_(at(connectivity_.edge_count()), 0),
          edge_vertex_(smooth_edge_.size(), -1), part_(coarse.part), label_(coarse.label) {
        for (int e = 0; e < connectivity_.edge_count(); ++e)
            if (!is_kept(connectivity_.edges()[at(e)][0]))
                add_edge_vertex(e, label_between);
    }

    LoopStep run() {
        divide_faces();
        add_vertex_rows();
        add_edge_rows();
        return in_order_of_parts();
    }

private:
    static Mat3 columns(const Vec3& first, const Vec3& second, const Vec3& third) {
        Mat3 m;
        m << first, second, third;
        return m;
    }

    bool is_kept(int vertex) const { return !kept_part_.empty() && kept_part_[at(coarse_.part[at(vertex)])] != 0; }

    void add_edge_vertex(int e, const LabelBetween& label_between) {
        const Edge& edge = connectivity_.edges()[at(e)];
        const int a = coarse_.label[at(edge[0])], b = coarse_.label[at(edge[1])];
        const int label = a < 0 || b < 0 ? -1 : label_between(a, b);
        smooth_edge_[at(e)] = label < 0 && !connectivity_.is_curve_edge(e);
        edge_vertex_[at(e)] = static_cast<int>(part_.size());
        part_.push_back(coarse_.part[at(edge[0])]);
        label_.push_back(label);
    }

    void divide_faces() {
        for (int f = 0; f < connectivity_.face_count(); ++f) {
            const auto& [a, b, c] = coarse_.faces[at(f)];
            if (is_kept(a)) {
                add_face(f, coarse_.faces[at(f)], Mat3::Identity());
                continue;
            }
            const auto& edges = connectivity_.face_edges()[at(f)];
            const int ab = edge_vertex_[at(edges[0])], bc = edge_vertex_[at(edges[1])], ca = edge_vertex_[at(edges[2])];
            const Vec3 at_a = Vec3::UnitX(), at_b = Vec3::UnitY(), at_c = Vec3::UnitZ();
            const Vec3 at_ab(0.5, 0.5, 0), at_bc(0, 0.5, 0.5), at_ca(0.5, 0, 0.5);
            add_face(f, {a, ab, ca}, columns(at_a, at_ab, at_ca));
            add_face(f, {b, bc, ab}, columns(at_b, at_bc, at_ab));
            add_face(f, {c, ca, bc}, columns(at_c, at_ca, at_bc));
            add_face(f, {ab, bc, ca}, columns(at_ab, at_bc, at_ca));
        }
    }

    void add_face(int parent, const Face& face, const Mat3& corners) {
        step_.fine.faces.push_back(face);
        step_.parent.push_back(parent);
        step_.corners.push_back(corners);
    }

    void add_vertex_rows() {
        std::vector<std::vector<int>> neighbours(at(vertex_count_));
        std::vector<bool> smooth(at(vertex_count_));
        for (int v = 0; v < vertex_count_; ++v)
            smooth[at(v)] = coarse_.label[at(v)] < 0 && !connectivity_.vertex_faces(v).empty();
        for (int e = 0; e < connectivity_.edge_count(); ++e)
            for (const int end : {0, 1}) {
                const Edge& edge = connectivity_.edges()[at(e)];
                const int v = edge[at(end)];
                neighbours[at(v)].push_back(edge[at(1 - end)]);
                // An edge between pinned vertices does not matter here: its ends stay anyway.
                smooth[at(v)] = smooth[at(v)] && smooth_edge_[at(e)] != 0;
            }
        for (int v = 0; v < vertex_count_; ++v) {
            if (!smooth[at(v)]) {
                entries_.emplace_back(v, v, 1.0);
                continue;
            }
            const int n = static_cast<int>(neighbours[at(v)].size());
            const double weight = neighbour_weight(n);
            entries_.emplace_back(v, v, 1 - n * weight);
            for (int neighbour : neighbours[at(v)])
                entries_.emplace_back(v, neighbour, weight);
        }
    }

    void add_edge_rows() {
        for (int e = 0; e < connectivity_.edge_count(); ++e) {
            const int row = edge_vertex_[at(e)];
            if (row < 0)
                continue;
            const bool smooth = smooth_edge_[at(e)] != 0;
            for (int end : connectivity_.edges()[at(e)])
                entries_.emplace_back(row, end, smooth ? 3.0 / 8 : 1.0 / 2);
            if (smooth)
                for (int corner : connectivity_.opposite(e))
                    entries_.emplace_back(row, corner, 1.0 / 8);
        }
    }

    LoopStep in_order_of_parts() {
        std::vector<int> order(part_.size()), number(part_.size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return part_[at(a)] < part_[at(b)]; });
        for (std::size_t n = 0; n < order.size(); ++n) {
            number[at(order[n])] = static_cast<int>(n);
            step_.fine.part.push_back(part_[at(order[n])]);
            step_.fine.label.push_back(label_[at(order[n])]);
        }
        for (Face& face : step_.fine.faces)
            for (int& v : face)
                v = number[at(v)];
        for (auto& entry : entries_)
            entry = {number[at(entry.row())], entry.col(), entry.value()};
        step_.fine_number.assign(number.begin(), number.begin() + vertex_count_);
        step_.weights.resize(static_cast<Eigen::Index>(part_.size()), vertex_count_);
        step_.weights.setFromTriplets(entries_.begin(), entries_.end());
        return std::move(step_);
    }

    const LabelledSurface& coarse_;
    const std::vector<std::uint8_t>& kept_part_;
    int vertex_count_;
    Connectivity connectivity_;
    std::vector<std::uint8_t> smooth_edge_;
    std::vector<int> edge_vertex_; ///< per edge, -1 in kept parts
    std::vector<int> part_, label_;
    std::vector<Eigen::Triplet<double>> entries_;
    LoopStep step_;
};

} // namespace

LoopStep loop_step(const LabelledSurface& coarse, const std::vector<std::uint8_t>& kept_part,
                   const LabelBetween& label_between) {
    return Divider(coarse, kept_part, label_between).run();
}

} // namespace plisse
