#include "geometry/exact_polynomial.h"

#include <bit>
#include <cassert>
#include <cmath>

namespace plisse {

namespace {

using Coefficients = std::vector<Integer>;

int sign(const Integer& value) {
    return value.sign();
}

/// p(t + shift), by Horner's scheme.
void shift_argument(Coefficients& p, const Integer& shift) {
    for (std::size_t i = 0; i + 1 < p.size(); ++i)
        for (std::size_t j = p.size() - 1; j-- > i;)
            p[j] += shift * p[j + 1];
}

/// A positive multiple of f((k + s) / 2^l) as a polynomial in s.
Coefficients on_interval(const Polynomial& f, const Integer& k, int l) {
    Coefficients result = f.coefficients();
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] <<= l * (f.degree() - static_cast<int>(i));
    shift_argument(result, k);
    return result;
}

/// Sign changes of (1 + y)^n f(1 / (1 + y)). By Descartes' rule f has that many roots in (0, 1), or fewer by an even
/// number, each counted as often as it is repeated.
int sign_changes(Coefficients f) {
    std::reverse(f.begin(), f.end());
    shift_argument(f, 1);
    int changes = 0, last = 0;
    for (const Integer& c : f) {
        if (sign(c) == 0)
            continue;
        changes += last != 0 && sign(c) != last;
        last = sign(c);
    }
    return changes;
}

int sign_changes(const Polynomial& f, const Integer& k, int l) {
    return sign_changes(on_interval(f, k, l));
}

/// Divides by the greatest common divisor of the coefficients, so that numbers stay small.
Polynomial primitive(const Polynomial& f) {
    if (f.is_zero())
        return f;
    Integer divisor = 0;
    for (const Integer& c : f.coefficients())
        divisor = gcd(divisor, c);
    Coefficients result = f.coefficients();
    for (Integer& c : result)
        c /= divisor;
    return Polynomial(result);
}

struct Division {
    Polynomial quotient, remainder;
};

/// m f = quotient * g + remainder for some whole m != 0, the remainder's degree below that of g.
Division divide(const Polynomial& f, const Polynomial& g) {
    Polynomial quotient, remainder = f;
    const Integer& lead = g.coefficients().back();
    while (remainder.degree() >= g.degree()) {
        Coefficients term(static_cast<std::size_t>(remainder.degree() - g.degree()) + 1);
        term.back() = remainder.coefficients().back();
        const Polynomial factor({lead}), monomial(std::move(term));
        quotient = quotient * factor + monomial;
        remainder = remainder * factor - monomial * g;
    }
    return {quotient, remainder};
}

Polynomial common_divisor(Polynomial f, Polynomial g) {
    while (!g.is_zero()) {
        Polynomial remainder = primitive(divide(f, g).remainder);
        f = std::exchange(g, std::move(remainder));
    }
    return f;
}

Polynomial derivative(const Polynomial& f) {
    Coefficients result;
    for (int i = 1; i <= f.degree(); ++i)
        result.push_back(i * f.coefficients()[static_cast<std::size_t>(i)]);
    return Polynomial(std::move(result));
}

/// Appends the roots of f, none of them repeated, in the open interval (k / 2^l, (k + 1) / 2^l).
void isolate(const Polynomial& f, const Integer& k, int l, std::vector<Root>& roots) {
    const int changes = sign_changes(f, k, l);
    if (changes == 0)
        return;
    if (changes == 1) {
        roots.emplace_back(f, k, l);
        return;
    }
    isolate(f, 2 * k, l + 1, roots);
    if (f.sign_at({2 * k + 1, l + 1}) == 0)
        roots.emplace_back(2 * k + 1, l + 1);
    isolate(f, 2 * k + 1, l + 1, roots);
}

} // namespace

Dyadic dyadic(double value) {
    assert(value >= 0 && value <= 1);
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    auto numerator = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
    if (numerator == 0)
        return {0, 0};
    const int zeros = std::min(53 - exponent, std::countr_zero(static_cast<std::uint64_t>(numerator)));
    return {numerator >> zeros, 53 - exponent - zeros};
}

