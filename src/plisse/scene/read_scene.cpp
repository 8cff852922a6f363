#include <plisse/scene/read_scene.h>

#include <algorithm>
#include <type_traits>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <plisse/scene/material_presets.h>
#include <plisse/scene/resolve_names.h>
#include <plisse/scene/scene_fields.h>

namespace plisse {

namespace {

using Kind = JsonValue::Kind;

/// Turns values of the file into values of the program, one overload a type. A class, so that all overloads see each
/// other.
struct ValueReader {
    static void read(const JsonCursor& at, double& value, const Limits& limits) { value = at.number(limits); }
    static void read(const JsonCursor& at, int& value, const Limits& limits) { value = at.integer(limits); }
    static void read(const JsonCursor& at, bool& value, const Limits&) { value = at.boolean(); }
    static void read(const JsonCursor& at, Vec3& value, const Limits& limits) { value = at.vector3(limits); }
    static void read(const JsonCursor& at, std::string& value, const Limits&);
    static void read(const JsonCursor& at, std::uint64_t& value, const Limits&);
    static void read(const JsonCursor& at, Vec2& value, const Limits& limits);
    static void read(const JsonCursor& at, std::array<int, 2>& value, const Limits& limits);
    static void read(const JsonCursor& at, std::array<bool, 3>& axes, const Limits&);
    static void read(const JsonCursor& at, MeshSpec& mesh, const Limits&);
    static void read(const JsonCursor& at, Material& material, const Limits&);
    static void read(const JsonCursor& at, RestSpec& rest, const Limits&);
    static void read(const JsonCursor& at, WarpSpec& warp, const Limits&);
    static void read(const JsonCursor& at, BoxSelection& box, const Limits&);
    static void read(const JsonCursor& at, SphereSelection& sphere, const Limits&);
    static void read(const JsonCursor& at, VertexSelection& selection, const Limits&);
    static void read(const JsonCursor& at, LoopSelection& selection, const Limits&);
    static void read(const JsonCursor& at, MotionSpec& motion, const Limits&);
    static void read(const JsonCursor& at, Track<double>& track, const Limits& limits);
    static void read(const JsonCursor& at, Track<Vec3>& track, const Limits& limits);

    template <typename Value>
    static void read(const JsonCursor& at, std::optional<Value>& value, const Limits& limits) {
        if (at.is(Kind::null))
            value.reset();
        else
            read(at, value.emplace(), limits);
    }

    template <typename Value>
    static void read(const JsonCursor& at, std::vector<Value>& list, const Limits& limits) {
        at.expect(Kind::array);
        list.resize(at.value().items.size());
        for (std::size_t i = 0; i < list.size(); ++i)
            read(at.item(i), list[i], limits);
    }

    template <typename Value>
    static void read_keys(const JsonCursor& at, Track<Value>& track, const Limits& limits);

    template <typename Enum>
    requires std::is_enum_v<Enum>
    static void read(const JsonCursor& at, Enum& value, const Limits&);

    template <typename Struct>
    requires std::is_class_v<Struct>
    static void read(const JsonCursor& at, Struct& value, const Limits&);
};

/// The visitor of scene_fields.h that fills a struct from an object of the file.
class ObjectReader {
public:
    explicit ObjectReader(const JsonCursor& at) : at_(at) { at.expect(Kind::object); }

    template <typename Value>
    void field(const char* key, Value& value, const Limits& limits, const char*) {
        if (const JsonMember* member = find(key))
            ValueReader::read(at_.member(*member), value, limits);
    }
    template <typename Value>
    void field(const char* key, Value& value, const char* doc) {
        field(key, value, Limits{}, doc);
    }
    template <typename Value>
    void field_if(bool applies, const char* key, Value& value, const Limits& limits, const char* doc) {
        field(key, value, limits, doc);
        if (const JsonMember* member = find(key); member && !applies)
            at_.member(*member).fail("this key means nothing here", fmt::format("leave it out: it is {}", doc));
    }
    template <typename Value>
    void required(const char* key, Value& value, const Limits& limits, const char* doc) {
        if (!find(key))
            fail_missing(key, doc);
        field(key, value, limits, doc);
    }
    template <typename Value>
    void required(const char* key, Value& value, const char* doc) {
        required(key, value, Limits{}, doc);
    }
    template <typename Value>
    void alternative(const char* key, std::optional<Value>& value, const char* doc) {
        if (find(key))
            field(key, value.emplace(), doc);
    }
    bool lists_what_is_there() const { return false; }
    void check(bool holds, const char* key, const std::string& wrong, const std::string& right) const {
        if (holds)
            return;
        const JsonMember* member = at_.value().find(key);
        member ? at_.member(*member).fail(wrong, right) : at_.fail(wrong, right);
    }
    void version(const char* key, const char* doc) {
        double version = 0;
        required(key, version, doc);
        check(version == 1, key, fmt::format("format version {} is not known", version), "give 1");
    }

