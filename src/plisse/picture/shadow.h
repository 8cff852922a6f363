#pragma once

#include <span>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// What a distant light sees of a mesh: a picture of distances along its direction (Williams 1978).
class ShadowMap {
public:
    /// to_light: unit. region: points around which shadows are wanted; nothing outside their bounds casts or gets one.
    ShadowMap(const ConstPositions& positions, std::span<const Face> faces, const Vec3& to_light,
              const ConstPositions& region);

    /// Share of the light that reaches a surface point, in [0, 1], with a soft rim. normal: unit, on the lit side.
    float light_at(const Vec3& point, const Vec3& normal) const;

private:
    static constexpr int size_ = 1024;

    Mat3 to_map_; ///< world to texels and, third, metres towards the light
    Vec3 origin_ = Vec3::Zero();
    double texel_ = 1; ///< m
    std::vector<float> nearness_;
};

} // namespace plisse
