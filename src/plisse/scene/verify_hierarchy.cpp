#include <plisse/scene/verify_hierarchy.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include <plisse/base/random.h>
#include <plisse/decimate/level_prolongation.h>
#include <plisse/geometry/distance.h>
#include <plisse/model/track.h>
#include <plisse/spatial/box_tree.h>
#include <plisse/spatial/intersections.h>

namespace plisse {

namespace {

/// Over the vertices that have an anchor: the others stay where they are, whatever moves.
double largest_distance(const std::vector<Anchor>& anchors, const Positions& a, const Positions& b) {
    double squared = 0;
    for (std::size_t v = 0; v < anchors.size(); ++v)
        if (anchors[v].face >= 0) {
            const auto column = static_cast<Eigen::Index>(v);
            squared = std::max(squared, (a.col(column) - b.col(column)).squaredNorm());
        }
    return std::sqrt(squared);
}

double measure_rigid_error(const Prolongation& prolongation, const Positions& coarse, double diagonal) {
    Random random(1);
    double worst = 0;
    const Positions fine = prolongation.apply(coarse);
    for (int trial = 0; trial < 5; ++trial) {
        const Mat3 rotation =
            rotation_xyz(Vec3(random.uniform(-180, 180), random.uniform(-180, 180), random.uniform(-180, 180)));
        const Vec3 shift = diagonal * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const Positions moved = (rotation * coarse).colwise() + shift;
        const Positions expected = (rotation * fine).colwise() + shift;
        worst = std::max(worst, largest_distance(prolongation.anchors(), prolongation.apply(moved), expected));
    }
    return worst;
}

/// Positions bent by a smooth wave, so that the rigid test meets offsets in deformed triangles too.
Positions waved(const Positions& x, double diagonal) {
    Positions y = x;
    for (Eigen::Index i = 0; i < x.cols(); ++i)
        y.col(i) += 0.02 * diagonal * (x.col(i) * (6 / diagonal)).array().sin().matrix();
    return y;
}

/// Per vertex of a level: whether some face uses it.
std::vector<bool> used_vertices(const HierarchyLevel& level) {
    std::vector<bool> used(static_cast<std::size_t>(level.rest.cols()), false);
    for (const Face& face : level.faces)
        for (int v : face)
            used[static_cast<std::size_t>(v)] = true;
    return used;
}

void measure_weights(const HierarchyLevel& level, const HierarchyLevel& finest, LevelVerification& result) {
    const std::vector<bool> used = used_vertices(finest);
    for (std::size_t v = 0; v < used.size(); ++v) {
        const Anchor& anchor = level.to_finest[v];
        if (used[v] && anchor.face < 0)
            ++result.missing_anchors;
        if (anchor.face < 0)
            continue;
        result.worst_weight = std::min(result.worst_weight, anchor.weights.minCoeff());
        result.worst_sum = std::max(result.worst_sum, std::abs(1 - anchor.weights.sum()));
    }
}

/// Where an anchor lies on a surface.
Vec3 place_on(const Positions& x, const std::vector<Face>& faces, const Anchor& anchor) {
    const Face& face = faces[static_cast<std::size_t>(anchor.face)];
    Vec3 place = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
        place += anchor.weights[static_cast<int>(k)] * x.col(face[k]);
    return place;
}

void measure_coincidences(const HierarchyLevel& level, LevelVerification& result) {
    std::vector<std::array<double, 3>> images;
    for (const Anchor& anchor : level.to_finest)
        if (anchor.face >= 0) {
            const Vec3 p = place_on(level.rest, level.faces, anchor);
            images.push_back({p.x(), p.y(), p.z()});
        }
    std::sort(images.begin(), images.end());
    for (std::size_t i = 1; i < images.size(); ++i)
        result.coincident_images += images[i] == images[i - 1] ? 1 : 0;
}

void measure_folds(const HierarchyLevel& level, const HierarchyLevel& finest, LevelVerification& result) {
    for (const Face& face : finest.faces) {
        std::array<const Anchor*, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = &level.to_finest[static_cast<std::size_t>(face[k])];
        if (corners[0]->face < 0 || corners[1]->face != corners[0]->face || corners[2]->face != corners[0]->face)
            continue;
        ++result.mapped_faces;
        // Twice the signed area of the image, the coarse face's being 1.
        const double area = corners[0]->weights.dot(corners[1]->weights.cross(corners[2]->weights));
        result.folded_faces += area < 0 ? 1 : 0;
    }
}

/// Images on the level of the finest vertices; their rest positions where they have none.
Positions images_on(const HierarchyLevel& level, const HierarchyLevel& finest) {
    Positions images = finest.rest;
    for (std::size_t v = 0; v < level.to_finest.size(); ++v)
        if (level.to_finest[v].face >= 0)
            images.col(static_cast<Eigen::Index>(v)) = place_on(level.rest, level.faces, level.to_finest[v]);
    return images;
}

/// Of the vertices of a level, on the finest: by subdivision they are among the finest level's vertices.
std::vector<Anchor> places_on_finest(const Hierarchy& hierarchy, const HierarchyLevel& level) {
    if (!hierarchy.is_subdivided())
        return level.on_input;
    std::vector<Anchor> places(level.vertex_ids.size());
    std::vector<int> number(static_cast<std::size_t>(hierarchy.finest().rest.cols()), -1);
    for (std::size_t v = 0; v < places.size(); ++v)
        number[static_cast<std::size_t>(level.vertex_ids[v])] = static_cast<int>(v);
    const std::vector<Face>& faces = hierarchy.finest().faces;
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            if (const int v = number[static_cast<std::size_t>(faces[f][k])]; v >= 0)
                places[static_cast<std::size_t>(v)] = {static_cast<int>(f), Vec3::Unit(static_cast<int>(k))};
    return places;
}

/// places: of the level's vertices, on the finest level.
void measure_return(const HierarchyLevel& level, const HierarchyLevel& finest, const std::vector<Anchor>& places,
                    double diagonal, LevelVerification& result) {
    const Positions images = images_on(level, finest);
    const std::vector<bool> used = used_vertices(level);
    int returned = 0;
    for (std::size_t v = 0; v < places.size(); ++v) {
        const Anchor& anchor = places[v];
        if (anchor.face < 0) {
            result.missing_ways_back += used[v] ? 1 : 0;
            continue;
        }
        result.worst_weight = std::min(result.worst_weight, anchor.weights.minCoeff());
        result.worst_sum = std::max(result.worst_sum, std::abs(1 - anchor.weights.sum()));
        const Vec3 back = place_on(images, finest.faces, anchor);
        const double error = (back - level.rest.col(static_cast<Eigen::Index>(v))).norm() / diagonal;
        result.mean_return_error += error;
        result.largest_return_error = std::max(result.largest_return_error, error);
        ++returned;
    }
    result.mean_return_error /= std::max(returned, 1);
}

/// Nearest places on a surface to points that are known to be near.
class Surface {
public:
    explicit Surface(const HierarchyLevel& level) : level_(level) {
        std::vector<Box> boxes;
        for (const Face& face : level.faces) {
            Box& box = boxes.emplace_back();
            for (int v : face)
                box.include(level.rest.col(v));
        }
        tree_ = BoxTree(boxes);
    }

