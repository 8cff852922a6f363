#include <plisse/energy/hinge.h>

#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include <plisse/energy/dihedral_terms.h>

namespace plisse {

namespace {

/// Does the face run along its edge from a to b?
bool runs_along(const Face& face, int a, int b) {
    return (face[0] == a && face[1] == b) || (face[1] == a && face[2] == b) || (face[2] == a && face[0] == b);
}

double area_at_rest(const Face& face, const Positions& rest) {
    return (rest.col(face[1]) - rest.col(face[0])).cross(rest.col(face[2]) - rest.col(face[0])).norm() / 2;
}

} // namespace

Hinges interior_hinges(const Connectivity& connectivity, std::span<const Face> faces) {
    Hinges hinges;
    for (int e = 0; e < connectivity.edge_count(); ++e) {
        const auto sides = connectivity.edge_faces(e), corners = connectivity.opposite(e);
        for (std::size_t p = 0; p < sides.size(); ++p) {
            auto [a, b] = connectivity.edges()[static_cast<std::size_t>(e)];
            if (!runs_along(faces[static_cast<std::size_t>(sides[p])], a, b))
                std::swap(a, b);
            for (std::size_t q = p + 1; q < sides.size(); ++q) {
                hinges.vertices.push_back({a, b, corners[p], corners[q]});
                hinges.faces.push_back({sides[p], sides[q]});
                hinges.edges.push_back(e);
            }
        }
    }
    return hinges;
}

std::vector<double> hinge_shares(const Hinges& hinges, const Connectivity& connectivity, std::span<const Face> faces,
                                 const Positions& rest) {
    const auto slack = [&](int face) { return 1 / area_at_rest(faces[static_cast<std::size_t>(face)], rest); };
    std::vector<double> shares;
    for (std::size_t h = 0; h < hinges.edges.size(); ++h) {
        const auto sides = connectivity.edge_faces(hinges.edges[h]);
        double sum = 0;
        for (int face : sides)
            sum += slack(face);
        const auto& [p, q] = hinges.faces[h];
        shares.push_back(sides.size() == 2 ? 1 : (slack(p) + slack(q)) / sum);
    }
    return shares;
}

double bending_rigidity(double youngs_modulus, double poisson_ratio, double thickness) {
    return youngs_modulus * thickness * thickness * thickness / (12 * (1 - poisson_ratio * poisson_ratio));
}

HingeEnergy::HingeEnergy(const Positions& rest, std::vector<std::array<int, 4>> hinges, const HingeMaterials& materials,
                         HingeHessian kind)
    : hinges_(std::move(hinges)), kind_(kind) {
    assert(materials.scaled_rigidity.size() == hinges_.size());
    assert(materials.flat.size() == hinges_.size());
    stiffness_.reserve(hinges_.size());
    rest_angles_.reserve(hinges_.size());
    for (std::size_t h = 0; h < hinges_.size(); ++h) {
        const Dihedral hinge = dihedral_at(hinges_[h], rest);
        const double areas = hinge.length * (hinge.height[0] + hinge.height[1]) / 2;
        assert(areas > 0);
        stiffness_.push_back(materials.scaled_rigidity[h] * hinge.length * hinge.length / areas);
        rest_angles_.push_back(materials.flat[h] ? 0.0 : hinge.angle);
    }
}

double HingeEnergy::angle(int hinge, const Positions& x) const {
    return dihedral_angle_at(hinges_[static_cast<std::size_t>(hinge)], x);
}

double HingeEnergy::value(int hinge, const Positions& x) const {
    const double turn = angle(hinge, x) - rest_angle(hinge);
    if (std::isnan(turn))
        return std::numeric_limits<double>::infinity();
    return stiffness_[static_cast<std::size_t>(hinge)] / 2 * turn * turn;
}

void HingeEnergy::gradient(int hinge, const Positions& x, double* gradient) const {
    const auto h = static_cast<std::size_t>(hinge);
    const Dihedral state = dihedral_at(hinges_[h], x);
    const double moment = stiffness_[h] * (state.angle - rest_angles_[h]);
    Eigen::Map<Vec12>{gradient} = moment * dihedral_gradient(state);
}

void HingeEnergy::hessian(int hinge, const Positions& x, bool project, double* hessian) const {
    const auto h = static_cast<std::size_t>(hinge);
    const Dihedral state = dihedral_at(hinges_[h], x);
    const double moment = stiffness_[h] * (state.angle - rest_angles_[h]);
    Eigen::Map<Mat12> result(hessian);
    if (project && kind_ == HingeHessian::projected) {
        result = projected_hessian(state, stiffness_[h], moment);
        return;
    }
    const Vec12 slope = dihedral_gradient(state);
    result.noalias() = (stiffness_[h] * slope) * slope.transpose();
    if (!project)
        result += moment * dihedral_hessian(state);
}

} // namespace plisse
