#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// A piece of a file fit for a message: in quotes, shortened, unprintable bytes replaced.
std::string in_quotes(std::string_view text);

/// Walks a text line by line, split into words, and knows the place for messages. Lines end in LF or CRLF; a byte order
/// mark at the very start is passed over.
class TextLines {
public:
    enum class Continuation { none, backslash };

    /// comment: from this character to the end of the line nothing counts; 0 for none. lines_before: of the file, where
    /// the text is only its end.
    TextLines(std::string_view text, std::string file, char comment, Continuation continuation = Continuation::none,
              int lines_before = 0);

    /// Steps to the next line that holds a word; false at the end of the text.
    bool next();

    /// The words of the current line, at least one.
    std::span<const std::string_view> words() const { return words_; }
    /// Bytes after the current line.
    std::size_t remaining() const { return text_.size() - position_; }
    std::size_t position() const { return position_; }

    std::string place() const { return file_ + ":" + std::to_string(line_); }
    int line() const { return line_; }
    [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;

    /// Word number `word` as a number (any decimal, also inf and nan) or an integer; throws InputError naming `what`.
    double number(std::size_t word, const char* what) const;
    long long integer(std::size_t word, const char* what) const;
    /// Words first to first + 2 as finite coordinates.
    Vec3 point(std::size_t first) const;

private:
    void take_line();

    std::string_view text_;
    std::string file_;
    char comment_;
    Continuation continuation_;
    std::size_t position_ = 0;
    int line_;
    std::vector<std::string_view> words_;
};

/// The whole of `word` as a decimal number or integer; false when it is anything else.
bool parse_number(std::string_view word, double& value);
bool parse_integer(std::string_view word, long long& value);

} // namespace plisse
