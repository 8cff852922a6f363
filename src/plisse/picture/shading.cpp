#include <plisse/picture/shading.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace plisse {

namespace {

constexpr double crease_deg = 55;

float thirty_second_power(float value) {
    for (int i = 0; i < 5; ++i)
        value *= value;
    return value;
}

/// Obstacles cast no shadows: a plate that presses a body would hide in the dark what the picture is to show.
std::vector<Face> shadow_casters(const Subject& subject) {
    std::vector<Face> casters;
    casters.reserve(subject.faces.size());
    for (std::size_t f = 0; f < subject.faces.size(); ++f)
        if (!subject.is_obstacle(f))
            casters.push_back(subject.faces[f]);
    return casters;
}

float positive(float value) {
    return std::max(value, 0.0f);
}

} // namespace

LightRig::LightRig(const Camera& camera, bool flat)
    : to_key((-0.50 * camera.right + 0.66 * camera.up - 0.72 * camera.forward).normalized()),
      to_fill((0.90 * camera.right + 0.10 * camera.up - 0.55 * camera.forward).normalized()) {
    // Colours that stand for values need more even light.
    const float key_share = flat ? 0.55f : 1.0f;
    const float around_share = flat ? 1.35f : 1.0f;
    key = key_share * 0.80f * Color{1.00f, 0.96f, 0.90f};
    fill = around_share * 0.16f * Color{0.80f, 0.90f, 1.00f};
    sky = around_share * 0.46f * Color{0.94f, 0.98f, 1.06f};
    ground = around_share * 0.27f * Color{1.04f, 0.98f, 0.94f};
    gloss = flat ? 0.0f : 0.07f;
}

Shader::Shader(const Subject& subject, const DrawOptions& options, const Camera& camera, int width, int height,
               const ConstPositions& region)
    : subject_(subject), options_(options), camera_(camera), width_(width), height_(height),
      lights_(camera, options.scalars != nullptr),
      shadows_(subject.positions, shadow_casters(subject), lights_.to_key, region),
      normals_(corner_normals(subject.positions, subject.faces, crease_deg)) {}

Color Shader::face_color(std::size_t face, const Vec3& weights) const {
    if (subject_.is_obstacle(face))
        return obstacle_color();
    if (options_.scalars) {
        const Scalars& scalars = *options_.scalars;
        double value = 0;
        if (scalars.domain == MeshAttribute::Domain::face)
            value = scalars.values[face];
        else
            for (std::size_t k = 0; k < 3; ++k)
                value += weights[static_cast<Eigen::Index>(k)] *
                         scalars.values[static_cast<std::size_t>(subject_.faces[face][k])];
        const double share = (value - scalars.low) / (scalars.high - scalars.low);
        return std::isfinite(share) ? map_color(share) : obstacle_color();
    }
    if (!options_.tell_bodies_apart)
        return clay_color();
    return body_color(subject_.face_body.empty() ? 0 : subject_.face_body[face]);
}

/// How much of an edge's line covers the place: `planes` hold the normals of the planes through the eye and each edge,
/// which give distances on the picture without projecting corners that may lie behind the eye. Each of an edge's two
/// faces draws half of its line. Lines grow faint where the faces are only a few pixels large.
float Shader::line_share(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& planes, const Vec3& ray) const {
    const double pixel = 2 * camera_.half_height / height_;
    double nearest = 1e9;
    double least_height = 1e9;
    for (std::size_t k = 0; k < 3; ++k) {
        const double slope = pixel * std::hypot(planes[k].dot(camera_.right), planes[k].dot(camera_.up));
        nearest = std::min(nearest, std::abs(planes[k].dot(ray)) / slope);
        const double corner_depth = corners[k].dot(camera_.forward);
        if (corner_depth > camera_.near)
            least_height = std::min(least_height, std::abs(planes[k].dot(corners[k])) / (slope * corner_depth));
    }
    return static_cast<float>(std::clamp(1.05 - nearest, 0.0, 1.0) * std::clamp(least_height / 9, 0.15, 0.75));
}

Fragment Shader::shade(int face, double x, double y) const {
    const auto f = static_cast<std::size_t>(face);
    const Vec3 ray = camera_.ray(x, y, width_, height_);
    std::array<Vec3, 3> corners, planes;
    for (std::size_t k = 0; k < 3; ++k)
        corners[k] = subject_.positions.col(subject_.faces[f][k]) - camera_.eye;
    // Barycentric weights of the place where the ray meets the face (Olano and Greer 1997).
    Vec3 weights;
    for (std::size_t k = 0; k < 3; ++k) {
        planes[k] = corners[(k + 1) % 3].cross(corners[(k + 2) % 3]);
        weights[static_cast<Eigen::Index>(k)] = planes[k].dot(ray);
    }
    const bool front = weights.sum() < 0;
    weights = (front ? Vec3(-weights) : weights).cwiseMax(0);
    weights = weights.sum() > 0 ? Vec3(weights / weights.sum()) : Vec3::Constant(1.0 / 3);

    Vec3 place = Vec3::Zero();
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
        const double weight = weights[static_cast<Eigen::Index>(k)];
        place += weight * corners[k];
        normal += static_cast<float>(weight) * normals_[f][k];
    }
    normal = (front ? 1.0f : -1.0f) * normal.stableNormalized();

    Color color = face_color(f, weights);
    if (!front)
        color = options_.scalars ? Color(0.8f * color) : back_color(color);
    if (options_.edges)
        color *= 1 - line_share(corners, planes, ray);

    const float toward_key = normal.dot(lights_.to_key.cast<float>());
    float key_light = 0;
    if (toward_key > 0)
        key_light = shadows_.light_at(place + camera_.eye, normal.cast<double>());
    const Eigen::Vector3f half = (lights_.to_key - ray.normalized()).normalized().cast<float>();
    const float shine = key_light * lights_.gloss * thirty_second_power(positive(normal.dot(half)));
    const float upward = 0.5f + 0.5f * normal.y();

    Fragment fragment;
    fragment.direct = color.cwiseProduct(lights_.key) * (key_light * positive(toward_key)) + Color::Constant(shine);
    fragment.ambient = color.cwiseProduct(upward * lights_.sky + (1 - upward) * lights_.ground +
                                          positive(normal.dot(lights_.to_fill.cast<float>())) * lights_.fill);
    fragment.normal = normal;
    fragment.depth = static_cast<float>(place.dot(camera_.forward));
    return fragment;
}

} // namespace plisse
