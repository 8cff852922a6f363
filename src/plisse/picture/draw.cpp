#include <plisse/picture/draw.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <plisse/base/parallel.h>
#include <plisse/picture/legend.h>
#include <plisse/picture/occlusion.h>
#include <plisse/picture/rasterise.h>
#include <plisse/picture/shading.h>
#include <plisse/picture/text.h>

namespace plisse {

namespace {

constexpr int samples_per_axis = 3;
constexpr int samples_per_pixel = samples_per_axis * samples_per_axis;

/// Light of every pixel before ambient occlusion, and the surface that fills most of it.
struct LightBuffer {
    std::vector<Color> direct, ambient;
    SurfaceBuffer surface;

    LightBuffer(int width, int height) {
        const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        direct.assign(count, Color::Zero());
        ambient.assign(count, Color::Zero());
        surface.width = width;
        surface.height = height;
        surface.depth.assign(count, std::numeric_limits<float>::infinity());
        surface.normals.assign(count, Eigen::Vector3f::Zero());
    }
};

Color background(int y, int height) {
    static const Color top = color_from_hex(0xf6f8fa);
    static const Color bottom = color_from_hex(0xd9dfe7);
    const float share = (static_cast<float>(y) + 0.5f) / static_cast<float>(height);
    return (1 - share) * top + share * bottom;
}

/// The samples of one pixel that show the same face, or none.
struct Cluster {
    int face = -1;
    int count = 0;
    Vec2 sum = Vec2::Zero(); ///< of the samples' places within the pixel
};

int gather_clusters(const SampleBand& band, int x, int row, std::array<Cluster, samples_per_pixel>& clusters) {
    int count = 0;
    for (int j = 0; j < samples_per_axis; ++j)
        for (int i = 0; i < samples_per_axis; ++i) {
            const int face = band.face[band.index(x * samples_per_axis + i, row * samples_per_axis + j)];
            int k = 0;
            while (k < count && clusters[static_cast<std::size_t>(k)].face != face)
                ++k;
            Cluster& cluster = clusters[static_cast<std::size_t>(k)];
            if (k == count) {
                cluster = {face, 0, Vec2::Zero()};
                ++count;
            }
            ++cluster.count;
            cluster.sum += Vec2{i + 0.5, j + 0.5} / samples_per_axis;
        }
    return count;
}

/// Shades each face of a pixel once, at the middle of its samples.
void shade_pixel(const SampleBand& band, int x, int row, const Shader& shader, LightBuffer& light) {
    std::array<Cluster, samples_per_pixel> clusters; // most of it stays unused
    const int y = band.first_row + row;
    const std::size_t pixel = light.surface.index(x, y);
    int largest = 0;
    for (int k = 0, count = gather_clusters(band, x, row, clusters); k < count; ++k) {
        const Cluster& cluster = clusters[static_cast<std::size_t>(k)];
        const float share = static_cast<float>(cluster.count) / samples_per_pixel;
        if (cluster.face < 0) {
            light.direct[pixel] += share * background(y, light.surface.height);
            continue;
        }
        const Vec2 middle = Vec2{x, y} + cluster.sum / cluster.count;
        const Fragment fragment = shader.shade(cluster.face, middle.x(), middle.y());
        light.direct[pixel] += share * fragment.direct;
        light.ambient[pixel] += share * fragment.ambient;
        if (cluster.count > largest) {
            largest = cluster.count;
            light.surface.depth[pixel] = fragment.depth;
            light.surface.normals[pixel] = fragment.normal;
        }
    }
}

Image expose(const LightBuffer& light, const std::vector<float>& openness) {
    const SurfaceBuffer& surface = light.surface;
    Image image(surface.width, surface.height);
    parallel_for(surface.height, 16, [&](int y) {
        for (int x = 0; x < surface.width; ++x) {
            const std::size_t pixel = surface.index(x, y);
            // A little of the direct light is dimmed too: it reads better than light alone would have it.
            const float open = openness[pixel];
            image.at(x, y) = to_pixel((0.75f + 0.25f * open) * light.direct[pixel] + open * light.ambient[pixel]);
        }
    });
    return image;
}

double extent(const ConstPositions& points) {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        if (points.col(i).allFinite()) {
            low = low.cwiseMin(points.col(i));
            high = high.cwiseMax(points.col(i));
        }
    return low.x() <= high.x() ? std::max((high - low).norm(), 1e-12) : 1;
}

Image draw_surface(const Subject& subject, const DrawOptions& options, int width, int height) {
    const Positions points = options.frame ? *options.frame : framing_points(subject);
    const Camera camera = fit_camera(points, options.view, static_cast<double>(width) / height);
    const Shader shader(subject, options, camera, width, height, points);
    const std::vector<ScreenTriangle> triangles = project(subject.positions, subject.faces, camera, width, height);
    LightBuffer light(width, height);
    rasterise(triangles, width, height, samples_per_axis, [&](const SampleBand& band) {
        for (int row = 0; row < band.row_count; ++row)
            for (int x = 0; x < width; ++x)
                shade_pixel(band, x, row, shader, light);
    });
    Image image = expose(light, ambient_openness(light.surface, camera, 0.08 * extent(points)));
    if (triangles.empty()) {
        const std::string_view note = "nothing to draw";
        draw_text(image, (width - text_width(note, 2)) / 2, (height - text_height(2)) / 2, note, 2, {120, 126, 134});
    }
    return image;
}

} // namespace

Positions framing_points(const Subject& subject) {
    const auto count = static_cast<std::size_t>(subject.positions.cols());
    std::vector<char> of_body(count, 0), of_obstacle(count, 0);
    for (std::size_t f = 0; f < subject.faces.size(); ++f)
        for (int v : subject.faces[f])
            (subject.is_obstacle(f) ? of_obstacle : of_body)[static_cast<std::size_t>(v)] = 1;
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    for (std::size_t v = 0; v < count; ++v) {
        const Vec3 x = subject.positions.col(static_cast<Eigen::Index>(v));
        if (of_body[v] && x.allFinite()) {
            low = low.cwiseMin(x);
            high = high.cwiseMax(x);
        }
    }
    const bool has_body = low.x() <= high.x();
    const Vec3 reach = has_body ? Vec3::Constant(0.25 * (high - low).norm()) : Vec3::Zero();
    Positions points(3, subject.positions.cols());
    Eigen::Index used = 0;
    for (std::size_t v = 0; v < count; ++v) {
        const Vec3 x = subject.positions.col(static_cast<Eigen::Index>(v));
        if (!x.allFinite() || !(of_body[v] || of_obstacle[v]))
            continue;
        points.col(used++) = has_body ? Vec3(x.cwiseMax(low - reach).cwiseMin(high + reach)) : x;
    }
    return points.leftCols(used);
}

Image draw(const Subject& subject, const DrawOptions& options) {
    assert(options.width > 0 && options.height > 0);
    assert(subject.face_body.empty() || subject.face_body.size() == subject.faces.size());
    const bool with_legend = options.scalars && options.width >= 3 * legend_width;
    const int surface_width = options.width - (with_legend ? legend_width : 0);
    const Image surface = draw_surface(subject, options, surface_width, options.height);
    if (!with_legend)
        return surface;
    Image image(options.width, options.height);
    for (int y = 0; y < options.height; ++y)
        image.fill(0, y, options.width, 1, to_pixel(background(y, options.height)));
    image.paste(surface, 0, 0);
    draw_legend(image, surface_width, *options.scalars);
    return image;
}

} // namespace plisse
