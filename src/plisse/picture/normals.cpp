#include <plisse/picture/normals.h>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <plisse/base/parallel.h>
#include <plisse/mesh/connectivity.h>

namespace plisse {

namespace {

struct FaceNormal {
    Eigen::Vector3f unit = Eigen::Vector3f::Zero();
    float area = 0;
};

FaceNormal face_normal(const ConstPositions& positions, const Face& face) {
    const Vec3 a = positions.col(face[0]);
    const Vec3 normal = (positions.col(face[1]) - a).cross(positions.col(face[2]) - a);
    const double length = normal.norm();
    if (!(length > 0) || !std::isfinite(length))
        return {};
    return {(normal / length).cast<float>(), static_cast<float>(0.5 * length)};
}

} // namespace

std::vector<CornerNormals> corner_normals(const ConstPositions& positions, std::span<const Face> faces,
                                          double crease_deg) {
    const Connectivity mesh(static_cast<int>(positions.cols()), faces);
    const auto least_cosine = static_cast<float>(std::cos(crease_deg * std::numbers::pi / 180));
    std::vector<FaceNormal> flat(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
        flat[f] = face_normal(positions, faces[f]);
    std::vector<CornerNormals> normals(faces.size());
    parallel_for(mesh.face_count(), 512, [&](int face) {
        const auto f = static_cast<std::size_t>(face);
        for (std::size_t k = 0; k < 3; ++k) {
            Eigen::Vector3f sum = Eigen::Vector3f::Zero();
            for (int neighbour : mesh.vertex_faces(faces[f][k])) {
                const FaceNormal& other = flat[static_cast<std::size_t>(neighbour)];
                if (other.unit.dot(flat[f].unit) >= least_cosine)
                    sum += other.area * other.unit;
            }
            const float length = sum.norm();
            normals[f][k] = length > 0 ? Eigen::Vector3f(sum / length) : flat[f].unit;
        }
    });
    return normals;
}

} // namespace plisse
