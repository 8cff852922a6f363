#include <plisse/steer/edit_log.h>

#include <fmt/format.h>

#include <plisse/scene/json_cursor.h>

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const JsonValue& value) {
    switch (value.kind) {
    case JsonValue::Kind::null:
        break;
    case JsonValue::Kind::boolean:
        return value.boolean;
    case JsonValue::Kind::number:
        return value.number;
    case JsonValue::Kind::string:
        return value.text;
    case JsonValue::Kind::array: {
        Json list = Json::array();
        for (const JsonValue& item : value.items)
            list.push_back(to_json(item));
        return list;
    }
    case JsonValue::Kind::object: {
        Json object = Json::object();
        for (const JsonMember& member : value.members)
            object[member.key] = to_json(member.value);
        return object;
    }
    }
    return nullptr;
}

/// The members of one entry of the file.
class EntryReader {
public:
    explicit EntryReader(const JsonCursor& at) : at_(at) { at.expect(JsonValue::Kind::object); }

    Edit read() const {
        Edit edit;
        edit.level = required("level").integer(not_negative);
        edit.step = required("step").integer(not_negative);
        if (const JsonMember* pointer = find("set")) {
            edit.pointer = at_.member(*pointer).string();
            edit.value = to_json(required("value").value());
        } else if (is_true("refine")) {
            edit.kind = Edit::Kind::refine;
        } else if (is_true("end")) {
            edit.kind = Edit::Kind::end;
        } else {
            at_.fail("an edit does nothing", "give `set` and `value`, or `refine`, or `end`");
        }
        expect_known();
        return edit;
    }

private:
    const JsonMember* find(const char* key) const { return at_.value().find(key); }
    JsonCursor required(const char* key) const {
        const JsonMember* member = find(key);
        if (!member)
            at_.fail(fmt::format("the key \"{}\" is missing", key), "give it");
        return at_.member(*member);
    }
    bool is_true(const char* key) const {
        const JsonMember* member = find(key);
        return member && at_.member(*member).boolean();
    }
    void expect_known() const {
        static const std::vector<std::string> known{"level", "step", "set", "value", "refine", "end"};
        for (const JsonMember& member : at_.value().members)
            if (!member.key.starts_with("x-") && std::find(known.begin(), known.end(), member.key) == known.end())
                at_.member(member).fail(
                    fmt::format("unknown key \"{}\"", member.key),
                    fmt::format("the nearest known key is \"{}\"", nearest_name(member.key, known)));
    }

    const JsonCursor& at_;
};

/// Whether an edit may come after another.
bool follows(const Edit& before, const Edit& edit) {
    if (before.kind == Edit::Kind::end)
        return false;
    if (before.kind == Edit::Kind::refine)
        return edit.level == before.level + 1;
    return edit.level == before.level && edit.step >= before.step;
}

} // namespace

EditLog read_edit_log(const std::filesystem::path& path) {
    const JsonDocument document = read_json(path);
    const JsonCursor root(document);
    root.expect(JsonValue::Kind::object);
    const JsonMember* version = root.value().find("plisse-edits");
    if (!version || root.member(*version).number() != 1)
        root.fail("this is not an edit log of version 1", "give an object with \"plisse-edits\": 1 and \"edits\"");
    const JsonMember* edits = root.value().find("edits");
    if (!edits)
        root.fail("the key \"edits\" is missing", "give the list of edits");
    const JsonCursor list = root.member(*edits);
    list.expect(JsonValue::Kind::array);
    EditLog log;
    for (std::size_t i = 0; i < list.value().items.size(); ++i) {
        const JsonCursor item = list.item(i);
        Edit edit = EntryReader(item).read();
        if (log.empty() ? edit.level != 0 : !follows(*log.back(), edit))
            item.fail(fmt::format("level {}, step {} cannot come here", edit.level, edit.step),
                      "begin on level 0, give edits in order, and go to the next level by `refine` alone");
        log.push_back(std::make_shared<const Edit>(std::move(edit)));
    }
    return log;
}

std::string edit_log_text(const EditLog& log) {
    std::string text = "{\"plisse-edits\": 1, \"edits\": [";
    for (std::size_t i = 0; i < log.size(); ++i) {
        Json line = {{"level", log[i]->level}, {"step", log[i]->step}};
        switch (log[i]->kind) {
        case Edit::Kind::set:
            line["set"] = log[i]->pointer;
            line["value"] = log[i]->value;
            break;
        case Edit::Kind::refine:
            line["refine"] = true;
            break;
        case Edit::Kind::end:
            line["end"] = true;
            break;
        }
        text += (i > 0 ? ",\n  " : "\n  ") + line.dump();
    }
    return text + "\n]}\n";
}

} // namespace plisse
