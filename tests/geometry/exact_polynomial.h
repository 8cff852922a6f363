#pragma once

#include <optional>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

namespace plisse {

/// Whole numbers of any size; the first 512 bits need no memory from the heap.
using Integer =
    boost::multiprecision::number<boost::multiprecision::cpp_int_backend<512>, boost::multiprecision::et_off>;

/// numerator / 2^exponent, exponent >= 0.
struct Dyadic {
    Integer numerator;
    int exponent = 0;
};

/// Any finite number in [0, 1], without rounding.
Dyadic dyadic(double value);

/// A polynomial c[0] + c[1] t + ... without rounding. The last coefficient is never zero: zero has no coefficients.
class Polynomial {
public:
    Polynomial() = default;
    explicit Polynomial(std::vector<Integer> coefficients);

    bool is_zero() const { return coefficients_.empty(); }
    int degree() const { return static_cast<int>(coefficients_.size()) - 1; } ///< -1 for zero
    const std::vector<Integer>& coefficients() const { return coefficients_; }

    Polynomial operator+(const Polynomial& other) const;
    Polynomial operator-(const Polynomial& other) const;
    Polynomial operator*(const Polynomial& other) const;

    /// Sign of the value at t.
    int sign_at(const Dyadic& t) const;

private:
    std::vector<Integer> coefficients_;
};

/// A real root of a polynomial in [0, 1]: either known exactly, or the only one within an open interval
/// (k / 2^l, (k + 1) / 2^l).
class Root {
public:
    /// The exact root k / 2^l.
    Root(const Integer& k, int l) : k_(k), l_(l) {}
    /// The only root of f, and a simple one, within the interval.
    Root(const Polynomial& f, const Integer& k, int l) : f_(f), k_(k), l_(l) {}

    /// Sign of g at the root.
    int sign_of(const Polynomial& g);
    /// Sign of root - t, t in [0, 1].
    int compare(double t);
    /// The root to within 2^-60.
    double approximation();

private:
    bool is_exact() const { return f_.is_zero(); }
    std::optional<int> sign_by_interval(const Polynomial& g) const;
    void halve();

    Polynomial f_;
    Integer k_;
    int l_;
};

/// All different roots of f, not zero, in [0, 1].
std::vector<Root> roots_in_unit_interval(const Polynomial& f);

} // namespace plisse
