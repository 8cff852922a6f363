#pragma once

#include <limits>
#include <span>

#include <plisse/base/types.h>
#include <plisse/scene/json_document.h>

namespace plisse {

/// Closed range that a number must lie in.
struct Limits {
    double low = -1e15, high = 1e15;

    /// "at least 1", "between 0 and 5" ...
    std::string text() const;
};

/// Positive, and far enough from the ends of the double range that products of a few such numbers stay finite.
inline constexpr Limits positive{1e-9, 1e15};
inline constexpr Limits not_negative{0, 1e15};

/// A value of a document together with the way to it, so that every error names its place. Cursors refer to their
/// parents: keep them on the stack.
class JsonCursor {
public:
    explicit JsonCursor(const JsonDocument& document) : document_(document), value_(document.root) {}
    JsonCursor member(const JsonMember& member) const { return {*this, member.value, &member.key, 0}; }
    JsonCursor item(std::size_t index) const { return {*this, value_.items[index], nullptr, index}; }

    const JsonValue& value() const { return value_; }
    bool is(JsonValue::Kind kind) const { return value_.kind == kind; }
    std::string pointer() const;

    [[noreturn]] void fail(const std::string& what_is_wrong, const std::string& what_would_be_right) const;
    /// For what the format knows but this version does not.
    [[noreturn]] void fail_later(const std::string& what, const std::string& instead) const;

    /// Fails unless the value is of this kind.
    void expect(JsonValue::Kind kind) const;
    /// Fails unless the value is a list of exactly this many items.
    void expect_items(std::size_t count) const;

    double number(const Limits& limits = {}) const;
    int integer(const Limits& limits) const;
    bool boolean() const;
    const std::string& string() const;
    Vec3 vector3(const Limits& limits = {}) const;

private:
    JsonCursor(const JsonCursor& parent, const JsonValue& value, const std::string* key, std::size_t index)
        : document_(parent.document_), value_(value), parent_(&parent), key_(key), index_(index) {}

    const JsonDocument& document_;
    const JsonValue& value_;
    const JsonCursor* parent_ = nullptr;
    const std::string* key_ = nullptr;
    std::size_t index_ = 0;
};

/// Whether `word` is `name` with a mistake or two, in proportion to its length.
bool looks_like(const std::string& word, const std::string& name);

/// The name nearest to `word` by edit distance (Levenshtein); the first of equals. `names` is not empty.
std::string nearest_name(const std::string& word, std::span<const std::string> names);

} // namespace plisse
