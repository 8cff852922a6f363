#include <plisse/energy/loads.h>

#include <cassert>

#include <Eigen/Geometry>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

/// Adds a third of area(face) * factor(face) to each corner of each face.
template <typename Factor>
VecX share_out_areas(const Positions& rest, std::span<const Face> faces, const Factor& factor) {
    VecX shares = VecX::Zero(rest.cols());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const Vec3 x0 = rest.col(faces[f][0]);
        const double twice_area = (rest.col(faces[f][1]) - x0).cross(rest.col(faces[f][2]) - x0).norm();
        for (int v : faces[f])
            shares[v] += factor(f) * twice_area / 6;
    }
    return shares;
}

} // namespace

VecX vertex_areas(const Positions& rest, std::span<const Face> faces) {
    return share_out_areas(rest, faces, [](std::size_t) { return 1.0; });
}

VecX lumped_masses(const Positions& rest, std::span<const Face> faces, std::span<const double> density,
                   std::span<const double> thickness) {
    assert(density.size() == faces.size() && thickness.size() == faces.size());
    return share_out_areas(rest, faces, [&](std::size_t face) { return density[face] * thickness[face]; });
}

void add_weight(const VecX& masses, const Vec3& gravity, Positions& forces) {
    forces.noalias() += gravity * masses.transpose();
}

void add_shared_force(const VecX& areas, std::span<const int> vertices, const Vec3& total, Positions& forces) {
    double whole = 0;
    for (int v : vertices)
        whole += areas[v];
    for (int v : vertices) {
        const double share = whole > 0 ? areas[v] / whole : 1.0 / static_cast<double>(vertices.size());
        forces.col(v) += share * total;
    }
}

void add_traction(const VecX& areas, std::span<const int> vertices, const Vec3& traction, Positions& forces) {
    for (int v : vertices)
        forces.col(v) += areas[v] * traction;
}

double dead_load_energy(const Positions& forces, const Positions& x) {
    return -parallel_sum(static_cast<int>(x.cols()), [&](int v) { return forces.col(v).dot(x.col(v)); });
}

} // namespace plisse
