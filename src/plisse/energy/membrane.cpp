#include <plisse/energy/membrane.h>

#include <cassert>
#include <utility>

namespace plisse {

MembraneEnergy::MembraneEnergy(const Positions& rest, std::vector<Face> faces, MembraneMaterials materials)
    : triangles_(rest, std::move(faces)), materials_(std::move(materials)) {
    assert(materials_.mu.size() == triangles_.areas().size());
    assert(materials_.lambda.size() == triangles_.areas().size());
    assert(materials_.thickness.size() == triangles_.areas().size());
}

Lame MembraneEnergy::lame(int face) const {
    const auto f = static_cast<std::size_t>(face);
    return {materials_.mu[f], materials_.lambda[f]};
}

double MembraneEnergy::volume(int face) const {
    return triangles_.area(face) * materials_.thickness[static_cast<std::size_t>(face)];
}

double MembraneEnergy::value(int face, const Positions& x) const {
    return volume(face) * neo_hookean_value(triangles_.deformation_gradient(face, x), lame(face));
}

void MembraneEnergy::gradient(int face, const Positions& x, double* gradient) const {
    const Mat32 stress = volume(face) * neo_hookean_stress(triangles_.deformation_gradient(face, x), lame(face));
    triangles_.pull_back_gradient(face, stress, gradient);
}

void MembraneEnergy::hessian(int face, const Positions& x, bool project, double* hessian) const {
    const StretchModes modes = neo_hookean_modes(triangles_.deformation_gradient(face, x), lame(face), project);
    Eigen::Map<Mat9>{hessian} = pull_back(modes, triangles_.inverse(face), volume(face));
}

} // namespace plisse
