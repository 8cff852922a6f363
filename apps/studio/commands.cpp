#include "commands.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <span>

namespace plisse::studio {

namespace {

using nlohmann::json;

constexpr int deepest = 64; ///< as in scene files; code that walks a value calls itself as often
constexpr std::size_t most_edits = 1000;
constexpr std::size_t longest_pointer = 1000;
constexpr double farthest = 1e6; ///< m, of a place that something is pulled to

/// Caught by parse_command.
struct Refused {
    std::string message;
};

/// For a sentence: in quotes, and not longer than a sentence can take.
std::string in_quotes(const std::string& text) {
    constexpr std::size_t longest = 60;
    if (text.size() <= longest)
        return "\"" + text + "\"";
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
        --end; // not within a character
    return "\"" + text.substr(0, end) + "...\"";
}

/// Every "~" begins "~0" or "~1", and the whole begins with "/".
bool is_pointer(std::string_view text) {
    if (!text.starts_with('/') || text.size() > longest_pointer)
        return false;
    for (std::size_t i = text.find('~'); i != std::string_view::npos; i = text.find('~', i + 1))
        if (i + 1 == text.size() || (text[i + 1] != '0' && text[i + 1] != '1'))
            return false;
    return true;
}

template <typename Value>
struct Word {
    const char* word;
    Value value;
};

/// The fields of one object. Each is asked for by name; expect_no_more refuses what nobody asked for.
class Fields {
public:
    Fields(const json& object, std::string whose) : object_(object), whose_(std::move(whose)) {
        if (!object.is_object())
            throw Refused{whose_ + " must be an object"};
    }

    bool has(const char* name) const { return object_.contains(name); }

    const json& field(const char* name) {
        const auto found = object_.find(name);
        if (found == object_.end())
            throw Refused{whose_ + " needs " + in_quotes(name)};
        asked_.insert(name);
        return *found;
    }

    std::string string(const char* name) {
        const json& value = field(name);
        if (!value.is_string())
            wrong(name, "a string");
        return value.get<std::string>();
    }

    std::string plain_name(const char* name) {
        std::string text = string(name);
        if (!is_plain_name(text))
            wrong(name, "a name of 1 to 64 letters, digits, dots, hyphens and underscores that begins with a letter, "
                        "digit or underscore");
        return text;
    }

    bool boolean(const char* name) {
        const json& value = field(name);
        if (!value.is_boolean())
            wrong(name, "true or false");
        return value.get<bool>();
    }

    int index(const char* name) {
        const json& value = field(name);
        constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
        if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most)
            wrong(name, "a whole number, at least 0");
        return static_cast<int>(value.get<std::uint64_t>());
    }

    Vec3 place(const char* name) {
        const json& value = field(name);
        const auto is_coordinate = [](const json& item) {
            return item.is_number() && std::abs(item.get<double>()) <= farthest;
        };
        if (!value.is_array() || value.size() != 3 || !std::all_of(value.begin(), value.end(), is_coordinate))
            wrong(name, "a list of three numbers in metres");
        return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
    }

    template <typename Value>
    Value word(const char* name, std::span<const Word<Value>> words) {
        const std::string text = string(name);
        std::string all;
        for (const Word<Value>& candidate : words) {
            if (text == candidate.word)
                return candidate.value;
            all += (all.empty() ? "" : ", ") + std::string(candidate.word);
        }
        wrong(name, "one of " + all);
    }

    void expect_no_more() const {
        for (const auto& member : object_.items())
            if (!asked_.contains(member.key()))
                throw Refused{whose_ + " has no field " + in_quotes(member.key())};
    }

private:
    [[noreturn]] void wrong(const char* name, const std::string& right) const {
        throw Refused{"the field " + in_quotes(name) + " of " + whose_ + " must be " + right};
    }

