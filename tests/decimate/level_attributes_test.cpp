#include <plisse/decimate/level_attributes.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <plisse/decimate/decimate.h>

#include <decimate/test_meshes.h>

namespace plisse {
namespace {

using Domain = MeshAttribute::Domain;

class LevelAttributes : public testing::Test {
protected:
    LevelAttributes() {
        DecimationOptions options;
        options.coarsest_vertices = 50;
        hierarchy = decimate(mesh.input(), options);
    }

    /// Of every corner, its vertex's place in the plane, shifted by 10 on faces on the right: a seam down the middle.
    MeshAttribute uv_with_seam() const {
        MeshAttribute uv{"uv", Domain::corner, 2, {}};
        for (const Face& face : mesh.faces) {
            const bool right = (mesh.points[face[0]] + mesh.points[face[1]] + mesh.points[face[2]]).x() > 0;
            for (int v : face) {
                uv.values.push_back(mesh.points[v].x() + (right ? 10 : 0));
                uv.values.push_back(mesh.points[v].y());
            }
        }
        return uv;
    }
    MeshAttribute heights(MeshAttribute::Number number) const {
        MeshAttribute attribute{"height", Domain::vertex, 1, {}, number};
        for (const Vec3& point : mesh.points)
            attribute.values.push_back(number == MeshAttribute::Number::real ? point.y() : point.y() > 0 ? 3 : 5);
        return attribute;
    }

    test::TestMesh mesh = test::sphere(40, 31);
    Hierarchy hierarchy;
};

TEST_F(LevelAttributes, of_vertices_are_interpolated_where_they_are_reals) {
    const auto attributes = attributes_on(hierarchy, 0, {heights(MeshAttribute::Number::real)});
    ASSERT_EQ(attributes.size(), 1u);
    const HierarchyLevel& level = hierarchy.levels[0];
    ASSERT_EQ(attributes[0].values.size(), level.vertex_ids.size());
    for (std::size_t v = 0; v < level.vertex_ids.size(); ++v)
        EXPECT_NEAR(attributes[0].values[v], level.rest(1, static_cast<Eigen::Index>(v)), 0.15);
}

TEST_F(LevelAttributes, of_vertices_are_never_mixed_where_they_are_codes) {
    const auto attributes = attributes_on(hierarchy, 0, {heights(MeshAttribute::Number::int32)});
    const HierarchyLevel& level = hierarchy.levels[0];
    for (std::size_t v = 0; v < level.vertex_ids.size(); ++v) {
        const double value = attributes[0].values[v], height = level.rest(1, static_cast<Eigen::Index>(v));
        EXPECT_TRUE(value == 3 || value == 5) << value;
        if (std::abs(height) > 0.2) {
            EXPECT_EQ(value, height > 0 ? 3 : 5);
        }
    }
}

TEST_F(LevelAttributes, of_faces_are_those_of_the_face_with_their_id) {
    MeshAttribute number{"number", Domain::face, 2, {}, MeshAttribute::Number::int32};
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (int k = 0; k < 2; ++k)
            number.values.push_back(static_cast<double>(2 * f) + k);
    const auto attributes = attributes_on(hierarchy, 1, {number});
    const HierarchyLevel& level = hierarchy.levels[1];
    ASSERT_EQ(attributes[0].values.size(), 2 * level.face_ids.size());
    for (std::size_t f = 0; f < level.face_ids.size(); ++f)
        EXPECT_EQ(attributes[0].values[2 * f + 1], 2 * level.face_ids[f] + 1);
}

TEST_F(LevelAttributes, of_corners_stay_on_their_side_of_a_seam) {
    const auto attributes = attributes_on(hierarchy, 0, {uv_with_seam()});
    const HierarchyLevel& level = hierarchy.levels[0];
    ASSERT_EQ(attributes[0].values.size(), 6 * level.faces.size());
    double worst = 0;
    int beyond_seam = 0;
    for (std::size_t f = 0; f < level.faces.size(); ++f) {
        int right = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double u = attributes[0].values[6 * f + 2 * k];
            const double x = level.rest(0, level.faces[f][k]);
            right += u > 5;
            worst = std::max(worst, std::abs(u - (u > 5 ? 10 : 0) - x));
            beyond_seam += (u > 5) != (x > 0);
        }
        EXPECT_TRUE(right == 0 || right == 3) << "face " << f;
    }
    EXPECT_GT(beyond_seam, 0); // what tests the extension
    EXPECT_LT(worst, 0.4);     // of a sphere of radius 1, where flat faces are extended
}

/// A map all around, whose two edges meet in a seam that divides nothing into parts.
TEST_F(LevelAttributes, of_corners_do_not_span_the_seam_of_a_map_around) {
    const auto turn_of = [](const Vec3& point) { return std::atan2(point.z(), point.x()) / (2 * std::numbers::pi); };
    const auto wrapped = [](double difference) { return difference - std::round(difference); };
    MeshAttribute uv{"uv", Domain::corner, 1, {}};
    for (const Face& face : mesh.faces) {
        const double centre = turn_of(mesh.points[face[0]] + mesh.points[face[1]] + mesh.points[face[2]]);
        for (int v : face)
            uv.values.push_back(centre + wrapped(turn_of(mesh.points[v]) - centre));
    }
    for (int l = 0; l + 1 < hierarchy.level_count(); ++l) {
        const HierarchyLevel& level = hierarchy.levels[static_cast<std::size_t>(l)];
        const std::vector<double> values = attributes_on(hierarchy, l, {uv})[0].values;
        for (std::size_t f = 0; f < level.faces.size(); ++f) {
            double least = 1, most = -1, highest = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 point = level.rest.col(level.faces[f][k]);
                highest = std::max(highest, std::abs(point.y()));
                least = std::min(least, values[3 * f + k]);
                most = std::max(most, values[3 * f + k]);
                if (std::abs(point.y()) < 0.8) {
                    EXPECT_LT(std::abs(wrapped(values[3 * f + k] - turn_of(point))), 0.1) << "face " << f;
                }
            }
            if (highest < 0.8) { // at the poles the map is torn
                EXPECT_LT(most - least, 0.4) << "face " << f;
            }
        }
    }
}

TEST_F(LevelAttributes, of_the_finest_level_are_untouched) {
    const std::vector<MeshAttribute> given{uv_with_seam()};
    EXPECT_EQ(attributes_on(hierarchy, hierarchy.level_count() - 1, given)[0].values, given[0].values);
}

} // namespace
} // namespace plisse
