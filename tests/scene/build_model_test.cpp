#include <gtest/gtest.h>

#include <plisse/scene/build_model.h>
#include <plisse/scene/load_part.h>
#include <plisse/scene/read_scene.h>

#include "temporary_folder.h"

namespace plisse {
namespace {

/// Collects what a run would say.
struct Listener : Context {
    void on_message(const std::string& message) override { messages.push_back(message); }
    std::vector<std::string> messages;
};

// Two triangles over the unit square, uv per vertex, and one triangle.
const std::string square_obj = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                               "f 1/1 3/3 2/2\nf 1/1 4/4 3/3\n";
const std::string triangle_obj = "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n";

class BuildModel : public testing::Test {
protected:
    BuildModel() {
        write_text(folder_.path() / "square.obj", square_obj);
        write_text(folder_.path() / "triangle.obj", triangle_obj);
    }
    Model build(const std::string& rest_of_scene) {
        return build_model(parse_scene("scene.json", R"({"plisse": 1, )" + rest_of_scene + "}", folder_.path()),
                           listener_);
    }
    std::string refusal(const std::string& rest_of_scene) {
        try {
            build(rest_of_scene);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }

    TemporaryFolder folder_;
    Listener listener_;
};

TEST_F(BuildModel, JoinsBodiesThenObstacles) {
    const Model m = build(R"("bodies": [{"name": "a", "mesh": "square.obj"},
        {"name": "b", "mesh": "triangle.obj", "transform": {"translate": [0, 1, 0]}}],
        "obstacles": [{"name": "floor", "mesh": "square.obj", "progressive": false,
                       "transform": {"scale": 10, "translate": [0, -1, 0]}, "motion": [{"t": 2, "translate": [0, -1, 0]}]}])");
    EXPECT_EQ(m.mesh.vertex_count(), 11);
    EXPECT_EQ(m.mesh.face_count(), 5);
    EXPECT_EQ(m.vertex_parts(), (std::vector{0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2}));
    EXPECT_EQ(m.face_parts(), (std::vector{0, 0, 1, 2, 2}));
    EXPECT_EQ(m.mesh.faces[2], (Face{4, 6, 5}));
    EXPECT_EQ(m.mesh.positions.col(9), Vec3(10, -1, 10));
    EXPECT_EQ(m.start, m.mesh.positions);
    EXPECT_FALSE(m.obstacles.at(0).progressive);
    EXPECT_EQ(m.obstacles[0].motion.apply(Vec3::Zero(), 1), Vec3(0, -1, 0)) << "one key is held at all times";
}

TEST_F(BuildModel, CarriesAttributesOfSomePartsAsZerosInOthers) {
    const Model m = build(R"("bodies": [{"mesh": "triangle.obj", "transform": {"translate": [0, 1, 0]}},
                                        {"mesh": "square.obj"}])");
    ASSERT_EQ(m.mesh.attributes.size(), 1u);
    const MeshAttribute& uv = m.mesh.attributes[0];
    EXPECT_EQ(uv.width, 2);
    const std::size_t of_triangle = uv.domain == MeshAttribute::Domain::corner ? 3 : 3;
    const std::size_t of_square = uv.domain == MeshAttribute::Domain::corner ? 6 : 4;
    ASSERT_EQ(uv.values.size(), 2 * (of_triangle + of_square));
    for (std::size_t i = 0; i < 2 * of_triangle; ++i)
        EXPECT_EQ(uv.values[i], 0);
    double sum = 0;
    for (double value : uv.values)
        sum += value;
    EXPECT_EQ(sum, uv.domain == MeshAttribute::Domain::corner ? 6 : 4);
}

TEST(AppendMesh, KeepsAttributesOfOneNameAndTwoWidthsApart) {
    using Domain = MeshAttribute::Domain;
    TriangleMesh whole, one, two;
    one.positions = two.positions = Positions::Identity(3, 3);
    one.faces = two.faces = {{0, 1, 2}};
    one.attributes = {{"q", Domain::vertex, 1, {1, 2, 3}, MeshAttribute::Number::int32}};
    two.attributes = {{"q", Domain::vertex, 2, {1, 2, 3, 4, 5, 6}, MeshAttribute::Number::real}};
    append_mesh(whole, one);
    append_mesh(whole, two);
    append_mesh(whole, one);
    ASSERT_EQ(whole.attributes.size(), 2u);
    EXPECT_EQ(whole.attributes[0].values, (std::vector<double>{1, 2, 3, 0, 0, 0, 1, 2, 3}));
    EXPECT_EQ(whole.attributes[0].number, MeshAttribute::Number::int32);
    EXPECT_EQ(whole.attributes[1].values.size(), 18u);
    EXPECT_NE(whole.attributes[1].name, whole.attributes[0].name);
}

TEST_F(BuildModel, ScalesThenTurnsThenMoves) {
    const Model m = build(R"("bodies": [{"mesh": "square.obj",
        "transform": {"scale": 2, "rotate_deg": [90, 0, 90], "translate": [5, 0, 0]}}])");
    // (1, 0, 1) to (2, 0, 2), about x to (2, -2, 0), about z to (2, 2, 0), then moved
    EXPECT_LT((m.mesh.positions.col(2) - Vec3(7, 2, 0)).norm(), 1e-12);
}

