#pragma once

#include <span>
#include <utility>
#include <vector>

#include <Eigen/SparseCore>

#include <plisse/energy/assembly.h>
#include <plisse/subdivide/surface_basis.h>

namespace plisse {

/// Points of a surface, each a weighted sum of control points, with weights of their own in an integral.
struct SurfaceSamples {
    std::vector<Eigen::Triplet<double>> values; ///< (sample, control point, weight)
    std::vector<double> weights;                ///< share of the integral, m or m^2; 1 for points by themselves

    int count() const { return static_cast<int>(weights.size()); }
    /// One more sample.
    void append(std::span<const int> control_points, const VecX& value, double weight);
};

/// Sample points of the whole surface, weighted by rest area. rest: control points.
SurfaceSamples surface_samples(const SurfaceBasis& basis, const Positions& rest);

/// Sample points of one boundary edge, weighted by rest length. value, tangent: k x points, as in FaceStencil; weights
/// of the points sum to 1.
void append_edge(std::span<const int> control_points, const Eigen::MatrixXd& value, const Eigen::MatrixXd& tangent,
                 std::span<const double> weights, const Positions& rest, SurfaceSamples& samples);

/// sum_p w_p N_pi N_pj over samples: the consistent mass matrix of a surface of density 1; control points squared.
Eigen::SparseMatrix<double> consistent_matrix(const SurfaceSamples& samples, int vertex_count);

/// An energy with a constant Hessian `factor` K, the same in x, y and z, K sparse.
class QuadraticEnergy : public AssembledEnergy {
public:
    void place_in(const NewtonSystem& system) override;
    /// The exact one, which is positive semi-definite.
    void add_hessian(const Positions& x, NewtonSystem& system, bool project) const override;
    std::vector<Edge> pairs() const override;

protected:
    /// K symmetric positive semi-definite.
    explicit QuadraticEnergy(Eigen::SparseMatrix<double> hessian) : hessian_(std::move(hessian)) {}
    const Eigen::SparseMatrix<double>& hessian() const { return hessian_; }
    void set_factor(double factor) { factor_ = factor; }
    double factor() const { return factor_; }

private:
    struct Block {
        int row, column, number;
        double value;
    };
    Eigen::SparseMatrix<double> hessian_;
    double factor_ = 1;
    std::vector<Block> blocks_;
};

/// Inertia of an implicit Euler step, 1/(2 dt^2) |x - x^|_M^2 with the consistent mass M, evaluated by x - x^.
class SurfaceInertia : public QuadraticEnergy {
public:
    /// mass: kg. Until they are set, dt is 1 s and x^ is `start`.
    SurfaceInertia(Eigen::SparseMatrix<double> mass, Positions start)
        : QuadraticEnergy(std::move(mass)), target_(std::move(start)) {}

    void set_time_step(double seconds) { set_factor(1 / (seconds * seconds)); }
    /// x^ = x_n + dt v_n.
    void set_target(Positions target) { target_ = std::move(target); }

    double value(const Positions& x) const override;
    void add_gradient(const Positions& x, Positions& gradient) const override;

private:
    Positions target_;
};

/// beta/2 sum_p w_p |x_p - b_p|^2 over samples p: the integral over boundary edges that hold a sheet (RMTR equation
/// 3.6; a line integral, without thickness), or points held one by one.
class PointPenalty : public QuadraticEnergy {
public:
    /// beta: N/m per unit of the samples' weights. rest: control points; the targets are where it has the samples.
    PointPenalty(const SurfaceSamples& samples, double beta, const Positions& rest);

    /// b, one column a sample.
    void set_targets(Positions targets) { targets_ = std::move(targets); }
    const Positions& targets() const { return targets_; }
    /// Where the samples are.
    Positions points(const Positions& x) const { return x * values_; }

    double value(const Positions& x) const override;
    void add_gradient(const Positions& x, Positions& gradient) const override;

private:
    Eigen::SparseMatrix<double> values_; ///< control points x samples
    VecX weights_;
    Positions targets_;
};

/// Dead loads, -f . x: one force a control point, N. Of gravity f is M g summed over rows, see surface_weight.
class DeadLoads : public AssembledEnergy {
public:
    explicit DeadLoads(Positions forces) : forces_(std::move(forces)) {}

    double value(const Positions& x) const override;
    void add_gradient(const Positions&, Positions& gradient) const override { gradient -= forces_; }
    void place_in(const NewtonSystem&) override {}
    void add_hessian(const Positions&, NewtonSystem&, bool) const override {}
    std::vector<Edge> pairs() const override { return {}; }

private:
    Positions forces_;
};

/// Forces of gravity (m/s^2) on the control points of a surface of this mass matrix.
Positions surface_weight(const Eigen::SparseMatrix<double>& mass, const Vec3& gravity);

} // namespace plisse
