#pragma once

#include <algorithm>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// A value over time: linear between keys, held before the first and after the last.
template <typename Value>
struct Track {
    struct Key {
        double t; ///< s
        Value value;
    };
    std::vector<Key> keys; ///< ascending in t, at least one

    Track() = default;
    explicit Track(const Value& constant) : keys{{0.0, constant}} {}

    Value at(double t) const {
        if (t <= keys.front().t)
            return keys.front().value;
        for (std::size_t k = 1; k < keys.size(); ++k)
            if (t < keys[k].t) {
                const double share = (t - keys[k - 1].t) / (keys[k].t - keys[k - 1].t);
                return keys[k - 1].value + share * (keys[k].value - keys[k - 1].value);
            }
        return keys.back().value;
    }
    bool is_constant() const {
        return std::all_of(keys.begin(), keys.end(), [&](const Key& key) { return key.value == keys.front().value; });
    }
};

/// Whether the value is 0 at all times.
inline bool is_zero(const Track<double>& track) {
    return track.is_constant() && track.keys.front().value == 0;
}

/// Scripted rigid motion: a point p of the start goes to rotate(p - about) + about + translate, the rotation being
/// about x, then y, then z by the scripted angles.
struct MotionTrack {
    Track<Vec3> translate{Vec3::Zero()}; ///< m
    Track<Vec3> rotate_deg{Vec3::Zero()};
    Track<Vec3> about{Vec3::Zero()}; ///< m, world coordinates

    Vec3 apply(const Vec3& point, double t) const;
    /// The inverse of apply at the same time.
    Vec3 undo(const Vec3& point, double t) const;
};

/// Rotation by angles in degrees about x, then y, then z (fixed axes).
Mat3 rotation_xyz(const Vec3& degrees);

} // namespace plisse
