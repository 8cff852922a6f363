#pragma once

#include <type_traits>

#include <nlohmann/json.hpp>

#include <plisse/scene/scene_fields.h>

namespace plisse {

/// The visitor of scene_fields.h that writes every key of a struct into a JSON object.
class ObjectWriter {
public:
    using Json = nlohmann::ordered_json;

    template <typename Value>
    void field(const char* key, Value& value, const Limits&, const char*) {
        json_[key] = write(value);
    }
    template <typename Value>
    void field(const char* key, Value& value, const char*) {
        json_[key] = write(value);
    }
    template <typename Value>
    void field_if(bool applies, const char* key, Value& value, const Limits&, const char*) {
        if (applies)
            json_[key] = write(value);
    }
    template <typename Value>
    void required(const char* key, Value& value, const Limits&, const char*) {
        json_[key] = write(value);
    }
    template <typename Value>
    void required(const char* key, Value& value, const char*) {
        json_[key] = write(value);
    }
    template <typename Value>
    void alternative(const char* key, std::optional<Value>& value, const char*) {
        if (value)
            json_[key] = write(*value);
    }
    bool lists_what_is_there() const { return true; }
    void check(bool, const char*, const char*, const char*) const {}
    void version(const char* key, const char*) { json_[key] = 1; }

    Json take() { return std::move(json_); }

    static Json write(double value) { return value; }
    static Json write(int value) { return value; }
    static Json write(bool value) { return value; }
    static Json write(std::uint64_t value) { return value; }
    static Json write(const std::string& value) { return value; }
    static Json write(const Vec2& value) { return {value.x(), value.y()}; }
    static Json write(const Vec3& value) { return {value.x(), value.y(), value.z()}; }
    static Json write(const std::array<int, 2>& value) { return {value[0], value[1]}; }
    static Json write(const std::array<bool, 3>& axes);
    static Json write(const BoxSelection& box) { return {write(box.low), write(box.high)}; }
    static Json write(const SphereSelection& sphere) { return {write(sphere.center), sphere.radius}; }
    static Json write(const VertexSelection& selection) { return selection.vertices; }
    static Json write(const LoopSelection& selection) { return selection.loop; }
    static Json write(const MeshSpec& mesh) { return mesh.is_file() ? Json(mesh.file) : write(mesh.generator); }
    static Json write(const RestSpec& rest);
    static Json write(const WarpSpec& warp) {
        return warp.directions.size() == 1 ? write(warp.directions.front()) : write(warp.directions);
    }

    template <typename Value>
    static Json write(const std::optional<Value>& value) {
        return value ? write(*value) : Json(nullptr);
    }
    template <typename Value>
    static Json write(const std::vector<Value>& list) {
        Json json = Json::array();
        for (const Value& value : list)
            json.push_back(write(value));
        return json;
    }
    template <typename Value>
    static Json write(const Track<Value>& track) {
        if (track.keys.size() == 1)
            return write(track.keys.front().value);
        Json json = Json::array();
        for (const auto& key : track.keys)
            json.push_back({key.t, write(key.value)});
        return json;
    }
    template <typename Enum>
    requires std::is_enum_v<Enum>
    static Json write(const Enum& value) {
        for (const auto& choice : choices_of(value).choices)
            if (choice.value == value)
                return choice.name;
        return nullptr;
    }
    template <typename Struct>
    requires std::is_class_v<Struct>
    static Json write(const Struct& value) {
        Struct copy = value; // visitors take fields by reference, for the reader's sake
        ObjectWriter writer;
        describe(writer, copy);
        return writer.take();
    }

private:
    Json json_ = Json::object();
};

} // namespace plisse
