#pragma once

#include <vector>

#include <plisse/picture/camera.h>
#include <plisse/picture/colors.h>
#include <plisse/picture/draw.h>
#include <plisse/picture/normals.h>
#include <plisse/picture/shadow.h>

namespace plisse {

/// The lights of a picture, fixed to the camera: a warm key light from the upper left, a cool fill light from the
/// right, and light from all around, more of it from above.
struct LightRig {
    explicit LightRig(const Camera& camera, bool flat);

    Vec3 to_key, to_fill; ///< unit
    Color key, fill, sky, ground;
    float gloss; ///< brightness of the key light's reflection
};

/// Light from one place of a surface to the viewer, and what the picture's later stages need of the place.
struct Fragment {
    Color direct = Color::Zero();
    Color ambient = Color::Zero(); ///< to be dimmed by ambient occlusion
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    float depth = 0; ///< m along the camera's forward
};

/// Computes the light that a place of the subject sends to the viewer.
class Shader {
public:
    Shader(const Subject& subject, const DrawOptions& options, const Camera& camera, int width, int height,
           const ConstPositions& region);

    /// Of face `face`, seen at the place (x, y), in pixels from the top left corner.
    Fragment shade(int face, double x, double y) const;

private:
    Color face_color(std::size_t face, const Vec3& weights) const;
    float line_share(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& planes, const Vec3& ray) const;

    const Subject& subject_;
    const DrawOptions& options_;
    const Camera& camera_;
    int width_, height_;
    LightRig lights_;
    ShadowMap shadows_;
    std::vector<CornerNormals> normals_;
};

} // namespace plisse
