#include <plisse/scene/json_cursor.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/core.h>

namespace plisse {

namespace {

std::string escaped(const std::string& key) {
    std::string token;
    for (char c : key)
        token += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return token;
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({replace, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

} // namespace

std::string Limits::text() const {
    const bool from = low > Limits{}.low;
    const bool to = high < Limits{}.high;
    if (from && to)
        return fmt::format("between {} and {}", low, high);
    if (from)
        return fmt::format("of at least {}", low);
    return to ? fmt::format("of at most {}", high) : fmt::format("of at most {} either way", high);
}

std::string JsonCursor::pointer() const {
    if (!parent_)
        return "";
    return parent_->pointer() + "/" + (key_ ? escaped(*key_) : std::to_string(index_));
}

void JsonCursor::fail(const std::string& what_is_wrong, const std::string& what_would_be_right) const {
    throw document_.error_at(pointer(), what_is_wrong, what_would_be_right);
}

void JsonCursor::fail_later(const std::string& what, const std::string& instead) const {
    fail(what + " is not supported in this version", instead);
}

void JsonCursor::expect(JsonValue::Kind kind) const {
    if (!is(kind))
        fail(fmt::format("expected {}, found {}", json_kind_name(kind), json_kind_name(value_.kind)),
             fmt::format("give {}", json_kind_name(kind)));
}

void JsonCursor::expect_items(std::size_t count) const {
    expect(JsonValue::Kind::array);
    if (value_.items.size() != count)
        fail(fmt::format("expected {} items, found {}", count, value_.items.size()),
             fmt::format("give a list of {}", count));
}

double JsonCursor::number(const Limits& limits) const {
    expect(JsonValue::Kind::number);
    if (!(value_.number >= limits.low && value_.number <= limits.high))
        fail(fmt::format("{} is out of range", value_.number), fmt::format("give a number {}", limits.text()));
    return value_.number;
}

int JsonCursor::integer(const Limits& limits) const {
    expect(JsonValue::Kind::number);
    const double low = std::max(limits.low, static_cast<double>(std::numeric_limits<int>::min()));
    const double high = std::min(limits.high, static_cast<double>(std::numeric_limits<int>::max()));
    if (value_.number != std::floor(value_.number))
        fail(fmt::format("{} is not a whole number", value_.number), "give a whole number");
    return static_cast<int>(number({low, high}));
}

bool JsonCursor::boolean() const {
    expect(JsonValue::Kind::boolean);
    return value_.boolean;
}

const std::string& JsonCursor::string() const {
    expect(JsonValue::Kind::string);
    return value_.text;
}

Vec3 JsonCursor::vector3(const Limits& limits) const {
    expect_items(3);
    return {item(0).number(limits), item(1).number(limits), item(2).number(limits)};
}

bool looks_like(const std::string& word, const std::string& name) {
    return 3 * edit_distance(word, name) <= name.size();
}

std::string nearest_name(const std::string& word, std::span<const std::string> names) {
    return *std::min_element(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
        return edit_distance(word, a) < edit_distance(word, b);
    });
}

} // namespace plisse
