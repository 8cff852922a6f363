#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <plisse/scene/material_presets.h>
#include <plisse/scene/read_scene.h>
#include <plisse/scene/scene_schema.h>
#include <plisse/scene/write_scene.h>

namespace plisse {
namespace {

using Json = nlohmann::ordered_json;

/// Follows a reference into $defs.
const Json& resolved(const Json& root, const Json& schema) {
    return schema.contains("$ref") ? root.at(Json::json_pointer(schema["$ref"].get<std::string>().substr(1))) : schema;
}

/// Validates by the few words of JSON Schema that scene_schema() uses.
bool accepts(const Json& root, const Json& given, const Json& value);

bool accepts_object(const Json& root, const Json& schema, const Json& value) {
    for (const auto& key : schema.value("required", Json::array()))
        if (!value.contains(key.get<std::string>()))
            return false;
    for (const auto& [key, member] : value.items()) {
        if (key.starts_with("x-"))
            continue;
        if (!schema["properties"].contains(key) || !accepts(root, schema["properties"][key], member))
            return false;
    }
    return true;
}

bool accepts_array(const Json& root, const Json& schema, const Json& value) {
    if (value.size() < schema.value("minItems", std::size_t{0}))
        return false;
    const Json prefix = schema.value("prefixItems", Json::array());
    if (schema["items"] == false && value.size() > prefix.size())
        return false;
    for (std::size_t i = 0; i < value.size(); ++i)
        if (!accepts(root, i < prefix.size() ? prefix[i] : schema["items"], value[i]))
            return false;
    return true;
}

int accepting(const Json& root, const Json& schemas, const Json& value) {
    int count = 0;
    for (const Json& schema : schemas)
        count += accepts(root, schema, value) ? 1 : 0;
    return count;
}

bool has_type(const Json& value, const std::string& type) {
    return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
           (type == "string" && value.is_string()) || (type == "boolean" && value.is_boolean()) ||
           (type == "null" && value.is_null()) || (type == "number" && value.is_number()) ||
           (type == "integer" && value.is_number_integer());
}

bool accepts(const Json& root, const Json& given, const Json& value) {
    const Json& schema = resolved(root, given);
    if (schema.contains("const") && value != schema["const"])
        return false;
    if (schema.contains("enum") &&
        std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
        return false;
    if (schema.contains("anyOf") && accepting(root, schema["anyOf"], value) == 0)
        return false;
    if (schema.contains("type")) {
        const Json types = schema["type"].is_array() ? schema["type"] : Json::array({schema["type"]});
        if (std::none_of(types.begin(), types.end(), [&](const Json& type) { return has_type(value, type); }))
            return false;
    }
    if (value.is_number() && (value < schema.value("minimum", -1e300) || value > schema.value("maximum", 1e300)))
        return false;
    if (value.is_string() && value.get<std::string>().size() < schema.value("minLength", std::size_t{0}))
        return false;
    if (value.is_object() && schema.contains("properties") && !accepts_object(root, schema, value))
        return false;
    return !value.is_array() || !schema.contains("items") || accepts_array(root, schema, value);
}

std::set<std::string> keys_of(const Json& object) {
    std::set<std::string> keys;
    for (const auto& [key, value] : object.items())
        keys.insert(key);
    return keys;
}

TEST(Schema, ListsEveryKeyOfTheContract) {
    const Json schema = scene_schema();
    const Json& properties = schema["properties"];
    using Set = std::set<std::string>;
    EXPECT_EQ(keys_of(properties), (Set{"plisse", "name", "bodies", "obstacles", "handles", "loads", "pulls", "gravity",
                                        "contact", "hierarchy", "solve", "edits"}));
    EXPECT_EQ(keys_of(properties["pulls"]["items"]["properties"]), (Set{"name", "body", "stiffness", "points"}));
    EXPECT_EQ(keys_of(properties["bodies"]["items"]["properties"]),
              (Set{"name", "mesh", "transform", "material", "pressure", "rest", "start", "warp"}));
    EXPECT_EQ(keys_of(properties["obstacles"]["items"]["properties"]),
              (Set{"name", "mesh", "transform", "motion", "progressive"}));
    EXPECT_EQ(keys_of(properties["handles"]["items"]["properties"]), (Set{"name", "body", "axes", "select", "motion"}));
    EXPECT_EQ(keys_of(properties["loads"]["items"]["properties"]), (Set{"body", "select", "force", "traction"}));
    EXPECT_EQ(keys_of(properties["contact"]["properties"]),
              (Set{"distance", "thickness", "friction", "friction_velocity", "self", "pairs"}));
    EXPECT_EQ(keys_of(properties["hierarchy"]["properties"]),
              (Set{"levels", "coarsest_vertices", "operator", "bending_on", "source"}));
    EXPECT_EQ(keys_of(properties["solve"]["properties"]),
              (Set{"method", "level", "time_step", "duration", "settle", "max_settle_steps", "tolerance",
                   "max_iterations_per_step", "frame_interval", "curvature", "gradient", "dynamics", "rmtr"}));
    EXPECT_EQ(keys_of(schema["$defs"]["material"]["anyOf"].back()["properties"]),
              (Set{"density", "youngs_modulus", "poisson_ratio", "thickness", "bending", "bending_scale",
                   "strain_limit", "law"}));
    EXPECT_EQ(schema["$defs"]["mesh"]["anyOf"].size(), 10u) << "a file and nine generators";
}

TEST(Schema, AcceptsItsOwnDefaults) {
    const Json schema = scene_schema();
    const std::string text = R"({"plisse": 1, "bodies": [{"mesh": {"generate": "torus"}, "material": "silk"}],
        "handles": [{"body": "body-0", "select": {"vertices": [1]}}]})";
    EXPECT_TRUE(accepts(schema, schema, Json::parse(text)));
    Json filled = scene_to_json(parse_scene("scene.json", text, ""));
    EXPECT_TRUE(accepts(schema, schema, filled));
    filled["solve"]["time_step"] = 0;
    EXPECT_FALSE(accepts(schema, schema, filled)) << "out of range";
    filled["solve"]["time_step"] = 0.1;
    filled["solv"] = 1;
    EXPECT_FALSE(accepts(schema, schema, filled)) << "unknown key";
}

TEST(Schema, EveryKeyHasAMeaning) {
    const Json schema = scene_schema();
    const auto check = [](const Json& properties, const auto& self) -> void {
        for (const auto& [key, property] : properties.items()) {
            EXPECT_FALSE(property.value("description", "").empty()) << key;
            if (property.contains("properties"))
                self(property["properties"], self);
        }
    };
    check(schema["properties"], check);
}

TEST(Schema, ShowsPresetsWithTheirSources) {
    const std::string text = scene_schema()["$defs"]["material"].dump();
    for (const MaterialPreset& preset : material_presets())
        EXPECT_NE(text.find(preset.source), std::string::npos) << preset.name;
}

} // namespace
} // namespace plisse
