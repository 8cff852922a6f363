#include <plisse/exports/vertex_normals.h>

#include <Eigen/Geometry>

namespace plisse {

Eigen::Matrix3Xf vertex_normals(const ConstPositions& positions, std::span<const Face> faces) {
    Positions sums = Positions::Zero(3, positions.cols());
    for (const Face& face : faces) {
        const Vec3 a = positions.col(face[0]), b = positions.col(face[1]), c = positions.col(face[2]);
        const Vec3 twice_area = (b - a).cross(c - a);
        for (int corner : face)
            sums.col(corner) += twice_area;
    }
    for (Eigen::Index v = 0; v < sums.cols(); ++v) {
        const double length = sums.col(v).norm();
        sums.col(v) = length > 0 ? Vec3(sums.col(v) / length) : Vec3::UnitY();
    }
    return sums.cast<float>();
}

} // namespace plisse
