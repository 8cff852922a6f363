#include <plisse/drive/preview_distance.h>

#include <Eigen/LU>
#include <Eigen/SVD>

#include <plisse/decimate/level_prolongation.h>

namespace plisse {

namespace {

/// The rotation R with the largest trace(R' m) (Kabsch 1976).
Mat3 nearest_rotation(const Mat3& m) {
    const Eigen::JacobiSVD<Mat3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Mat3 u = svd.matrixU();
    if (u.determinant() * svd.matrixV().determinant() < 0)
        u.col(2) *= -1;
    return u * svd.matrixV().transpose();
}

} // namespace

PreviewDistance preview_distance(const Discretization& discretization, int level, const Positions& preview,
                                 const Positions& finest) {
    const Model& model = discretization.model();
    const Positions prolonged =
        prolongation_to_finest(discretization.hierarchy(), level, model.hierarchy.prolongation).apply(preview);
    std::vector<int> of_bodies;
    for (int v = 0; v < finest.cols(); ++v)
        if (!model.is_obstacle(discretization.mesh(discretization.finest()).part[static_cast<std::size_t>(v)]))
            of_bodies.push_back(v);
    const Positions from = prolonged(Eigen::all, of_bodies), to = finest(Eigen::all, of_bodies);
    const Vec3 from_center = from.rowwise().mean(), to_center = to.rowwise().mean();
    const Positions away = nearest_rotation((to.colwise() - to_center) * (from.colwise() - from_center).transpose()) *
                               (from.colwise() - from_center) -
                           (to.colwise() - to_center);
    const VecX distances = away.colwise().norm().transpose();
    return {distances.mean(), distances.maxCoeff()};
}

} // namespace plisse
