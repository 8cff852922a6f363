#include <plisse/scene/json_document.h>

#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace plisse {

namespace {

constexpr std::size_t deepest_nesting = 64;

/// Counts how many characters the parser has taken.
class CountingIterator {
public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingIterator(const char* at, std::size_t* taken) : at_(at), taken_(taken) {}
    reference operator*() const { return *at_; }
    CountingIterator& operator++() {
        ++at_;
        ++*taken_;
        return *this;
    }
    CountingIterator operator++(int) {
        CountingIterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
    bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

private:
    const char* at_;
    std::size_t* taken_;
};

/// Walks the text from token to token, keeping line and column.
class TextWalker {
public:
    explicit TextWalker(std::string_view text) : text_(text) {}

    const TextPosition& position() const { return position_; }

    void walk_to(std::size_t offset) {
        for (; offset_ < offset && offset_ < text_.size(); ++offset_)
            if (text_[offset_] == '\n') {
                ++position_.line;
                position_.column = 1;
            } else {
                ++position_.column;
            }
    }

    /// To the first character of the next token.
    void skip_separators() {
        for (std::size_t next = offset_; offset_ < text_.size(); walk_to(next)) {
            const char c = text_[offset_];
            if (text_.substr(offset_, 3) == "\xEF\xBB\xBF")
                next = offset_ + 3;
            else if (text_.substr(offset_, 2) == "//")
                next = std::min(text_.find_first_of("\r\n", offset_), text_.size());
            else if (text_.substr(offset_, 2) == "/*")
                next = std::min(text_.find("*/", offset_ + 2), text_.size() - 2) + 2;
            else if (c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ',' || c == ':')
                next = offset_ + 1;
            else
                return;
        }
    }

private:
    std::string_view text_;
    std::size_t offset_ = 0;
    TextPosition position_;
};

std::string place_of(const std::string& file, const TextPosition& position) {
    return fmt::format("{}:{}:{}", file, position.line, position.column);
}

/// The parser's own sentence without its error number and position, with nothing unprintable and no further ';'.
std::string cleaned(std::string sentence) {
    if (const auto end = sentence.find("] "); end != std::string::npos)
        sentence.erase(0, end + 2);
    if (sentence.starts_with("parse error"))
        if (const auto end = sentence.find(": "); end != std::string::npos)
            sentence.erase(0, end + 2);
    for (char& c : sentence)
        if (c == ';')
            c = ',';
        else if (c < ' ' || c > '~')
            c = '?';
    return sentence;
}

/// Builds the tree from the parser's events. Pointers to open containers stay good: a container's list grows only while
/// none of its children is open.
class TreeBuilder final : public nlohmann::json_sax<nlohmann::json> {
public:
    TreeBuilder(JsonDocument& document, std::string_view text, const std::size_t& taken)
        : document_(document), walker_(text), taken_(taken) {}

    bool null() override { return add(JsonValue::Kind::null), end_token(); }
    bool boolean(bool value) override {
        add(JsonValue::Kind::boolean).boolean = value;
        return end_token();
    }
    bool number_integer(number_integer_t value) override { return add_number(static_cast<double>(value)); }
    bool number_unsigned(number_unsigned_t value) override { return add_number(static_cast<double>(value)); }
    bool number_float(number_float_t value, const string_t&) override { return add_number(value); }
    bool string(string_t& value) override {
        add(JsonValue::Kind::string).text = std::move(value);
        return end_token();
    }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(JsonValue::Kind::object); }
    bool start_array(std::size_t) override { return open(JsonValue::Kind::array); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t& value) override {
        walker_.skip_separators();
        if (open_.back()->find(value))
            throw InputError(place_of(document_.file, walker_.position()),
                             fmt::format("the key \"{}\" appears twice in one object", value), "keep one of the two");
        open_.back()->members.push_back({std::move(value), walker_.position(), {}});
        return end_token();
    }

    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override {
        walker_.walk_to(taken_ > 0 ? taken_ - 1 : 0);
        throw InputError(place_of(document_.file, walker_.position()), "not valid JSON: " + cleaned(error.what()),
                         "correct the text there (// and /* */ comments are allowed, trailing commas are not)");
    }

private:
    JsonValue& add(JsonValue::Kind kind) {
        walker_.skip_separators();
        JsonValue& value = next_slot();
        value.kind = kind;
        value.position = walker_.position();
        return value;
    }
    JsonValue& next_slot() {
        if (open_.empty())
            return document_.root;
        JsonValue& parent = *open_.back();
        return parent.kind == JsonValue::Kind::object ? parent.members.back().value : parent.items.emplace_back();
    }
    bool end_token() {
        walker_.walk_to(taken_);
        return true;
    }
    bool add_number(double number) {
        add(JsonValue::Kind::number).number = number;
        walker_.walk_to(taken_ - 1); // the parser has looked one character past a number
        return true;
    }
    bool open(JsonValue::Kind kind) {
        JsonValue& value = add(kind);
        if (open_.size() >= deepest_nesting)
            throw InputError(place_of(document_.file, value.position),
                             fmt::format("values are nested deeper than {}", deepest_nesting), "nest them less");
        open_.push_back(&value);
        return end_token();
    }
    bool close() {
        open_.pop_back();
        return end_token();
    }