    /// near: a place on the surface.
    double distance(const Vec3& p, const Vec3& near) const {
        double squared = (p - near).squaredNorm();
        Box around;
        around.include(p);
        tree_.visit_overlaps(around.inflated(std::sqrt(squared)), [&](int f) {
            const Face& face = level_.faces[static_cast<std::size_t>(f)];
            Stencil stencil;
            stencil << p, level_.rest.col(face[0]), level_.rest.col(face[1]), level_.rest.col(face[2]);
            squared = std::min(squared, squared_distance_point_triangle(stencil));
        });
        return std::sqrt(squared);
    }

    /// The largest distance of points from the surface; anchors: of each, on it.
    double largest_distance(const Positions& points, const std::vector<Anchor>& anchors) const {
        double largest = 0;
        for (std::size_t v = 0; v < anchors.size(); ++v)
            if (anchors[v].face >= 0)
                largest = std::max(largest, distance(points.col(static_cast<Eigen::Index>(v)),
                                                     place_on(level_.rest, level_.faces, anchors[v])));
        return largest;
    }

private:
    const HierarchyLevel& level_;
    BoxTree tree_;
};

int count_intersections(const HierarchyLevel& level) {
    return static_cast<int>(intersecting_pairs(level.rest, level.faces).size());
}

} // namespace

bool LevelVerification::holds() const {
    return rest_error <= 1e-10 && rigid_error <= 1e-10 && worst_weight >= 0 && worst_sum <= 1e-12 &&
           missing_anchors == 0 && coincident_images == 0 && missing_ways_back == 0 && new_intersections == 0;
}

std::vector<LevelVerification> verify_hierarchy(const Hierarchy& hierarchy) {
    const HierarchyLevel& finest = hierarchy.finest();
    const double diagonal = bounding_box(finest.rest).diagonal();
    const Surface finest_surface(finest);
    const int intersections = count_intersections(finest);
    std::vector<LevelVerification> results;
    for (int l = 0; l + 1 < hierarchy.level_count(); ++l) {
        const HierarchyLevel& level = hierarchy.levels[static_cast<std::size_t>(l)];
        const Prolongation prolongation = prolongation_to_finest(hierarchy, l, ProlongationOperator::shell);
        LevelVerification& result = results.emplace_back();
        result.level = l;
        result.rest_error = largest_distance(level.to_finest, prolongation.apply(level.rest), finest.rest) / diagonal;
        result.rigid_error = measure_rigid_error(prolongation, waved(level.rest, diagonal), diagonal) / diagonal;
        measure_weights(level, finest, result);
        measure_coincidences(level, result);
        measure_folds(level, finest, result);
        const std::vector<Anchor> places = places_on_finest(hierarchy, level);
        measure_return(level, finest, places, diagonal, result);
        result.distance = std::max(Surface(level).largest_distance(finest.rest, level.to_finest),
                                   finest_surface.largest_distance(level.rest, places)) /
                          diagonal;
        result.new_intersections = std::max(0, count_intersections(level) - intersections);
    }
    return results;
}

} // namespace plisse
