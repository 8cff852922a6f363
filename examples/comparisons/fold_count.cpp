#include "fold_count.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include <plisse/geometry/dihedral.h>
#include <plisse/mesh/connectivity.h>

namespace plisse::comparisons {

namespace {

constexpr double least_turn = 20 * std::numbers::pi / 180;

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Edges that the plane crosses and the faces between them.
class Cut {
public:
    Cut(const Positions& rest, std::span<const Face> faces, const Plane& plane)
        : rest_(rest), faces_(faces), edges_(static_cast<int>(rest.cols()), faces), heights_(rest.cols()),
          visited_(faces.size(), false) {
        for (int v = 0; v < rest.cols(); ++v)
            heights_[v] = plane.normal.dot(rest.col(v) - plane.point);
    }

    /// How far the surface has turned after each edge, curve by curve, beyond what it does at rest.
    std::vector<std::vector<double>> turns(const Positions& x) {
        std::vector<std::vector<double>> curves;
        for (const bool from_boundary : {true, false})
            for (int e = 0; e < edges_.edge_count(); ++e)
                if (crosses(e) && (!from_boundary || edges_.is_curve_edge(e)) && !visited_[at(face_of(e, 0))])
                    curves.push_back(walk(e, face_of(e, 0), x));
        return curves;
    }

private:
    int face_of(int edge, std::size_t side) const { return edges_.edge_faces(edge)[side]; }
    bool crosses(int edge) const {
        const auto [a, b] = edges_.edges()[at(edge)];
        return (heights_[a] > 0) != (heights_[b] > 0);
    }

    /// From an edge through a face, and on until the sheet ends or a face was seen before.
    std::vector<double> walk(int edge, int face, const Positions& x) {
        std::vector<double> turned;
        double total = 0;
        while (face >= 0 && !visited_[at(face)]) {
            visited_[at(face)] = true;
            for (const int next : edges_.face_edges()[at(face)])
                if (next != edge && crosses(next)) {
                    edge = next;
                    break;
                }
            if (edges_.is_curve_edge(edge))
                break;
            total += turn(edge, x) - turn(edge, rest_);
            turned.push_back(total);
            face = face_of(edge, face_of(edge, 0) == face ? 1 : 0);
        }
        return turned;
    }

    /// The hinge's angle as the walk across it feels it: none where it goes along the edge.
    double turn(int edge, const Positions& x) const {
        const auto [a, b] = edges_.edges()[at(edge)];
        const std::span<const int> corners = edges_.opposite(edge);
        const Face& first = faces_[at(face_of(edge, 0))];
        const bool forward =
            (first[0] == a && first[1] == b) || (first[1] == a && first[2] == b) || (first[2] == a && first[0] == b);
        const int from = forward ? a : b, to = forward ? b : a;
        const double across =
            std::abs(heights_[a] - heights_[b]) / (rest_.col(a) - rest_.col(b)).norm(); // sine of edge and plane
        return across * dihedral_angle(x.col(from), x.col(to), x.col(corners[0]), x.col(corners[1]));
    }

    const Positions& rest_;
    std::span<const Face> faces_;
    Connectivity edges_;
    VecX heights_;
    std::vector<bool> visited_;
};

/// Turning points of a sequence, where small ones do not count.
int turning_points(const std::vector<double>& values) {
    int count = 0, direction = 0;
    double extreme = 0;
    for (const double value : values) {
        if (direction == 0 && std::abs(value - extreme) > least_turn) {
            direction = value > extreme ? 1 : -1;
            extreme = value;
        } else if (direction * (value - extreme) > 0) {
            extreme = value;
        } else if (direction * (extreme - value) > least_turn) {
            ++count;
            direction = -direction;
            extreme = value;
        }
    }
    return count;
}

} // namespace

int count_folds(const Positions& rest, std::span<const Face> faces, const Plane& plane, const Positions& x) {
    int points = 0;
    for (const std::vector<double>& curve : Cut(rest, faces, plane).turns(x))
        points += turning_points(curve);
    return (points + 1) / 2;
}

} // namespace plisse::comparisons
