#include <plisse/scene/scene_schema.h>

#include <plisse/scene/json_writer.h>
#include <plisse/scene/material_presets.h>

#include <fmt/core.h>

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

Json object_schema(Json properties, Json required) {
    Json schema = {{"type", "object"}, {"properties", std::move(properties)}};
    if (!required.empty())
        schema["required"] = std::move(required);
    schema["patternProperties"] = {{"^x-", Json::object()}};
    schema["additionalProperties"] = false;
    return schema;
}

Json list_schema(Json items) {
    return {{"type", "array"}, {"items", std::move(items)}};
}

/// A list of exactly these items.
Json tuple_schema(std::initializer_list<Json> items) {
    return {{"type", "array"},
            {"prefixItems", Json(std::vector<Json>(items))},
            {"items", false},
            {"minItems", items.size()}};
}

Json any_of(std::initializer_list<Json> schemas) {
    return {{"anyOf", Json(std::vector<Json>(schemas))}};
}

const char* const later_note = " (for a later version)";

/// A value to choose an overload by, and to take defaults from.
template <typename Value>
const Value& example() {
    static const Value value = [] { return Value(); }();
    return value;
}

/// One overload a type, as in the reader and the writer.
struct TypeSchema {
    static Json of(const double&, const Limits& limits) {
        return {{"type", "number"}, {"minimum", limits.low}, {"maximum", limits.high}};
    }
    static Json of(const int&, const Limits& limits) {
        return {{"type", "integer"}, {"minimum", limits.low}, {"maximum", limits.high}};
    }
    static Json of(const bool&, const Limits&) { return {{"type", "boolean"}}; }
    static Json of(const std::uint64_t&, const Limits&) {
        return {{"type", "integer"}, {"minimum", 0}, {"maximum", std::numeric_limits<int>::max()}};
    }
    static Json of(const std::string&, const Limits&) { return {{"type", "string"}, {"minLength", 1}}; }
    static Json of(const Vec2&, const Limits& limits) { return tuple_schema({of(0.0, limits), of(0.0, limits)}); }
    static Json of(const Vec3&, const Limits& limits) {
        return tuple_schema({of(0.0, limits), of(0.0, limits), of(0.0, limits)});
    }
    static Json of(const std::array<int, 2>&, const Limits& limits) {
        return tuple_schema({of(0, limits), of(0, limits)});
    }
    static Json of(const std::array<bool, 3>&, const Limits&) {
        return {{"type", "string"}, {"pattern", "^(?!.*(.).*\\1)[xyz]+$"}};
    }
    static Json of(const BoxSelection&, const Limits&) { return tuple_schema({of(Vec3(), {}), of(Vec3(), {})}); }
    static Json of(const SphereSelection&, const Limits&) { return tuple_schema({of(Vec3(), {}), of(0.0, positive)}); }
    static Json of(const VertexSelection&, const Limits&) { return list_schema(of(0, not_negative)); }
    static Json of(const LoopSelection&, const Limits&) { return of(0, not_negative); }
    static Json of(const MeshSpec&, const Limits&);
    static Json of(const Material&, const Limits&);
    static Json of(const RestSpec&, const Limits&);
    static Json of(const WarpSpec&, const Limits& limits) {
        Json list = list_schema(of(Vec3(), limits));
        list["minItems"] = 1;
        return any_of({of(Vec3(), limits), std::move(list)});
    }
    static Json of(const MotionSpec&, const Limits&);

    static Json of(const Track<Vec3>&, const Limits& limits) { return track(Vec3(), limits); }
    static Json of(const Track<double>&, const Limits& limits) {
        Json schema = track(0.0, limits);
        for (const char* key : {"gas", "volume"}) {
            Json law = object_schema({{key, of(0.0, positive)}}, {key});
            law["description"] = std::string("of an enclosed volume") + later_note;
            schema["anyOf"].push_back(std::move(law));
        }
        return schema;
    }
    template <typename Value>
    static Json track(const Value& value, const Limits& limits) {
        Json keys = list_schema(tuple_schema({of(0.0, Limits{}), of(value, limits)}));
        keys["minItems"] = 1;
        return any_of({of(value, limits), std::move(keys)});
    }
    template <typename Value>
    static Json of(const std::optional<Value>&, const Limits& limits) {
        return any_of({of(example<Value>(), limits), {{"type", "null"}}});
    }
    template <typename Value>
    static Json of(const std::vector<Value>&, const Limits& limits) {
        return list_schema(of(example<Value>(), limits));
    }
    template <typename Enum>
    requires std::is_enum_v<Enum>
    static Json of(const Enum& value, const Limits&) {
        Json schema;
        for (const auto& choice : choices_of(value).choices)
            schema["enum"].push_back(choice.name);
        for (const std::string& name : choices_of(value).later) {
            schema["enum"].push_back(name);
            schema["$comment"] = "for a later version: " + nlohmann::json(choices_of(value).later).dump();
        }
        return schema;
    }
    template <typename Struct>
    requires std::is_class_v<Struct>
    static Json of(const Struct& value, const Limits&);
};

