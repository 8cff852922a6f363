#include <plisse/scene/motion_track.h>

namespace plisse {

namespace {

Track<Vec3> field_track(const MotionSpec& spec, std::optional<Vec3> MotionKeySpec::*field, const Vec3& at_first) {
    Track<Vec3> track;
    Vec3 value = at_first;
    for (const MotionKeySpec& key : spec) {
        value = (key.*field).value_or(value);
        track.keys.push_back({key.t, value});
    }
    return track;
}

} // namespace

MotionTrack motion_track(const MotionSpec& spec) {
    if (spec.empty())
        return {};
    Vec3 pivot = Vec3::Zero();
    for (std::size_t k = spec.size(); k-- > 0;)
        pivot = spec[k].about.value_or(pivot);
    return {field_track(spec, &MotionKeySpec::translate, Vec3::Zero()),
            field_track(spec, &MotionKeySpec::rotate_deg, Vec3::Zero()),
            field_track(spec, &MotionKeySpec::about, pivot)};
}

} // namespace plisse
