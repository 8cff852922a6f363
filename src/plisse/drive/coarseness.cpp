#include <plisse/drive/coarseness.h>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <plisse/energy/dihedral_terms.h>
#include <plisse/energy/hinge.h>
#include <plisse/mesh/connectivity.h>

namespace plisse {

namespace {

VecX coarseness(const Positions& rest, const Positions& positions, const Connectivity& mesh,
                std::span<const Face> faces) {
    VecX squares = VecX::Zero(rest.cols()), counts = VecX::Zero(rest.cols());
    for (const std::array<int, 4>& hinge : interior_hinges(mesh, faces).vertices) {
        const double turn =
            std::remainder(dihedral_angle_at(hinge, positions) - dihedral_angle_at(hinge, rest), 2 * std::numbers::pi);
        for (int v : hinge) {
            squares[v] += turn * turn;
            counts[v] += 1;
        }
    }
    return (squares.array() / counts.array().max(1)).sqrt() / most_turn;
}

/// Mean length of the edges at a vertex.
double edge_length_at(int vertex, const Positions& rest, const Connectivity& mesh, std::span<const Face> faces) {
    double sum = 0;
    int count = 0;
    for (int f : mesh.vertex_faces(vertex))
        for (int v : faces[static_cast<std::size_t>(f)])
            if (v != vertex) {
                sum += (rest.col(v) - rest.col(vertex)).norm();
                ++count;
            }
    return count > 0 ? sum / count : 0;
}

} // namespace

VecX coarseness(const Positions& rest, const Positions& positions, std::span<const Face> faces) {
    return coarseness(rest, positions, Connectivity(static_cast<int>(rest.cols()), faces), faces);
}

TooCoarse find_too_coarse(const Positions& rest, const Positions& positions, std::span<const Face> faces) {
    const Connectivity mesh(static_cast<int>(rest.cols()), faces);
    const VecX values = coarseness(rest, positions, mesh, faces);
    TooCoarse found;
    double area = 0, coarse_area = 0;
    for (const Face& face : faces)
        for (int v : face) {
            const double third =
                Vec3(rest.col(face[1]) - rest.col(face[0])).cross(Vec3(rest.col(face[2]) - rest.col(face[0]))).norm() /
                6;
            area += third;
            if (values[v] > 1)
                coarse_area += third;
        }
    found.share = area > 0 ? coarse_area / area : 0;
    Eigen::Index worst = 0;
    if (values.size() == 0 || !((found.worst = values.maxCoeff(&worst)) > 0))
        return found;
    found.turn = most_turn * found.worst;
    found.edge = edge_length_at(static_cast<int>(worst), rest, mesh, faces);
    found.place = positions.col(worst);
    return found;
}

} // namespace plisse
