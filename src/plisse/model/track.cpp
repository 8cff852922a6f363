#include <plisse/model/track.h>

#include <Eigen/Geometry>

#include <numbers>

namespace plisse {

Mat3 rotation_xyz(const Vec3& degrees) {
    const Vec3 angles = degrees * (std::numbers::pi / 180.0);
    return (Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) *
            Eigen::AngleAxisd(angles.x(), Vec3::UnitX()))
        .toRotationMatrix();
}

Vec3 MotionTrack::apply(const Vec3& point, double t) const {
    const Vec3 pivot = about.at(t);
    return rotation_xyz(rotate_deg.at(t)) * (point - pivot) + pivot + translate.at(t);
}

Vec3 MotionTrack::undo(const Vec3& point, double t) const {
    const Vec3 pivot = about.at(t);
    return rotation_xyz(rotate_deg.at(t)).transpose() * (point - pivot - translate.at(t)) + pivot;
}

} // namespace plisse
