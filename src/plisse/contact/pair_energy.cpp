#include <plisse/contact/pair_energy.h>

#include <plisse/geometry/barrier.h>
#include <plisse/geometry/mollifier.h>

namespace plisse {

namespace {

/// The barrier as a function of D: value and derivatives times the pair's scale.
Barrier scaled_barrier(const PairParameters& p, double squared_distance) {
    const double range = p.activation_squared - p.least_squared;
    const Barrier b = barrier((squared_distance - p.least_squared) / range);
    return {p.scale * b.value, p.scale * b.first / range, p.scale * b.second / (range * range)};
}

/// d2E/dd2 of the distance d, for E a function of D = d^2.
double curvature_in_distance(const Barrier& b, double squared_distance) {
    return std::max(0.0, 4 * b.second * squared_distance + 2 * b.first);
}

/// m b as a function of squared distances, the first of which is b's.
DistanceFunction product(double m, DistanceFunction by_distances, const Barrier& b) {
    const decltype(DistanceFunction::first) slopes = by_distances.first;
    by_distances.first *= b.value;
    by_distances.second *= b.value;
    by_distances.first[0] += m * b.first;
    by_distances.second.row(0) += b.first * slopes.transpose();
    by_distances.second.col(0) += b.first * slopes;
    by_distances.second(0, 0) += m * b.second;
    return by_distances;
}

/// Calls use(function, separations) with the energy as a function of squared distances.
template <typename Use>
auto use_energy(const PairParameters& parameters, const Separation& separation, const Stencil& x, const Use& use) {
    const Barrier b = scaled_barrier(parameters, separation.squared_distance);
    if (parameters.ends == 0)
        return use(product(1, DistanceFunction(1), b), std::span(&separation, 1));
    const EdgeMollifier mollifier(separation, x, parameters.ends);
    return use(product(mollifier.value(), mollifier.function(), b), mollifier.separations());
}

double mollifier_value(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    return parameters.ends != 0 ? EdgeMollifier(separation, x, parameters.ends).value() : 1;
}

} // namespace

double pair_energy(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    return mollifier_value(parameters, separation, x) * scaled_barrier(parameters, separation.squared_distance).value;
}

double pair_normal_force(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    const Vec12 gradient = pair_gradient(parameters, separation, x);
    Vec3 on_first = gradient.head<3>();
    if (parameters.ends != 0)
        on_first += gradient.segment<3>(3);
    return -on_first.dot(separation.offset.normalized());
}

Vec12 pair_gradient(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    return use_energy(parameters, separation, x, gradient);
}

Mat12 pair_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    return use_energy(parameters, separation, x, hessian);
}

Mat12 pair_projected_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    return use_energy(parameters, separation, x, projected_hessian);
}

Mat12 pair_gauss_newton_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    const double m = mollifier_value(parameters, separation, x);
    const Barrier b = scaled_barrier(parameters, separation.squared_distance);
    Vec12 direction;
    Eigen::Map<Stencil>(direction.data()) = separation.offset.normalized() * separation.weights.transpose();
    return m * curvature_in_distance(b, separation.squared_distance) * direction * direction.transpose();
}

} // namespace plisse