TEST_F(BuildModel, SelectsOnPlacedPositions) {
    const Model m = build(R"("bodies": [{"name": "b", "mesh": "triangle.obj", "transform": {"translate": [0, 9, 0]}},
                             {"name": "a", "mesh": "square.obj", "transform": {"translate": [0, 1, 0]}}],
        "handles": [{"body": "a", "select": {"box": [[0, 1, 0], [0, 1, 1]]}, "axes": "y"},
                    {"body": "a", "select": {"sphere": [[1, 1, 1], 0.1]}},
                    {"body": "a", "select": {"vertices": [0, 3, 0]}, "axes": "xz"},
                    {"body": "b", "select": {"boundary_loop": 0}}],
        "loads": [{"body": "a", "force": [1, 0, 0]}])");
    EXPECT_EQ(m.handles.at(0).vertices, (std::vector{3, 6})) << "closed box";
    EXPECT_EQ(m.handles.at(1).vertices, (std::vector{5}));
    EXPECT_EQ(m.handles.at(2).vertices, (std::vector{3, 6})) << "other axes of the same vertices are free";
    EXPECT_EQ(m.handles.at(3).vertices, (std::vector{0, 1, 2}));
    EXPECT_EQ(m.loads.at(0).vertices, (std::vector{3, 4, 5, 6})) << "the whole body";
    EXPECT_EQ(m.loads[0].kind, Load::Kind::force);
}

TEST_F(BuildModel, RestAndStartMeshesReplacePositions) {
    write_text(folder_.path() / "wide.obj", "v 0 0 0\nv 3 0 0\nv 3 0 1\nv 0 0 1\nf 1 3 2\nf 1 4 3\n");
    const std::string rest = R"("mesh": "square.obj", "rest": {"mesh": "wide.obj"})";
    const Model with_rest = build(R"("bodies": [{)" + rest + R"(, "transform": {"scale": 2}}])");
    EXPECT_EQ(with_rest.mesh.positions.col(1), Vec3(6, 0, 0));
    EXPECT_EQ(with_rest.start.col(1), Vec3(2, 0, 0));
    const Model with_start = build(R"("bodies": [{"mesh": "square.obj", "start": "wide.obj"}])");
    EXPECT_EQ(with_start.mesh.positions.col(1), Vec3(1, 0, 0));
    EXPECT_EQ(with_start.start.col(1), Vec3(3, 0, 0));
}

