#include <plisse/picture/rasterise.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

constexpr int band_rows = 16;

/// Part of a polygon with z >= near (Sutherland and Hodgman 1974), for one triangle: up to four corners.
int clip_near(const std::array<Vec3, 3>& corners, double near, std::array<Vec3, 4>& kept) {
    int count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& a = corners[k];
        const Vec3& b = corners[(k + 1) % 3];
        if (a.z() >= near)
            kept[static_cast<std::size_t>(count++)] = a;
        if ((a.z() >= near) != (b.z() >= near)) {
            // From the far end to the near one, so that both faces of an edge get the same point.
            const Vec3& from = a.z() >= near ? a : b;
            const Vec3& to = a.z() >= near ? b : a;
            kept[static_cast<std::size_t>(count++)] = from + (from.z() - near) / (from.z() - to.z()) * (to - from);
        }
    }
    return count;
}

/// The line through two corners as a x + b y + c, which is positive inside the triangle. Computed from the end that
/// comes first in lexicographic order: the two triangles of an edge then get the same numbers with opposite signs, and
/// every sample on the edge belongs to at least one of them.
struct EdgeLine {
    double a, b, c;
    EdgeLine(const Vec3& from, const Vec3& to, double sign) {
        const bool swapped = to.x() < from.x() || (to.x() == from.x() && to.y() < from.y());
        const Vec3& p = swapped ? to : from;
        const Vec3& q = swapped ? from : to;
        const double s = swapped ? -sign : sign;
        a = s * (p.y() - q.y());
        b = s * (q.x() - p.x());
        c = s * (p.x() * q.y() - q.x() * p.y());
    }
};

/// Fills one band's samples. Coordinates below are in samples, rows counted from the band's top.
class BandFiller {
public:
    BandFiller(int first_row, int row_count, int width, int samples_per_axis) {
        band_.first_row = first_row;
        band_.row_count = row_count;
        band_.width = width;
        band_.samples_per_axis = samples_per_axis;
        const auto count =
            static_cast<std::size_t>(band_.sample_width()) * static_cast<std::size_t>(row_count * samples_per_axis);
        band_.face.assign(count, -1);
        band_.nearness.assign(count, -std::numeric_limits<float>::infinity());
    }

    const SampleBand& band() const { return band_; }

    void add(const ScreenTriangle& triangle) {
        const double scale = band_.samples_per_axis;
        std::array<Vec3, 3> corners = triangle.corners;
        for (Vec3& corner : corners)
            corner.head<2>() = scale * corner.head<2>() - Vec2{0.5, scale * band_.first_row + 0.5};
        const Vec3 u = corners[1] - corners[0];
        const Vec3 v = corners[2] - corners[0];
        const double twice_area = u.x() * v.y() - u.y() * v.x();
        if (!std::isfinite(twice_area) || twice_area == 0)
            return;
        const double sign = twice_area > 0 ? 1 : -1;
        const std::array<EdgeLine, 3> edges = {EdgeLine(corners[0], corners[1], sign),
                                               EdgeLine(corners[1], corners[2], sign),
                                               EdgeLine(corners[2], corners[0], sign)};
        const double slope_x = (u.z() * v.y() - v.z() * u.y()) / twice_area;
        const double slope_y = (v.z() * u.x() - u.z() * v.x()) / twice_area;
        const auto [low_y, high_y] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
        const auto [low_z, high_z] = std::minmax({corners[0].z(), corners[1].z(), corners[2].z()});
        const int last_row = band_.row_count * band_.samples_per_axis - 1;
        const int top = static_cast<int>(std::clamp(std::ceil(low_y), 0.0, last_row + 1.0));
        const int bottom = static_cast<int>(std::clamp(std::floor(high_y), -1.0, static_cast<double>(last_row)));
        for (int y = top; y <= bottom; ++y) {
            const double start = corners[0].z() + slope_y * (y - corners[0].y()) - slope_x * corners[0].x();
            fill_row(edges, y, start, slope_x, low_z, high_z, triangle.face, corners);
        }
    }

private:
    void fill_row(const std::array<EdgeLine, 3>& edges, int y, double start, double slope, double low, double high,
                  int face, const std::array<Vec3, 3>& corners) {
        const auto [low_x, high_x] = std::minmax({corners[0].x(), corners[1].x(), corners[2].x()});
        double left = std::max(std::floor(low_x), 0.0);
        double right = std::min(std::ceil(high_x), band_.sample_width() - 1.0);
        std::array<double, 3> rest;
        for (std::size_t k = 0; k < 3; ++k) {
            rest[k] = edges[k].b * y + edges[k].c;
            // One sample wider than the edge allows: the exact test follows.
            if (edges[k].a > 0)
                left = std::max(left, std::floor(-rest[k] / edges[k].a) - 1);
            else if (edges[k].a < 0)
                right = std::min(right, std::ceil(-rest[k] / edges[k].a) + 1);
        }
        if (!(left <= right))
            return;
        const int end = static_cast<int>(right);
        for (int x = static_cast<int>(left); x <= end; ++x) {
            if (edges[0].a * x + rest[0] < 0 || edges[1].a * x + rest[1] < 0 || edges[2].a * x + rest[2] < 0)
                continue;
            const auto nearness = static_cast<float>(std::clamp(start + slope * x, low, high));
            const std::size_t sample = band_.index(x, y);
            if (nearness > band_.nearness[sample]) {
                band_.nearness[sample] = nearness;
                band_.face[sample] = face;
            }
        }
    }

