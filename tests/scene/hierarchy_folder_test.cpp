#include <gtest/gtest.h>

#include <plisse/base/error.h>
#include <plisse/decimate/decimate.h>
#include <plisse/mesh/generate.h>
#include <plisse/scene/hierarchy_folder.h>
#include <plisse/scene/verify_hierarchy.h>
#include <plisse/spatial/box.h>
#include <plisse/subdivide/subdivide.h>

#include "temporary_folder.h"

namespace plisse {
namespace {

DecimationResult decimated(GeneratorShape shape) {
    GeneratorOptions options;
    options.shape = shape;
    options.edge_length = 0.12;
    const TriangleMesh mesh = generate_mesh(options);
    const std::vector<int> part(static_cast<std::size_t>(mesh.vertex_count()), 0);
    DecimationOptions decimation;
    decimation.levels = 3;
    decimation.coarsest_vertices = 60;
    DecimationResult result;
    result.hierarchy = decimate({mesh.positions, mesh.faces, part, {}, {}}, decimation, nullptr, &result.summary);
    return result;
}

DecimationResult decimated_sphere() {
    return decimated(GeneratorShape::sphere);
}

TEST(HierarchyFolder, ReadsBackWhatWasWritten) {
    const DecimationResult decimation = decimated_sphere();
    const Hierarchy& hierarchy = decimation.hierarchy;
    const TemporaryFolder folder;
    write_hierarchy(folder.path(), decimation, {});
    const HierarchyFiles files = read_hierarchy(folder.path());
    ASSERT_EQ(files.levels.size(), hierarchy.levels.size());
    for (std::size_t l = 0; l < files.levels.size(); ++l) {
        EXPECT_EQ(files.levels[l].positions, hierarchy.levels[l].rest);
        EXPECT_EQ(files.levels[l].faces, hierarchy.levels[l].faces);
    }
    for (std::size_t l = 0; l + 1 < files.levels.size(); ++l)
        for (std::size_t v = 0; v < files.to_finest[l].size(); ++v) {
            EXPECT_EQ(files.to_finest[l][v].face, hierarchy.levels[l].to_finest[v].face);
            EXPECT_EQ(files.to_finest[l][v].weights, hierarchy.levels[l].to_finest[v].weights);
        }
    EXPECT_EQ(read_collapses(folder.path()).collapses.size(), hierarchy.collapses.size());
}

TEST(HierarchyFolder, KeepsAttributesOnEveryLevel) {
    const DecimationResult decimation = decimated_sphere();
    MeshAttribute height{"height", MeshAttribute::Domain::vertex, 1, {}};
    for (const auto& point : decimation.hierarchy.finest().rest.colwise())
        height.values.push_back(point.y());
    const TemporaryFolder folder;
    write_hierarchy(folder.path(), decimation, {height});
    for (const TriangleMesh& level : read_hierarchy(folder.path()).levels) {
        ASSERT_EQ(level.attributes.size(), 1u);
        EXPECT_EQ(level.attributes[0].name, "height");
        for (int v = 0; v < level.vertex_count(); ++v)
            EXPECT_NEAR(level.attributes[0].values[static_cast<std::size_t>(v)], level.positions(1, v), 0.25);
    }
}

TEST(HierarchyFolder, RefusesAMapOfOtherMeshes) {
    const TemporaryFolder folder;
    EXPECT_THROW(read_hierarchy(folder.path()), InputError);
    EXPECT_THROW(read_collapses(folder.path()), InputError);
    write_hierarchy(folder.path(), decimated_sphere(), {});
    std::filesystem::copy_file(folder.path() / "level-0.ply", folder.path() / "level-2.ply",
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_THROW(read_hierarchy(folder.path()), InputError);
    write_text(folder.path() / "map.json", "{\"levels\": 3}");
    EXPECT_THROW(read_hierarchy(folder.path()), InputError);
}

TEST(VerifyHierarchy, HoldsForADecimationAndFailsForABrokenMap) {
    Hierarchy hierarchy = decimated_sphere().hierarchy;
    const auto good = verify_hierarchy(hierarchy);
    ASSERT_EQ(good.size(), 2u);
    for (const LevelVerification& level : good) {
        EXPECT_TRUE(level.holds()) << "level " << level.level << " rest " << level.rest_error << " rigid "
                                   << level.rigid_error;
        EXPECT_GT(level.mapped_faces, 0);
        EXPECT_GT(level.distance, 0);
        EXPECT_GT(level.mean_return_error, 0);
        EXPECT_LT(level.mean_return_error, 0.01); // a tenth of a coarse edge
    }
    EXPECT_LT(good[1].distance, good[0].distance);
    Hierarchy negative = hierarchy;
    negative.levels[0].to_finest[7].weights = Vec3(-0.1, 0.6, 0.5);
    EXPECT_FALSE(verify_hierarchy(negative)[0].holds());
    Hierarchy coincident = hierarchy;
    coincident.levels[0].to_finest[7] = coincident.levels[0].to_finest[8];
    EXPECT_FALSE(verify_hierarchy(coincident)[0].holds());
    Hierarchy missing = hierarchy;
    missing.levels[0].to_finest[7].face = -1;
    EXPECT_FALSE(verify_hierarchy(missing)[0].holds());
    Hierarchy one_way = hierarchy;
    one_way.levels[0].on_input[3].face = -1;
    EXPECT_FALSE(verify_hierarchy(one_way)[0].holds());
    EXPECT_EQ(verify_hierarchy(one_way)[0].missing_ways_back, 1);
    Hierarchy crossed = hierarchy;
    crossed.levels[0].rest.col(3) *= -1;
    EXPECT_GT(verify_hierarchy(crossed)[0].new_intersections, 0);
}

TEST(VerifyHierarchy, MeasuresTheDistanceFromASphere) {
    // Every vertex of a decimated sphere of radius 0.5 is within the error of its quadrics from it: the largest
    // distance is that of finest vertices from the middles of coarse faces.
    const Hierarchy hierarchy = decimated_sphere().hierarchy;
    const HierarchyLevel& level = hierarchy.levels[0];
    double lowest = 0.5;
    for (const Face& face : level.faces)
        lowest = std::min(lowest,
                          ((level.rest.col(face[0]) + level.rest.col(face[1]) + level.rest.col(face[2])) / 3).norm());
    const double diagonal = bounding_box(hierarchy.finest().rest).diagonal();
    EXPECT_NEAR(verify_hierarchy(hierarchy)[0].distance * diagonal, 0.5 - lowest, 0.1 * (0.5 - lowest));
}

TEST(VerifyHierarchy, MapsOfAFlatSheetAreInverseToEachOther) {
    // In the plane the map is the identity, and so are its images.
    const LevelVerification level = verify_hierarchy(decimated(GeneratorShape::sheet).hierarchy)[0];
    EXPECT_TRUE(level.holds());
    EXPECT_LT(level.distance, 1e-12);
    EXPECT_LT(level.largest_return_error, 1e-12);
}

TEST(VerifyHierarchy, HoldsForTwoSubdividedParts) {
    GeneratorOptions options;
    options.edge_length = 0.3;
    const TriangleMesh sheet = generate_mesh(options);
    const int n = sheet.vertex_count();
    SubdivisionInput input;
    input.rest.resize(3, 2 * n);
    input.rest << sheet.positions, (sheet.positions.colwise() + Vec3(0, 1, 0));
    input.surface.faces = sheet.faces;
    for (const Face& face : sheet.faces)
        input.surface.faces.push_back({face[0] + n, face[1] + n, face[2] + n});
    input.surface.part.assign(static_cast<std::size_t>(n), 0);
    input.surface.part.resize(static_cast<std::size_t>(2 * n), 1);
    input.surface.label.assign(static_cast<std::size_t>(2 * n), -1);
    const std::vector<LevelVerification> levels = verify_hierarchy(subdivide(input, 3));
    ASSERT_EQ(levels.size(), 2u);
    for (const LevelVerification& level : levels) {
        EXPECT_TRUE(level.holds()) << level.level;
        EXPECT_LT(level.distance, 1e-12) << "flat, and its boundary stays";
    }
}

} // namespace
} // namespace plisse