TEST_F(BuildModel, RefusesIntersectionsButNotOfTwoObstacles) {
    const std::string crossing =
        R"({"mesh": "square.obj", "transform": {"rotate_deg": [0, 0, 40], "translate": [0.3, -0.2, 0.1]}})";
    const std::string message = refusal(R"("bodies": [{"name": "a", "mesh": "square.obj"}, )" + crossing + "]");
    EXPECT_NE(message.find("pairs of faces intersect at rest, first face 0 of \"a\" and face"), std::string::npos)
        << message;
    EXPECT_NE(refusal(R"("bodies": [{"mesh": "square.obj"}], "obstacles": [)" + crossing + "]"), "");
    EXPECT_EQ(refusal(R"("bodies": [{"mesh": "triangle.obj", "transform": {"translate": [0, 5, 0]}}],
                         "obstacles": [{"mesh": "square.obj"}, )" +
                      crossing + "]"),
              "");
}

TEST_F(BuildModel, RefusesAnObstacleThatItsScriptStartsInABody) {
    const std::string message = refusal(R"("bodies": [{"mesh": "square.obj"}], "obstacles": [{"mesh": "square.obj",
        "transform": {"rotate_deg": [90, 0, 0], "translate": [0, 5, 0.5]}, "motion": [{"t": 0, "translate": [0, -4.5, 0]}]}])");
    EXPECT_NE(message.find("intersect at the start"), std::string::npos) << message;
}

TEST_F(BuildModel, RefusesMoreLevelsBySubdivisionThanMemoryHolds) {
    const auto with = [](int levels) {
        return R"("bodies": [{"mesh": "square.obj"}], "hierarchy": {"source": "loop", "levels": )" +
               std::to_string(levels) + "}";
    };
    EXPECT_EQ(refusal(with(12)), "");
    EXPECT_EQ(build(with(12)).mesh.face_count(), 2) << "the model has the mesh as given";
    EXPECT_NE(refusal(with(13)).find("at /hierarchy/levels: the finest level would have 3.36e+07 faces"),
              std::string::npos)
        << refusal(with(13));
}

TEST_F(BuildModel, SaysWhatWasChangedOnTheWay) {
    write_text(folder_.path() / "quad.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 4 3 2\n");
    const Model m = build(R"("bodies": [{"mesh": "quad.obj"}])");
    EXPECT_EQ(m.mesh.face_count(), 2);
    ASSERT_EQ(listener_.messages.size(), 1u);
    EXPECT_NE(listener_.messages[0].find("quad.obj"), std::string::npos);
}

TEST_F(BuildModel, TakesSettingsOver) {
    const Model m = build(R"("name": "n", "bodies": [{"mesh": "square.obj", "rest": "flat-angles", "pressure": 7}],
        "gravity": [1, 2, 3], "contact": {"distance": 0.01, "self": false, "friction": 0.3, "friction_velocity": 0.02,
            "pairs": [{"a": "ground", "b": "body-0", "friction": 0.6}]},
        "obstacles": [{"name": "ground", "mesh": {"generate": "sheet", "size": [9, 9], "cells": [1, 1], "pattern": "regular"},
            "transform": {"translate": [0, -3, 0]}}], "hierarchy": {"levels": 2},
        "solve": {"duration": 4})");
    EXPECT_EQ(m.name, "n");
    EXPECT_TRUE(m.bodies[0].flat_rest_angles);
    EXPECT_EQ(m.bodies[0].pressure.at(1), 7);
    EXPECT_EQ(m.gravity.at(0), Vec3(1, 2, 3));
    EXPECT_EQ(m.contact.distance, 0.01);
    EXPECT_FALSE(m.contact.self);
    EXPECT_EQ(m.contact.friction, 0.3);
    EXPECT_EQ(m.contact.friction_velocity, 0.02);
    ASSERT_EQ(m.contact.pairs.size(), 1u);
    EXPECT_EQ(m.contact.pairs[0].a, 1);
    EXPECT_EQ(m.contact.pairs[0].b, 0);
    EXPECT_EQ(m.contact.pairs[0].friction, 0.6);
    EXPECT_EQ(m.hierarchy.levels, 2);
    EXPECT_EQ(m.solve.duration, 4);
}

} // namespace
} // namespace plisse