    const json& object_;
    std::string whose_;
    std::set<std::string> asked_;
};

OpenScene read_open(Fields& fields) {
    if (fields.has("file"))
        return {"", fields.plain_name("file")};
    return {fields.plain_name("gallery"), ""};
}

SetValues read_set(Fields& fields) {
    SetValues set;
    if (fields.has("gesture"))
        set.gesture = fields.plain_name("gesture");
    const json& edits = fields.field("edits");
    if (!edits.is_array() || edits.empty() || edits.size() > most_edits)
        throw Refused{"\"edits\" must be a list of 1 to " + std::to_string(most_edits) + " edits"};
    for (const json& item : edits) {
        Fields edit(item, "an edit");
        std::string pointer = edit.string("set");
        if (!is_pointer(pointer))
            throw Refused{in_quotes(pointer) + " is no JSON pointer; one reads like /bodies/0/pressure"};
        set.edits.push_back({std::move(pointer), edit.field("value")});
        edit.expect_no_more();
    }
    return set;
}

Grab read_grab(Fields& fields) {
    return {fields.plain_name("id"), fields.index("vertex"), fields.place("to")};
}

Refine read_refine(Fields& fields) {
    constexpr Word<bool> targets[] = {{"next", false}, {"finest", true}};
    return {fields.word<bool>("to", targets)};
}

Show read_show(Fields& fields) {
    constexpr Word<ShownColor> colors[] = {{"none", ShownColor::none},
                                           {"stretch", ShownColor::stretch},
                                           {"curvature", ShownColor::curvature},
                                           {"gap", ShownColor::gap},
                                           {"level", ShownColor::level}};
    return {fields.boolean("detail"), fields.word<ShownColor>("color", colors)};
}

ShowFrame read_frame(Fields& fields) {
    if (fields.has("index") && fields.field("index").is_null())
        return {};
    return {fields.index("index")};
}

Export read_export(Fields& fields) {
    constexpr Word<AnimationFormat> formats[] = {{"obj", AnimationFormat::obj},   {"ply", AnimationFormat::ply},
                                                 {"gltf", AnimationFormat::gltf}, {"usd", AnimationFormat::usd},
                                                 {"pvd", AnimationFormat::pvd},   {"pc2", AnimationFormat::pc2}};
    constexpr Word<bool> extents[] = {{"animation", true}, {"state", false}};
    Export result;
    result.format = fields.word<AnimationFormat>("format", formats);
    if (fields.has("what"))
        result.animation = fields.word<bool>("what", extents);
    return result;
}

template <typename Plain>
Command read_plain(Fields&) {
    return Plain{};
}

using Reader = std::function<Command(Fields&)>;

const std::map<std::string, Reader, std::less<>>& readers() {
    static const std::map<std::string, Reader, std::less<>> all = {
        {"open", read_open},
        {"play", read_plain<Play>},
        {"pause", read_plain<Pause>},
        {"step", read_plain<Step>},
        {"set", read_set},
        {"grab", read_grab},
        {"release", [](Fields& fields) { return Release{fields.plain_name("id")}; }},
        {"pin", [](Fields& fields) { return Pin{fields.plain_name("id")}; }},
        {"undo", read_plain<Undo>},
        {"redo", read_plain<Redo>},
        {"refine", read_refine},
        {"stop", read_plain<Stop>},
        {"preview", read_plain<Preview>},
        {"restart", read_plain<Restart>},
        {"show", read_show},
        {"frame", read_frame},
        {"save", [](Fields& fields) { return Save{fields.plain_name("name")}; }},
        {"export", read_export},
    };
    return all;
}

json parse_json_text(std::string_view text) {
    bool too_deep = false;
    const auto watch_depth = [&](int depth, json::parse_event_t, json&) {
        too_deep = too_deep || depth > deepest;
        return !too_deep;
    };
    json value = json::parse(text, watch_depth, false);
    if (too_deep)
        throw Refused{"the message is nested deeper than " + std::to_string(deepest) + " values"};
    if (value.is_discarded())
        throw Refused{"the message is not JSON"};
    return value;
}

Command read_command(const json& message, std::string& type) {
    Fields fields(message, "the message");
    type = fields.string("type");
    const auto reader = readers().find(type);
    if (reader == readers().end())
        throw Refused{"there is no message of type " + in_quotes(type)};
    Command command = reader->second(fields);
    fields.expect_no_more();
    return command;
}

} // namespace

std::variant<Command, NotACommand> parse_command(std::string_view text) {
    std::string type;
    try {
        return read_command(parse_json_text(text), type);
    } catch (const Refused& refused) {
        return NotACommand{refused.message, type.size() <= 64 ? type : ""};
    }
}

std::string error_message(const NotACommand& refused) {
    const json message = {{"type", "error"}, {"message", refused.message}, {"in_answer_to", refused.in_answer_to}};
    return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

bool is_plain_name(std::string_view name) {
    const auto is_plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' ||
               c == '-';
    };
    return !name.empty() && name.size() <= 64 && name[0] != '.' && name[0] != '-' &&
           std::all_of(name.begin(), name.end(), is_plain);
}

} // namespace plisse::studio
