#include <plisse/energy/surface_integrals.h>

#include <cassert>

#include <Eigen/Geometry>

#include <plisse/energy/loads.h>

namespace plisse {

namespace {

Eigen::SparseMatrix<double> value_matrix(const SurfaceSamples& samples, int vertex_count) {
    Eigen::SparseMatrix<double> by_sample(samples.count(), vertex_count);
    by_sample.setFromTriplets(samples.values.begin(), samples.values.end());
    return by_sample.transpose();
}

VecX weights_of(const SurfaceSamples& samples) {
    return Eigen::Map<const VecX>(samples.weights.data(), samples.count());
}

} // namespace

void SurfaceSamples::append(std::span<const int> control_points, const VecX& value, double weight) {
    assert(static_cast<std::size_t>(value.size()) == control_points.size());
    for (std::size_t i = 0; i < control_points.size(); ++i)
        values.emplace_back(count(), control_points[i], value[static_cast<Eigen::Index>(i)]);
    weights.push_back(weight);
}

SurfaceSamples surface_samples(const SurfaceBasis& basis, const Positions& rest) {
    SurfaceSamples samples;
    for (int face = 0; face < basis.face_count(); ++face) {
        const std::span<const int> control = basis.control_points(face);
        const FaceStencil& stencil = basis.stencil(face);
        for (int p = 0; p < basis.point_count(); ++p) {
            Vec3 a1 = Vec3::Zero(), a2 = Vec3::Zero();
            for (std::size_t i = 0; i < control.size(); ++i) {
                a1 += stencil.du(static_cast<Eigen::Index>(i), p) * rest.col(control[i]);
                a2 += stencil.dv(static_cast<Eigen::Index>(i), p) * rest.col(control[i]);
            }
            samples.append(control, stencil.value.col(p), basis.weight(p) * a1.cross(a2).norm());
        }
    }
    return samples;
}

void append_edge(std::span<const int> control_points, const Eigen::MatrixXd& value, const Eigen::MatrixXd& tangent,
                 std::span<const double> weights, const Positions& rest, SurfaceSamples& samples) {
    for (std::size_t p = 0; p < weights.size(); ++p) {
        const auto column = static_cast<Eigen::Index>(p);
        Vec3 along = Vec3::Zero();
        for (std::size_t i = 0; i < control_points.size(); ++i)
            along += tangent(static_cast<Eigen::Index>(i), column) * rest.col(control_points[i]);
        samples.append(control_points, value.col(column), weights[p] * along.norm());
    }
}

Eigen::SparseMatrix<double> consistent_matrix(const SurfaceSamples& samples, int vertex_count) {
    const Eigen::SparseMatrix<double> values = value_matrix(samples, vertex_count);
    return values * weights_of(samples).asDiagonal() * Eigen::SparseMatrix<double>(values.transpose());
}

void QuadraticEnergy::place_in(const NewtonSystem& system) {
    blocks_.clear();
    for (int column = 0; column < hessian_.outerSize(); ++column)
        for (Eigen::SparseMatrix<double>::InnerIterator entry(hessian_, column); entry; ++entry)
            if (entry.row() >= column) {
                const auto row = static_cast<int>(entry.row());
                blocks_.push_back({row, column, system.base_block(row, column), entry.value()});
            }
}

void QuadraticEnergy::add_hessian(const Positions&, NewtonSystem& system, bool) const {
    assert((hessian_.nonZeros() == 0 || !blocks_.empty()) && "place_in comes first");
    for (const Block& block : blocks_)
        system.add_block_at(block.number, block.row, block.column, factor_ * block.value * Mat3::Identity());
}

std::vector<Edge> QuadraticEnergy::pairs() const {
    std::vector<Edge> pairs; // ascending, as the columns and their entries are
    for (int column = 0; column < hessian_.outerSize(); ++column)
        for (Eigen::SparseMatrix<double>::InnerIterator entry(hessian_, column); entry; ++entry)
            if (entry.row() > column)
                pairs.push_back({column, static_cast<int>(entry.row())});
    return pairs;
}

double SurfaceInertia::value(const Positions& x) const {
    const Positions moved = x - target_;
    return factor() / 2 * moved.cwiseProduct(moved * hessian()).sum();
}

void SurfaceInertia::add_gradient(const Positions& x, Positions& gradient) const {
    gradient += factor() * ((x - target_) * hessian());
}

PointPenalty::PointPenalty(const SurfaceSamples& samples, double beta, const Positions& rest)
    : QuadraticEnergy(consistent_matrix(samples, static_cast<int>(rest.cols()))),
      values_(value_matrix(samples, static_cast<int>(rest.cols()))), weights_(weights_of(samples)) {
    set_factor(beta);
    targets_ = points(rest);
}

double PointPenalty::value(const Positions& x) const {
    return factor() / 2 * (points(x) - targets_).colwise().squaredNorm().dot(weights_);
}

void PointPenalty::add_gradient(const Positions& x, Positions& gradient) const {
    const Positions forces = (points(x) - targets_) * (factor() * weights_).asDiagonal();
    gradient += forces * values_.transpose();
}

double DeadLoads::value(const Positions& x) const {
    return dead_load_energy(forces_, x);
}

Positions surface_weight(const Eigen::SparseMatrix<double>& mass, const Vec3& gravity) {
    return gravity * (mass * VecX::Ones(mass.cols())).transpose();
}

} // namespace plisse
