#include <plisse/energy/membrane.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include <plisse/base/parallel.h>
#include <plisse/geometry/triangle_frame.h>

namespace plisse {

MembraneEnergy::MembraneEnergy(const Positions& rest, std::vector<Face> faces, MembraneMaterials materials)
    : faces_(std::move(faces)), materials_(std::move(materials)) {
    assert(materials_.mu.size() == faces_.size());
    assert(materials_.lambda.size() == faces_.size());
    assert(materials_.thickness.size() == faces_.size());
    inverse_rest_edges_.reserve(faces_.size());
    areas_.reserve(faces_.size());
    for (const Face& face : faces_) {
        const TriangleFrame frame = triangle_frame(rest.col(face[0]), rest.col(face[1]), rest.col(face[2]));
        inverse_rest_edges_.push_back(frame.inverse);
        areas_.push_back(frame.area);
    }
}

Mat32 MembraneEnergy::deformation_gradient(int face, const Positions& x) const {
    const auto f = static_cast<std::size_t>(face);
    const Face& v = faces_[f];
    return plisse::deformation_gradient(inverse_rest_edges_[f], x.col(v[0]), x.col(v[1]), x.col(v[2]));
}

Lame MembraneEnergy::lame(int face) const {
    const auto f = static_cast<std::size_t>(face);
    return {materials_.mu[f], materials_.lambda[f]};
}

double MembraneEnergy::volume(int face) const {
    const auto f = static_cast<std::size_t>(face);
    return areas_[f] * materials_.thickness[f];
}

double MembraneEnergy::value(int face, const Positions& x) const {
    return volume(face) * neo_hookean_value(deformation_gradient(face, x), lame(face));
}

void MembraneEnergy::gradient(int face, const Positions& x, double* gradient) const {
    const Mat2& inverse = inverse_rest_edges_[static_cast<std::size_t>(face)];
    const Mat32 stress = volume(face) * neo_hookean_stress(deformation_gradient(face, x), lame(face));
    Eigen::Map<Mat3> corners(gradient);
    corners.rightCols<2>() = stress * inverse.transpose();
    corners.col(0) = -corners.col(1) - corners.col(2);
}

void MembraneEnergy::hessian(int face, const Positions& x, bool project, double* hessian) const {
    const NeoHookeanModes modes = neo_hookean_modes(deformation_gradient(face, x), lame(face), project);
    Eigen::Map<Mat9>{hessian} = pull_back(modes, inverse_rest_edges_[static_cast<std::size_t>(face)], volume(face));
}

Vec2 MembraneEnergy::principal_stretches(int face, const Positions& x) const {
    return plisse::principal_stretches(deformation_gradient(face, x));
}

double MembraneEnergy::largest_stretch(const Positions& x) const {
    constexpr int chunk_size = 1024;
    std::vector<double> largest(static_cast<std::size_t>(chunk_count(element_count(), chunk_size)), 0.0);
    parallel_chunks(element_count(), chunk_size, [&](int chunk, int begin, int end) {
        double& most = largest[static_cast<std::size_t>(chunk)];
        for (int face = begin; face < end; ++face)
            most = std::max(most, principal_stretches(face, x)[0]);
    });
    return largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end());
}

} // namespace plisse