    /// Fails for a member that no call has named.
    void finish() const {
        for (const JsonMember& member : at_.value().members)
            if (!member.key.starts_with("x-") && std::find(known_.begin(), known_.end(), member.key) == known_.end())
                fail_unknown(member, nearest_name(member.key, known_));
    }

private:
    [[noreturn]] void fail_unknown(const JsonMember& member, const std::string& nearest) const {
        at_.member(member).fail(fmt::format("unknown key \"{}\"", member.key),
                                fmt::format("the nearest known key is \"{}\"", nearest));
    }
    [[noreturn]] void fail_missing(const char* key, const char* doc) const {
        for (const JsonMember& member : at_.value().members)
            if (looks_like(member.key, key))
                fail_unknown(member, key);
        at_.fail(fmt::format("the key \"{}\" is missing", key), fmt::format("give it: {}", doc));
    }
    const JsonMember* find(const char* key) {
        if (std::find(known_.begin(), known_.end(), key) == known_.end())
            known_.emplace_back(key);
        return at_.value().find(key);
    }

    const JsonCursor& at_;
    std::vector<std::string> known_;
};

template <typename Struct>
requires std::is_class_v<Struct>
void ValueReader::read(const JsonCursor& at, Struct& value, const Limits&) {
    ObjectReader reader(at);
    describe(reader, value);
    reader.finish();
}

template <typename Enum>
requires std::is_enum_v<Enum>
void ValueReader::read(const JsonCursor& at, Enum& value, const Limits&) {
    const Choices<Enum>& all = choices_of(Enum{});
    const std::string& name = at.string();
    std::vector<std::string> names;
    for (const auto& choice : all.choices) {
        names.push_back(choice.name);
        if (choice.name == name) {
            value = choice.value;
            return;
        }
    }
    if (std::find(all.later.begin(), all.later.end(), name) != all.later.end())
        at.fail_later(fmt::format("\"{}\"", name), fmt::format("take one of {}", fmt::join(names, ", ")));
    at.fail(fmt::format("\"{}\" is not one of {}", name, fmt::join(names, ", ")),
            fmt::format("the nearest is \"{}\"", nearest_name(name, names)));
}

void ValueReader::read(const JsonCursor& at, std::string& value, const Limits&) {
    value = at.string();
    if (value.empty() || value.find('\0') != std::string::npos)
        at.fail("the text is empty or holds a zero byte", "give a name");
}

void ValueReader::read(const JsonCursor& at, std::uint64_t& value, const Limits&) {
    value = static_cast<std::uint64_t>(at.integer(not_negative));
}

void ValueReader::read(const JsonCursor& at, Vec2& value, const Limits& limits) {
    at.expect_items(2);
    value = {at.item(0).number(limits), at.item(1).number(limits)};
}

void ValueReader::read(const JsonCursor& at, std::array<int, 2>& value, const Limits& limits) {
    at.expect_items(2);
    value = {at.item(0).integer(limits), at.item(1).integer(limits)};
}

void ValueReader::read(const JsonCursor& at, std::array<bool, 3>& axes, const Limits&) {
    axes = {false, false, false};
    for (char c : at.string()) {
        if (c < 'x' || c > 'z' || axes[static_cast<std::size_t>(c - 'x')])
            at.fail(fmt::format("\"{}\" does not name axes", at.string()), "give some of x, y, z, each once");
        axes[static_cast<std::size_t>(c - 'x')] = true;
    }
    if (at.string().empty())
        at.fail("no axis is named", "give some of x, y, z");
}

void ValueReader::read(const JsonCursor& at, MeshSpec& mesh, const Limits& limits) {
    mesh = {};
    if (at.is(Kind::string))
        return read(at, mesh.file, limits);
    if (!at.is(Kind::object))
        at.fail(fmt::format("expected a mesh file or a generator, found {}", json_kind_name(at.value().kind)),
                "give a file name, or an object such as {\"generate\": \"sphere\", \"radius\": 0.2}");
    read(at, mesh.generator, limits);
}

void ValueReader::read(const JsonCursor& at, Material& material, const Limits&) {
    if (!at.is(Kind::string)) {
        ObjectReader reader(at);
        describe(reader, material);
        return reader.finish();
    }
    const std::string& name = at.string();
    if (const MaterialPreset* preset = find_material_preset(name)) {
        material = preset->material;
        return;
    }
    std::vector<std::string> names;
    for (const MaterialPreset& preset : material_presets())
        names.push_back(preset.name);
    at.fail(fmt::format("\"{}\" is not one of {}", name, fmt::join(names, ", ")),
            fmt::format("the nearest is \"{}\"; an object gives the values themselves", nearest_name(name, names)));
}

void ValueReader::read(const JsonCursor& at, RestSpec& rest, const Limits& limits) {
    rest = {};
    if (at.is(Kind::object)) {
        rest.kind = RestSpec::Kind::mesh;
        ObjectReader reader(at);
        reader.required("mesh", rest.mesh, "the rest mesh");
        return reader.finish();
    }
    std::string name;
    read(at, name, limits);
    if (name != "as-given" && name != "flat-angles")
        at.fail(fmt::format("\"{}\" is not a rest shape", name),
                "give \"as-given\", \"flat-angles\" or {\"mesh\": ...}");
    rest.kind = name == "as-given" ? RestSpec::Kind::as_given : RestSpec::Kind::flat_angles;
}

void ValueReader::read(const JsonCursor& at, WarpSpec& warp, const Limits& limits) {
    const bool is_list = at.is(Kind::array) && !at.value().items.empty() && at.item(0).is(Kind::array);
    if (is_list)
        read(at, warp.directions, limits);
    else
        warp.directions = {at.vector3(limits)};
}

void ValueReader::read(const JsonCursor& at, BoxSelection& box, const Limits&) {
    at.expect_items(2);
    box = {at.item(0).vector3(), at.item(1).vector3()};
    if ((box.low.array() > box.high.array()).any())
        at.fail("the first corner is not the lowest", "give the lowest corner, then the highest");
}

void ValueReader::read(const JsonCursor& at, SphereSelection& sphere, const Limits&) {
    at.expect_items(2);
    sphere = {at.item(0).vector3(), at.item(1).number(positive)};
}

void ValueReader::read(const JsonCursor& at, VertexSelection& selection, const Limits&) {
    read(at, selection.vertices, not_negative);
}

void ValueReader::read(const JsonCursor& at, LoopSelection& selection, const Limits&) {
    read(at, selection.loop, not_negative);
}

void ValueReader::read(const JsonCursor& at, MotionSpec& motion, const Limits& limits) {
    if (at.is(Kind::object))
        at.fail_later("a deforming obstacle (frames)", "give keyframes of a rigid motion");
    at.expect(Kind::array);
    motion.clear();
    for (std::size_t i = 0; i < at.value().items.size(); ++i) {
        const JsonCursor item = at.item(i);
        read(item, motion.emplace_back(), limits);
        if (i > 0 && motion[i].t <= motion[i - 1].t)
            item.fail("its time is not after the one before", "give keyframes in ascending order of t");
    }
}

template <typename Value>
void ValueReader::read_keys(const JsonCursor& at, Track<Value>& track, const Limits& limits) {
    at.expect(Kind::array);
    if (at.value().items.empty())
        at.fail("there is no keyframe", "give at least one [t, value]");
    track.keys.clear();
    for (std::size_t i = 0; i < at.value().items.size(); ++i) {
        const JsonCursor item = at.item(i);
        item.expect_items(2);
        auto& key = track.keys.emplace_back();
        read(item.item(0), key.t, Limits{});
        read(item.item(1), key.value, limits);
        if (i > 0 && key.t <= track.keys[i - 1].t)
            item.fail("its time is not after the one before", "give keyframes in ascending order of t");
    }
}

void ValueReader::read(const JsonCursor& at, Track<double>& track, const Limits& limits) {
    if (at.is(Kind::object))
        at.fail_later("a gas law or a prescribed volume", "give a number or keyframes");
    if (at.is(Kind::array))
        return read_keys(at, track, limits);
    track = Track<double>(at.number(limits));
}

void ValueReader::read(const JsonCursor& at, Track<Vec3>& track, const Limits& limits) {
    at.expect(Kind::array);
    if (!at.value().items.empty() && at.item(0).is(Kind::array))
        return read_keys(at, track, limits);
    track = Track<Vec3>(at.vector3(limits));
}

} // namespace

Scene parse_scene(const std::string& file, std::string_view text, const std::filesystem::path& folder) {
    Scene scene;
    scene.folder = folder;
    scene.document = std::make_shared<const JsonDocument>(parse_json(file, text));
    ValueReader::read(JsonCursor(*scene.document), scene, Limits{});
    if (scene.bodies.empty())
        throw scene.error_at("/bodies", "there is no body", "give at least one");
    if (scene.solve.level.value_or(0) >= scene.hierarchy.levels)
        throw scene.error_at("/solve/level", fmt::format("there is no level {}", *scene.solve.level),
                             fmt::format("give a level from 0 to {}", scene.hierarchy.levels - 1));
    if (scene.name.empty())
        scene.name = std::filesystem::path(file).stem().string();
    resolve_names(scene);
    return scene;
}

Scene read_scene(const std::filesystem::path& path) {
    return parse_scene(path.string(), read_bytes(path), path.parent_path());
}

} // namespace plisse
