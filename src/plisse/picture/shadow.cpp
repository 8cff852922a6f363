#include <plisse/picture/shadow.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <plisse/picture/rasterise.h>

namespace plisse {

namespace {

constexpr int filter_taps = 6; ///< across the soft rim of a shadow

/// Columns of the rotation's transpose: two directions across the light, and the one towards it.
Mat3 light_frame(const Vec3& to_light) {
    const Vec3 across = to_light.cross(std::abs(to_light.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitX()).normalized();
    Mat3 frame;
    frame << across.transpose(), to_light.cross(across).transpose(), to_light.transpose();
    return frame;
}

} // namespace

ShadowMap::ShadowMap(const ConstPositions& positions, std::span<const Face> faces, const Vec3& to_light,
                     const ConstPositions& region)
    : nearness_(static_cast<std::size_t>(size_) * size_, -std::numeric_limits<float>::infinity()) {
    const Mat3 frame = light_frame(to_light);
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    for (Eigen::Index i = 0; i < region.cols(); ++i) {
        const Vec3 place = frame * region.col(i);
        if (place.allFinite()) {
            low = low.cwiseMin(place);
            high = high.cwiseMax(place);
        }
    }
    const double extent = (high - low).head<2>().maxCoeff();
    if (!(extent > 0) || !std::isfinite(extent))
        low = Vec3::Zero();
    else
        texel_ = 1.02 * extent / size_;
    origin_ = Vec3{low.x() - 0.01 * size_ * texel_, low.y() - 0.01 * size_ * texel_, 0};
    to_map_ = frame;
    to_map_.topRows<2>() /= texel_;
    origin_.head<2>() /= texel_;

    const Positions seen = (to_map_ * positions).colwise() - origin_;
    std::vector<ScreenTriangle> triangles;
    triangles.reserve(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto& [a, b, c] = faces[f];
        if ((seen.col(a) + seen.col(b) + seen.col(c)).allFinite())
            triangles.push_back({{seen.col(a), seen.col(b), seen.col(c)}, static_cast<int>(f)});
    }
    rasterise(triangles, size_, size_, 1, [&](const SampleBand& band) {
        std::copy(band.nearness.begin(), band.nearness.end(),
                  nearness_.begin() + static_cast<std::ptrdiff_t>(band.first_row) * size_);
    });
}

float ShadowMap::light_at(const Vec3& point, const Vec3& normal) const {
    // Moved off the surface by a little more than the filter's reach covers on a slope, so that nothing shades itself.
    const Vec3 place = to_map_ * (point + 3 * texel_ * normal) - origin_;
    const auto nearness = static_cast<float>(place.z() + texel_);
    const double left = place.x() - 0.5 * filter_taps;
    const double top = place.y() - 0.5 * filter_taps;
    if (!(left >= 0 && top >= 0 && left + filter_taps + 1 < size_ && top + filter_taps + 1 < size_))
        return 1;
    const int x = static_cast<int>(left);
    const int y = static_cast<int>(top);
    const auto share_x = static_cast<float>(left - x);
    const auto share_y = static_cast<float>(top - y);
    float sum = 0;
    for (int j = 0; j <= filter_taps; ++j) {
        const float weight_y = j == 0 ? 1 - share_y : j == filter_taps ? share_y : 1;
        for (int i = 0; i <= filter_taps; ++i) {
            const float weight_x = i == 0 ? 1 - share_x : i == filter_taps ? share_x : 1;
            const auto texel = static_cast<std::size_t>(y + j) * size_ + static_cast<std::size_t>(x + i);
            if (nearness_[texel] <= nearness)
                sum += weight_x * weight_y;
        }
    }
    return sum / (filter_taps * filter_taps);
}

} // namespace plisse
