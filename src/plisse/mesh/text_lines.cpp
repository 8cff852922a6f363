#include <plisse/mesh/text_lines.h>

#include <charconv>
#include <cmath>

#include <plisse/base/error.h>

namespace plisse {

namespace {

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

std::string_view without_plus(std::string_view word) {
    const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
    return plus ? word.substr(1) : word;
}

} // namespace

std::string in_quotes(std::string_view text) {
    constexpr std::size_t longest = 40;
    std::string result = "'";
    for (char c : text.substr(0, longest))
        result += c >= ' ' && c <= '~' ? c : '?';
    return result + (text.size() > longest ? "...'" : "'");
}

bool parse_number(std::string_view word, double& value) {
    word = without_plus(word);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size())
        return false;
    if (error == std::errc::result_out_of_range) {
        const bool tiny = word.find("e-") != word.npos || word.find("E-") != word.npos;
        value = tiny ? 0.0 : HUGE_VAL;
        return true;
    }
    return error == std::errc();
}

bool parse_integer(std::string_view word, long long& value) {
    word = without_plus(word);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size();
}

TextLines::TextLines(std::string_view text, std::string file, char comment, Continuation continuation, int lines_before)
    : text_(text), file_(std::move(file)), comment_(comment), continuation_(continuation), line_(lines_before) {
    if (text_.starts_with("\xef\xbb\xbf"))
        position_ = 3;
}

bool TextLines::next() {
    words_.clear();
    while (position_ < text_.size()) {
        take_line();
        if (!words_.empty())
            return true;
    }
    return false;
}

void TextLines::take_line() {
    bool continued = true;
    while (continued && position_ < text_.size()) {
        const std::size_t end = std::min(text_.find('\n', position_), text_.size());
        std::string_view line = text_.substr(position_, end - position_);
        position_ = std::min(end + 1, text_.size());
        ++line_;
        if (comment_ != 0)
            line = line.substr(0, line.find(comment_));
        while (!line.empty() && is_space(line.back()))
            line.remove_suffix(1);
        continued = continuation_ == Continuation::backslash && line.ends_with('\\');
        if (continued)
            line.remove_suffix(1);
        for (std::size_t i = 0; i < line.size();) {
            const std::size_t begin = i;
            while (i < line.size() && !is_space(line[i]))
                ++i;
            if (i > begin)
                words_.push_back(line.substr(begin, i - begin));
            else
                ++i;
        }
    }
}

void TextLines::fail(const std::string& what, const std::string& remedy) const {
    throw InputError(place(), what, remedy);
}

double TextLines::number(std::size_t word, const char* what) const {
    if (word >= words_.size())
        fail(std::string("the line ends before ") + what, "write the missing number");
    double value = 0;
    if (!parse_number(words_[word], value))
        fail(in_quotes(words_[word]) + " is no number for " + what, "write a decimal number such as 0.25");
    return value;
}

long long TextLines::integer(std::size_t word, const char* what) const {
    if (word >= words_.size())
        fail(std::string("the line ends before ") + what, "write the missing number");
    long long value = 0;
    if (!parse_integer(words_[word], value))
        fail(in_quotes(words_[word]) + " is no integer for " + what, "write a whole number");
    return value;
}

Vec3 TextLines::point(std::size_t first) const {
    static constexpr const char* names[3] = {"the x coordinate", "the y coordinate", "the z coordinate"};
    Vec3 p;
    for (std::size_t k = 0; k < 3; ++k) {
        const double value = number(first + k, names[k]);
        if (!std::isfinite(value))
            fail(in_quotes(words_[first + k]) + " is not a finite coordinate", "write a decimal number such as 0.25");
        p[static_cast<Eigen::Index>(k)] = value;
    }
    return p;
}

} // namespace plisse
