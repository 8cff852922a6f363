#include <plisse/energy/shell_section.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <plisse/energy/positive_part.h>

namespace plisse {

namespace {

Mat3 positive_tangent(const Mat3& tangent) {
    Mat3 positive = Mat3::Zero();
    positive.topLeftCorner<2, 2>() = positive_part(tangent.topLeftCorner<2, 2>());
    positive(2, 2) = std::max(tangent(2, 2), 0.0);
    return positive;
}

} // namespace

ShellSection::ShellSection(OrthotropicMaterial material, double thickness, int points)
    : material_(std::move(material)), thickness_(thickness) {
    assert(points == 3 || points == 5);
    const auto add_pair = [&](double abscissa, double weight) {
        points_.push_back({-abscissa * thickness / 2, weight * thickness / 2});
        points_.push_back({abscissa * thickness / 2, weight * thickness / 2});
    };
    if (points == 3) {
        points_.push_back({0, 4.0 / 9 * thickness});
        add_pair(std::sqrt(0.6), 5.0 / 9);
    } else {
        points_.push_back({0, 64.0 / 225 * thickness});
        const double spread = 2 * std::sqrt(10.0 / 7), root = 13 * std::sqrt(70.0);
        add_pair(std::sqrt(5 - spread) / 3, (322 + root) / 900);
        add_pair(std::sqrt(5 + spread) / 3, (322 - root) / 900);
    }
}

double ShellSection::energy(const Vec3& strain, const Vec3& curvature) const {
    double sum = 0;
    for (const auto& [height, weight] : points_)
        sum += weight * material_.energy(strain + height * curvature);
    return sum;
}

ShellSection::Forces ShellSection::forces(const Vec3& strain, const Vec3& curvature) const {
    Forces sum{Vec3::Zero(), Vec3::Zero()};
    for (const auto& [height, weight] : points_) {
        const Vec3 force = weight * material_.stress(strain + height * curvature);
        sum.membrane += force;
        sum.bending += height * force;
    }
    return sum;
}

ShellSection::Tangent ShellSection::tangent(const Vec3& strain, const Vec3& curvature, bool project) const {
    Tangent sum{{Vec3::Zero(), Vec3::Zero()}, Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};
    for (const auto& [height, weight] : points_) {
        const StressTangent at = material_.stress_and_tangent(strain + height * curvature);
        sum.forces.membrane += weight * at.stress;
        sum.forces.bending += weight * height * at.stress;
        const Mat3 tangent = weight * (project ? positive_tangent(at.tangent) : at.tangent);
        sum.membrane += tangent;
        sum.coupling += height * tangent;
        sum.bending += height * height * tangent;
    }
    return sum;
}

} // namespace plisse
