#pragma once

#include <plisse/base/random.h>
#include <plisse/geometry/distance.h>

namespace plisse {

inline Stencil stencil(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    Stencil x;
    x << a, b, c, d;
    return x;
}

inline Vec3 random_vector(Random& random, double size = 1) {
    const double x = random.uniform(-size, size), y = random.uniform(-size, size), z = random.uniform(-size, size);
    return {x, y, z};
}

inline Stencil random_stencil(Random& random, double size = 1) {
    Stencil x;
    for (int i = 0; i < 4; ++i)
        x.col(i) = random_vector(random, size);
    return x;
}

/// Central differences of a scalar, one coordinate of the stencil at a time.
template <typename Function>
Vec12 difference_gradient(const Function& f, const Stencil& x, double step) {
    Vec12 gradient;
    for (int i = 0; i < 12; ++i) {
        Stencil low = x, high = x;
        low(i) -= step;
        high(i) += step;
        gradient[i] = (f(high) - f(low)) / (high(i) - low(i));
    }
    return gradient;
}

/// Central differences of a gradient.
template <typename Function>
Mat12 difference_hessian(const Function& gradient, const Stencil& x, double step) {
    Mat12 hessian;
    for (int i = 0; i < 12; ++i) {
        Stencil low = x, high = x;
        low(i) -= step;
        high(i) += step;
        hessian.col(i) = (gradient(high) - gradient(low)) / (high(i) - low(i));
    }
    return hessian;
}

} // namespace plisse
