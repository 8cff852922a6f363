#include <gtest/gtest.h>

#include <plisse/scene/build_subdivision_model.h>
#include <plisse/scene/read_scene.h>

namespace plisse {
namespace {

const std::string sheet = R"("mesh": {"generate": "sheet", "size": [1, 1], "cells": [2, 1], "pattern": "quad"},
                            "material": "denim-stable")";

/// A scene of one sheet of two faces and two levels, with more of its body, and more of the scene.
SubdivisionModel build(const std::string& of_body, const std::string& of_scene = "") {
    Context context;
    const std::string text = R"({"plisse": 1, "bodies": [{"name": "cloth", )" + sheet + of_body +
                             R"(}], "hierarchy": {"levels": 2}, "solve": {"method": "rmtr"})" + of_scene + "}";
    return build_subdivision_model(parse_scene("scene.json", text, "."), context);
}

std::string refusal(const std::string& of_body, const std::string& of_scene = "") {
    try {
        build(of_body, of_scene);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(BuildSubdivisionModel, HasOneWarpForAllFacesOrOneForEach) {
    EXPECT_EQ(build("").warp_on(1), std::vector<Vec3>{Vec3::UnitX()});
    EXPECT_EQ(build(R"(, "warp": [0, 0, 2])").warp_on(1), std::vector<Vec3>{Vec3(0, 0, 2)});
    const SubdivisionModel model = build(R"(, "warp": [[1, 0, 0], [0, 0, 1]])");
    EXPECT_EQ(model.warp_on(0), (std::vector{Vec3(1, 0, 0), Vec3(0, 0, 1)}));
    const std::vector<Vec3> fine = model.warp_on(1);
    ASSERT_EQ(fine.size(), 8u);
    // The parts of the first face are those on its side of the middle.
    const SubdivisionLevels& levels = model.levels;
    const Positions limits = levels.rest(1) * levels.limit_points(1).weights.transpose();
    const Positions corners = levels.rest(0) * levels.limit_points(0).weights.transpose();
    const auto centre = [](const Positions& points, const Quad& quad) {
        double x = 0;
        for (const int v : quad)
            x += points(0, v) / 4;
        return x;
    };
    const double first = centre(corners, levels.mesh(0).faces[0]);
    for (std::size_t f = 0; f < fine.size(); ++f)
        EXPECT_EQ(fine[f] == Vec3(1, 0, 0), centre(limits, levels.mesh(1).faces[f]) * first > 0);
    EXPECT_TRUE(contains(refusal(R"(, "warp": [[1, 0, 0], [0, 0, 1], [1, 0, 0]])"),
                         "at /bodies/0/warp: 3 directions for a mesh of 2 faces; "));
    EXPECT_TRUE(contains(refusal(R"(, "warp": [[1, 0, 0], [0, 0, 0]])"), "at /bodies/0/warp: it has no direction"));
    EXPECT_TRUE(contains(refusal(R"(, "warp": [])"), "/bodies/0/warp"));
}

const std::string ground = R"("obstacles": [{"name": "ground",
    "mesh": {"generate": "sheet", "size": [4, 4], "cells": [1, 1], "pattern": "regular"},
    "transform": {"translate": [0, -0.01, 0]}, "motion": [{"t": 0, "translate": [0, -0.01, 0]}, {"t": 1, "translate": [1, 0, 0]}]}])";

TEST(BuildSubdivisionModel, TakesContactAndMovingObstacles) {
    const SubdivisionModel model = build("", ", " + ground + R"(, "contact": {"friction": 0.3, "thickness": 0.015,
        "pairs": [{"a": "ground", "b": "cloth", "friction": 0.7}]})");
    EXPECT_EQ(model.contact.friction, 0.3);
    EXPECT_EQ(model.contact.thickness, 0.015);
    ASSERT_EQ(model.contact.pairs.size(), 1u);
    EXPECT_EQ(model.contact.pairs[0].a, 1);
    EXPECT_EQ(model.contact.pairs[0].b, 0);
    EXPECT_NEAR(model.obstacles_at(0)(1, 0), -0.02, 1e-15);
    EXPECT_NEAR(model.obstacles_at(0.5)(1, 0), -0.015, 1e-15);
    EXPECT_NEAR(model.obstacles_at(0.5)(0, 0), -1.5, 1e-15);
    EXPECT_TRUE(contains(refusal("", ", " + ground + R"(, "contact": {"thickness": 0.03})"),
                         "at /contact/thickness: the cloth begins nearer to an obstacle than this; "));
}

TEST(BuildSubdivisionModel, RefusesWhatTheMethodCannotDo) {
    EXPECT_TRUE(contains(refusal(R"(, "pressure": 10)"), "at /bodies/0/pressure: "));
    EXPECT_TRUE(contains(refusal(R"(, "rest": "flat-angles")"), "at /bodies/0/rest: "));
    EXPECT_TRUE(contains(refusal("", R"(, "loads": [{"body": "cloth", "force": [1, 0, 0]}])"), "at /loads: "));
    EXPECT_TRUE(
        contains(refusal("", R"(, "handles": [{"body": "cloth", "select": {"boundary_loop": 0}, "axes": "x"}])"),
                 "at /handles/0/axes: "));
}

} // namespace
} // namespace plisse