/// The visitor of scene_fields.h that lists the keys of an object; defaults are those of the object it is shown.
class ObjectSchema {
public:
    template <typename Value>
    void field(const char* key, Value& value, const Limits& limits, const char* doc) {
        Json& schema = add(key, TypeSchema::of(value, limits), doc);
        if (Json preset = ObjectWriter::write(value); preset != "")
            schema["default"] = std::move(preset);
    }
    template <typename Value>
    void field(const char* key, Value& value, const char* doc) {
        field(key, value, Limits{}, doc);
    }
    template <typename Value>
    void field_if(bool, const char* key, Value& value, const Limits& limits, const char* doc) {
        field(key, value, limits, doc);
    }
    template <typename Value>
    void required(const char* key, Value& value, const Limits& limits, const char* doc) {
        add(key, TypeSchema::of(value, limits), doc);
        required_.push_back(key);
    }
    template <typename Value>
    void required(const char* key, Value& value, const char* doc) {
        required(key, value, Limits{}, doc);
    }
    template <typename Value>
    void alternative(const char* key, std::optional<Value>&, const char* doc) {
        add(key, TypeSchema::of(example<Value>(), Limits{}), doc);
        alternatives_.push_back({{"required", {key}}});
    }
    bool lists_what_is_there() const { return false; }
    void check(bool, const char*, const char*, const char*) const {}
    void version(const char* key, const char* doc) {
        add(key, {{"const", 1}}, doc);
        required_.push_back(key);
    }

    Json take() {
        Json schema = object_schema(std::move(properties_), std::move(required_));
        if (!alternatives_.empty())
            schema["oneOf"] = std::move(alternatives_);
        return schema;
    }

private:
    Json& add(const char* key, Json schema, const std::string& doc) {
        schema["description"] = doc;
        return properties_[key] = std::move(schema);
    }

    Json properties_ = Json::object();
    Json required_ = Json::array();
    Json alternatives_ = Json::array();
};

template <typename Struct>
requires std::is_class_v<Struct> Json TypeSchema::of(const Struct& value, const Limits&) {
    Struct copy = value;
    ObjectSchema schema;
    describe(schema, copy);
    return schema.take();
}

Json TypeSchema::of(const MeshSpec&, const Limits&) {
    return {{"$ref", "#/$defs/mesh"}};
}
Json TypeSchema::of(const Material&, const Limits&) {
    return {{"$ref", "#/$defs/material"}};
}

Json TypeSchema::of(const RestSpec&, const Limits&) {
    return any_of({{{"enum", {"as-given", "flat-angles"}}}, object_schema({{"mesh", of(MeshSpec{}, {})}}, {"mesh"})});
}

Json TypeSchema::of(const MotionSpec&, const Limits&) {
    Json frames = object_schema({{"frames", of(std::string(), {})}, {"dt", of(0.0, positive)}}, {"frames", "dt"});
    frames["description"] = std::string("a deforming obstacle") + later_note;
    return any_of({list_schema(of(MotionKeySpec{}, {})), std::move(frames)});
}

Json mesh_schema() {
    Json file = TypeSchema::of(std::string(), {});
    file["description"] = "an OBJ, PLY, STL or OFF file, relative to the scene file";
    Json schema = any_of({std::move(file)});
    for (const auto& choice : choices_of(GeneratorShape{}).choices) {
        GeneratorOptions options;
        options.shape = choice.value;
        Json generator = TypeSchema::of(options, {});
        generator["title"] = choice.name;
        generator["properties"]["generate"]["const"] = choice.name;
        generator["properties"]["generate"].erase("enum");
        schema["anyOf"].push_back(std::move(generator));
    }
    return schema;
}

std::string values_of(const Material& m) {
    const std::string sheet = fmt::format("density {} kg/m^3, thickness {} m", m.density, m.thickness);
    return m.law == MaterialLaw::isotropic
               ? fmt::format("{}, Young's modulus {} Pa, Poisson's ratio {}, bending scale {}", sheet, m.youngs_modulus,
                             m.poisson_ratio, m.bending_scale)
               : sheet + ", for the method rmtr";
}

Json preset_schema(const MaterialPreset& preset) {
    return {{"const", preset.name},
            {"description", fmt::format("{}. Source: {}", values_of(preset.material), preset.source)},
            {"examples", {ObjectWriter::write(preset.material)}}};
}

Json material_schema() {
    Json schema;
    for (const MaterialPreset& preset : material_presets())
        schema["anyOf"].push_back(preset_schema(preset));
    Material values;
    ObjectSchema object;
    describe(object, values);
    schema["anyOf"].push_back(object.take());
    return schema;
}

} // namespace

nlohmann::ordered_json scene_schema() {
    Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                   {"title", "plisse scene"},
                   {"description", "SI units, +y up. Keys that begin with x- are the user's own."}};
    schema.update(TypeSchema::of(Scene{}, {}));
    schema["properties"]["bodies"]["minItems"] = 1;
    schema["$defs"] = {{"mesh", mesh_schema()}, {"material", material_schema()}};
    return schema;
}

} // namespace plisse