Polynomial::Polynomial(std::vector<Integer> coefficients) : coefficients_(std::move(coefficients)) {
    while (!coefficients_.empty() && sign(coefficients_.back()) == 0)
        coefficients_.pop_back();
}

Polynomial Polynomial::operator+(const Polynomial& other) const {
    Coefficients result = coefficients_;
    result.resize(std::max(result.size(), other.coefficients_.size()));
    for (std::size_t i = 0; i < other.coefficients_.size(); ++i)
        result[i] += other.coefficients_[i];
    return Polynomial(std::move(result));
}

Polynomial Polynomial::operator-(const Polynomial& other) const {
    Coefficients result = coefficients_;
    result.resize(std::max(result.size(), other.coefficients_.size()));
    for (std::size_t i = 0; i < other.coefficients_.size(); ++i)
        result[i] -= other.coefficients_[i];
    return Polynomial(std::move(result));
}

Polynomial Polynomial::operator*(const Polynomial& other) const {
    if (is_zero() || other.is_zero())
        return {};
    Coefficients result(coefficients_.size() + other.coefficients_.size() - 1);
    for (std::size_t i = 0; i < coefficients_.size(); ++i)
        for (std::size_t j = 0; j < other.coefficients_.size(); ++j)
            result[i + j] += coefficients_[i] * other.coefficients_[j];
    return Polynomial(std::move(result));
}

int Polynomial::sign_at(const Dyadic& t) const {
    Integer value = 0;
    for (int i = degree(); i >= 0; --i)
        value = value * t.numerator + (coefficients_[static_cast<std::size_t>(i)] << t.exponent * (degree() - i));
    return sign(value);
}

void Root::halve() {
    k_ *= 2;
    ++l_;
    if (f_.sign_at({k_ + 1, l_}) == 0) {
        ++k_;
        f_ = {};
    } else if (sign_changes(f_, k_, l_) % 2 == 0) {
        ++k_;
    }
}

std::optional<int> Root::sign_by_interval(const Polynomial& g) const {
    if (g.is_zero())
        return 0;
    if (is_exact())
        return g.sign_at({k_, l_});
    if (sign_changes(g, k_, l_) == 0)
        return g.sign_at({2 * k_ + 1, l_ + 1});
    return std::nullopt;
}

int Root::sign_of(const Polynomial& g) {
    constexpr int cheap_trials = 8;
    for (int trial = 0;; ++trial) {
        if (const auto result = sign_by_interval(g))
            return *result;
        // A common divisor of f and g has at most the one simple root of f here, and then an odd number of changes.
        if (trial == cheap_trials && sign_changes(common_divisor(f_, g), k_, l_) % 2 == 1)
            return 0;
        halve();
    }
}

int Root::compare(double t) {
    const Dyadic other = dyadic(t);
    const auto sign_from = [&](const Integer& k) { // of k / 2^l - t
        return sign((k << other.exponent) - (other.numerator << l_));
    };
    while (!is_exact()) {
        if (sign_from(k_) >= 0)
            return 1;
        if (sign_from(k_ + 1) <= 0)
            return -1;
        if (f_.sign_at(other) == 0)
            return 0;
        halve();
    }
    return sign_from(k_);
}

double Root::approximation() {
    while (!is_exact() && l_ < 60)
        halve();
    return std::ldexp((2 * k_ + (is_exact() ? 0 : 1)).convert_to<double>(), -l_ - 1);
}

std::vector<Root> roots_in_unit_interval(const Polynomial& f) {
    assert(!f.is_zero());
    std::vector<Root> roots;
    for (const int end : {0, 1})
        if (f.sign_at({end, 0}) == 0)
            roots.emplace_back(end, 0);
    const int changes = sign_changes(f, 0, 0);
    if (changes == 1)
        isolate(f, 0, 0, roots);
    else if (changes > 1)
        isolate(divide(f, common_divisor(f, derivative(f))).quotient, 0, 0, roots);
    return roots;
}

} // namespace plisse
