#include <plisse/picture/occlusion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

using Vec3f = Eigen::Vector3f;

constexpr int tap_count = 11;
constexpr int pattern = 4; ///< the taps turn with the pixel, in tiles of this size, which the blur evens out
constexpr float strength = 2.4f;
constexpr float least_openness = 0.3f; ///< black creases would look like ink

class Obscurance {
public:
    Obscurance(const SurfaceBuffer& buffer, const Camera& camera, double radius)
        : buffer_(buffer), scale_(static_cast<float>(2 * camera.half_height / buffer.height)),
          right_(camera.right.cast<float>()), up_(camera.up.cast<float>()), forward_(camera.forward.cast<float>()),
          radius_(static_cast<float>(radius)) {
        for (std::size_t turn = 0; turn < offsets_.size(); ++turn)
            for (std::size_t tap = 0; tap < tap_count; ++tap) {
                const float share = (static_cast<float>(tap) + 0.5f) / tap_count;
                const float angle = 2 * std::numbers::pi_v<float> *
                                    (7 * share + static_cast<float>(turn) / static_cast<float>(offsets_.size()));
                offsets_[turn][tap] = share * Eigen::Vector2f{std::cos(angle), std::sin(angle)};
            }
    }

    float openness(int x, int y) const {
        const std::size_t pixel = buffer_.index(x, y);
        const float depth = buffer_.depth[pixel];
        if (!std::isfinite(depth))
            return 1;
        const Vec3f place = place_at(x, y, depth);
        const Vec3f& normal = buffer_.normals[pixel];
        const float reach = std::min(radius_ / (scale_ * depth), 0.1f * static_cast<float>(buffer_.height));
        const auto& offsets =
            offsets_[static_cast<std::size_t>((x % pattern) * 5 + (y % pattern) * 7) % offsets_.size()];
        const float bias = 0.02f * radius_;
        float sum = 0;
        for (const Eigen::Vector2f& offset : offsets) {
            const int tap_x = x + static_cast<int>(std::lround(reach * offset.x()));
            const int tap_y = y + static_cast<int>(std::lround(reach * offset.y()));
            if (tap_x < 0 || tap_y < 0 || tap_x >= buffer_.width || tap_y >= buffer_.height)
                continue;
            const float tap_depth = buffer_.depth[buffer_.index(tap_x, tap_y)];
            if (!std::isfinite(tap_depth))
                continue;
            const Vec3f toward = place_at(tap_x, tap_y, tap_depth) - place;
            const float squared = toward.squaredNorm();
            const float falloff = std::max(0.0f, 1 - squared / (radius_ * radius_));
            sum += falloff * falloff * std::max(0.0f, toward.dot(normal) - bias) / (squared + 0.05f * bias * radius_);
        }
        return std::max(least_openness, 1 - strength * radius_ * sum / tap_count);
    }

private:
    Vec3f place_at(int x, int y, float depth) const {
        const float across = scale_ * (static_cast<float>(x) + 0.5f - 0.5f * static_cast<float>(buffer_.width));
        const float down = scale_ * (static_cast<float>(y) + 0.5f - 0.5f * static_cast<float>(buffer_.height));
        return depth * (forward_ + across * right_ - down * up_);
    }

    const SurfaceBuffer& buffer_;
    float scale_;
    Vec3f right_, up_, forward_;
    float radius_;
    std::array<std::array<Eigen::Vector2f, tap_count>, pattern * pattern> offsets_;
};

/// Mean over a tile of the pattern's size around the pixel, of pixels about as far away.
float smoothed(const SurfaceBuffer& buffer, const std::vector<float>& values, int x, int y, float tolerance) {
    const float depth = buffer.depth[buffer.index(x, y)];
    if (!std::isfinite(depth))
        return 1;
    float sum = 0;
    float count = 0;
    for (int j = std::max(y - pattern / 2, 0); j < std::min(y + pattern / 2, buffer.height); ++j)
        for (int i = std::max(x - pattern / 2, 0); i < std::min(x + pattern / 2, buffer.width); ++i) {
            const std::size_t pixel = buffer.index(i, j);
            if (std::abs(buffer.depth[pixel] - depth) < tolerance) {
                sum += values[pixel];
                count += 1;
            }
        }
    return count > 0 ? sum / count : values[buffer.index(x, y)];
}

} // namespace

std::vector<float> ambient_openness(const SurfaceBuffer& buffer, const Camera& camera, double radius) {
    const Obscurance obscurance(buffer, camera, radius);
    std::vector<float> raw(buffer.depth.size());
    parallel_for(buffer.height, 8, [&](int y) {
        for (int x = 0; x < buffer.width; ++x)
            raw[buffer.index(x, y)] = obscurance.openness(x, y);
    });
    std::vector<float> openness(buffer.depth.size());
    const auto tolerance = static_cast<float>(0.5 * radius);
    parallel_for(buffer.height, 8, [&](int y) {
        for (int x = 0; x < buffer.width; ++x)
            openness[buffer.index(x, y)] = smoothed(buffer, raw, x, y, tolerance);
    });
    return openness;
}

} // namespace plisse
