#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <plisse/base/error.h>

namespace plisse {

/// Where a value begins in its file: line and column (in bytes), both from 1.
struct TextPosition {
    int line = 1, column = 1;
};

struct JsonMember;

/// A JSON value that knows where it stands. Members of an object keep the order of the file.
struct JsonValue {
    enum class Kind { null, boolean, number, string, array, object };
    Kind kind = Kind::null;
    bool boolean = false;
    double number = 0;
    std::string text;
    std::vector<JsonValue> items;
    std::vector<JsonMember> members;
    TextPosition position;

    /// The member of an object with this key; null when there is none.
    const JsonMember* find(std::string_view key) const;
};

struct JsonMember {
    std::string key;
    TextPosition position; ///< of the key
    JsonValue value;
};

/// How a kind of value is called in messages: "a number", "an object" ...
const char* json_kind_name(JsonValue::Kind kind);

/// A JSON text, with `//` and `/* */` comments, parsed with the position of every value.
struct JsonDocument {
    std::string file; ///< as messages name it
    JsonValue root;

    /// The error "FILE:LINE:COLUMN: at POINTER: WHAT; REMEDY". The position is that of the value the JSON pointer
    /// names, or of its nearest ancestor in the file.
    InputError error_at(const std::string& pointer, const std::string& what_is_wrong,
                        const std::string& what_would_be_right) const;
};

/// Throws InputError naming file, line and column for a text that is not JSON, repeats a key in an object, is nested
/// deeper than 64 values, or holds a number no double can hold.
JsonDocument parse_json(const std::string& file, std::string_view text);

/// Reads the file, then as parse_json. Throws InputError when it cannot be read.
JsonDocument read_json(const std::filesystem::path& path);

/// The whole file as bytes. Throws InputError when it cannot be read.
std::string read_bytes(const std::filesystem::path& path);

} // namespace plisse
