#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/scene/write_scene.h>
#include <plisse/steer/edited_scene.h>

#include "small_scene.h"

using namespace plisse;

namespace {

using Json = nlohmann::ordered_json;

TEST(EditedScene, ChangesOneValueAndNothingElse) {
    const Scene scene = small_scene();
    Json json = scene_to_json(scene);
    const Scene edited = edited_scene(scene, "/bodies/0/material/youngs_modulus", 2e6);
    EXPECT_EQ(edited.bodies[0].material.youngs_modulus, 2e6);
    json["bodies"][0]["material"]["youngs_modulus"] = 2e6;
    EXPECT_EQ(scene_to_json(edited), json);
    EXPECT_EQ(edited_scene(scene, "/gravity", Json::parse("[[0, [0, 0, 0]], [1, [0, -9, 0]]]")).gravity.keys.size(),
              2u);
}

TEST(EditedScene, RefusesPlacesAndValuesThatAreNone) {
    const Scene scene = small_scene();
    for (const auto& [pointer, value] :
         std::vector<std::pair<std::string, Json>>{{"/gravty", 1},
                                                   {"/bodies/7/pressure", 1},
                                                   {"/bodies/-/pressure", 1},
                                                   {"gravity", 1},
                                                   {"", 1},
                                                   {"/gravity", "down"},
                                                   {"/contact/friction", -1},
                                                   {"/bodies/0/material/poisson_ratio", 0.7},
                                                   {"/name/x", 1},
                                                   {"/bodies/x/pressure", 1},
                                                   {"/handles/0/body", "none"},
                                                   {"/solve/time_step", nullptr}})
        EXPECT_THROW(edited_scene(scene, pointer, value), InputError) << pointer;
}

TEST(EditedScene, KnowsWhatARunCanTakeOver) {
    const Scene scene = small_scene();
    const auto goes_on = [&](const char* pointer, const Json& value) {
        return can_go_on(scene, edited_scene(scene, pointer, value));
    };
    EXPECT_TRUE(goes_on("/gravity", Json::parse("[0, 1, 0]")));
    EXPECT_TRUE(goes_on("/bodies/0/material", "denim"));
    EXPECT_TRUE(goes_on("/pulls", Json::parse(R"([{"body": "cloth", "stiffness": 1, "points": []}])")));
    EXPECT_TRUE(goes_on("/obstacles/0/motion", Json::parse(R"([{"t": 0}, {"t": 1, "translate": [1, 0, 0]}])")));
    EXPECT_FALSE(goes_on("/obstacles/0/motion", Json::parse(R"([{"t": 0, "translate": [1, 0, 0]}])")));
    EXPECT_TRUE(goes_on("/handles/0/motion", Json::parse(R"([{"t": 0, "translate": [1, 0, 0]}])")));
    EXPECT_FALSE(goes_on("/handles/0/axes", "xy"));
    EXPECT_FALSE(goes_on("/hierarchy/levels", 3));
    EXPECT_FALSE(goes_on("/bodies/0/mesh/edge_length", 0.05));
    EXPECT_FALSE(goes_on("/bodies/0/material/strain_limit", 1.2));
    EXPECT_FALSE(goes_on("/bodies/0/transform/scale", 2));
}

} // namespace