    SampleBand band_;
};

/// Numbers of the triangles that touch each band, ascending.
std::vector<std::vector<int>> sort_into_bands(std::span<const ScreenTriangle> triangles, int width, int height) {
    std::vector<std::vector<int>> bands(static_cast<std::size_t>(chunk_count(height, band_rows)));
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto& [a, b, c] = triangles[i].corners;
        const auto [left, right] = std::minmax({a.x(), b.x(), c.x()});
        const auto [top, bottom] = std::minmax({a.y(), b.y(), c.y()});
        if (!(left < width && right > 0 && top < height && bottom > 0))
            continue;
        const auto first = static_cast<std::size_t>(std::max(top, 0.0) / band_rows);
        const auto last = static_cast<std::size_t>(std::min(bottom, height - 1.0) / band_rows);
        for (std::size_t band = first; band <= last; ++band)
            bands[band].push_back(static_cast<int>(i));
    }
    return bands;
}

} // namespace

std::vector<ScreenTriangle> project(const ConstPositions& positions, std::span<const Face> faces, const Camera& camera,
                                    int width, int height) {
    const double pixels = 0.5 * height / camera.half_height;
    Mat3 to_camera;
    to_camera << camera.right.transpose(), -camera.up.transpose(), camera.forward.transpose();
    const Positions seen = to_camera * (positions.colwise() - camera.eye);
    std::vector<ScreenTriangle> triangles;
    triangles.reserve(faces.size());
    std::array<Vec3, 4> kept;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const std::array<Vec3, 3> corners = {seen.col(faces[f][0]), seen.col(faces[f][1]), seen.col(faces[f][2])};
        if (!(corners[0] + corners[1] + corners[2]).allFinite())
            continue;
        const int count = clip_near(corners, camera.near, kept);
        for (int k = 0; k < count; ++k) {
            Vec3& corner = kept[static_cast<std::size_t>(k)];
            const double nearness = 1 / corner.z();
            corner = {0.5 * width + pixels * corner.x() * nearness, 0.5 * height + pixels * corner.y() * nearness,
                      nearness};
        }
        for (std::size_t k = 2; k < static_cast<std::size_t>(count); ++k)
            triangles.push_back({{kept[0], kept[k - 1], kept[k]}, static_cast<int>(f)});
    }
    return triangles;
}

void rasterise(std::span<const ScreenTriangle> triangles, int width, int height, int samples_per_axis,
               const std::function<void(const SampleBand&)>& receive) {
    const std::vector<std::vector<int>> bands = sort_into_bands(triangles, width, height);
    parallel_for(static_cast<int>(bands.size()), 1, [&](int number) {
        const int first_row = number * band_rows;
        BandFiller filler(first_row, std::min(band_rows, height - first_row), width, samples_per_axis);
        for (int i : bands[static_cast<std::size_t>(number)])
            filler.add(triangles[static_cast<std::size_t>(i)]);
        receive(filler.band());
    });
}

} // namespace plisse