    JsonDocument& document_;
    TextWalker walker_;
    const std::size_t& taken_;
    std::vector<JsonValue*> open_;
};

std::string unescaped(std::string token) {
    for (const auto& [escape, plain] : {std::pair{"~1", "/"}, std::pair{"~0", "~"}})
        for (std::size_t at = token.find(escape); at != std::string::npos; at = token.find(escape, at + 1))
            token.replace(at, 2, plain);
    return token;
}

const JsonValue* child(const JsonValue& value, const std::string& token) {
    if (value.kind == JsonValue::Kind::object) {
        const JsonMember* member = value.find(unescaped(token));
        return member ? &member->value : nullptr;
    }
    if (value.kind == JsonValue::Kind::array && !token.empty() &&
        token.find_first_not_of("0123456789") == std::string::npos && token.size() < 9) {
        const auto index = static_cast<std::size_t>(std::stoi(token));
        return index < value.items.size() ? &value.items[index] : nullptr;
    }
    return nullptr;
}

} // namespace

const JsonMember* JsonValue::find(std::string_view key) const {
    for (const JsonMember& member : members)
        if (member.key == key)
            return &member;
    return nullptr;
}

const char* json_kind_name(JsonValue::Kind kind) {
    switch (kind) {
    case JsonValue::Kind::null:
        return "null";
    case JsonValue::Kind::boolean:
        return "true or false";
    case JsonValue::Kind::number:
        return "a number";
    case JsonValue::Kind::string:
        return "a string";
    case JsonValue::Kind::array:
        return "a list";
    case JsonValue::Kind::object:
        return "an object";
    }
    return "a value";
}

InputError JsonDocument::error_at(const std::string& pointer, const std::string& what_is_wrong,
                                  const std::string& what_would_be_right) const {
    const JsonValue* value = &root;
    for (std::size_t begin = 1; begin <= pointer.size();) {
        const std::size_t end = std::min(pointer.find('/', begin), pointer.size());
        const JsonValue* next = child(*value, pointer.substr(begin, end - begin));
        if (!next)
            break;
        value = next;
        begin = end + 1;
    }
    const std::string at = pointer.empty() ? "" : fmt::format("at {}: ", pointer);
    return {place_of(file, value->position), at + what_is_wrong, what_would_be_right};
}

JsonDocument parse_json(const std::string& file, std::string_view text) {
    JsonDocument document;
    document.file = file;
    std::size_t taken = 0;
    TreeBuilder builder(document, text, taken);
    const char* end = text.data() + text.size();
    nlohmann::json::sax_parse(CountingIterator(text.data(), &taken), CountingIterator(end, &taken), &builder,
                              nlohmann::json::input_format_t::json, true, true);
    return document;
}

JsonDocument read_json(const std::filesystem::path& path) {
    return parse_json(path.string(), read_bytes(path));
}

std::string read_bytes(const std::filesystem::path& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
        throw InputError(path.string(), "this is a folder", "give a file");
    std::ifstream in(path, std::ios::binary);
    if (!in)
        throw InputError(path.string(), "the file cannot be opened", "give a file that exists and can be read");
    std::ostringstream bytes; // many times faster than byte by byte
    bytes << in.rdbuf();
    return std::move(bytes).str();
}

} // namespace plisse
