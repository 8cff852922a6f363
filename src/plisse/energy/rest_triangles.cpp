#include <plisse/energy/rest_triangles.h>

#include <algorithm>
#include <utility>

#include <plisse/base/parallel.h>
#include <plisse/energy/stretch_modes.h>
#include <plisse/geometry/triangle_frame.h>

namespace plisse {

RestTriangles::RestTriangles(const Positions& rest, std::vector<Face> faces) : faces_(std::move(faces)) {
    inverses_.reserve(faces_.size());
    areas_.reserve(faces_.size());
    for (const Face& face : faces_) {
        const TriangleFrame frame = triangle_frame(rest.col(face[0]), rest.col(face[1]), rest.col(face[2]));
        inverses_.push_back(frame.inverse);
        areas_.push_back(frame.area);
    }
}

Mat32 RestTriangles::deformation_gradient(int f, const Positions& x) const {
    const Face& v = face(f);
    return plisse::deformation_gradient(inverse(f), x.col(v[0]), x.col(v[1]), x.col(v[2]));
}

Vec2 RestTriangles::principal_stretches(int f, const Positions& x) const {
    return plisse::principal_stretches(deformation_gradient(f, x));
}

double RestTriangles::largest_stretch(const Positions& x) const {
    constexpr int chunk_size = 1024;
    std::vector<double> largest(static_cast<std::size_t>(chunk_count(count(), chunk_size)), 0.0);
    parallel_chunks(count(), chunk_size, [&](int chunk, int begin, int end) {
        double& most = largest[static_cast<std::size_t>(chunk)];
        for (int f = begin; f < end; ++f)
            most = std::max(most, principal_stretches(f, x)[0]);
    });
    return largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end());
}

void RestTriangles::pull_back_gradient(int f, const Mat32& derivative, double* gradient) const {
    Eigen::Map<Mat3> corners(gradient);
    corners.rightCols<2>() = derivative * inverse(f).transpose();
    corners.col(0) = -corners.col(1) - corners.col(2);
}

} // namespace plisse
