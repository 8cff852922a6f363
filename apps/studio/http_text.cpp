#include "http_text.h"

#include <algorithm>

namespace plisse::studio {

namespace {

int hexadecimal_digit(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return -1;
}

bool is_control(char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
}

/// Nothing for a "%" that is no escape, and for control characters.
std::optional<std::string> decode(std::string_view text, bool plus_is_space) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        char c = text[i];
        if (c == '%') {
            if (i + 2 >= text.size())
                return std::nullopt;
            const int high = hexadecimal_digit(text[i + 1]), low = hexadecimal_digit(text[i + 2]);
            if (high < 0 || low < 0)
                return std::nullopt;
            c = static_cast<char>(high * 16 + low);
            i += 2;
        } else if (c == '+' && plus_is_space) {
            c = ' ';
        }
        if (is_control(c))
            return std::nullopt;
        decoded += c;
    }
    return decoded;
}

bool is_safe_path(std::string_view path) {
    if (!path.starts_with('/') || path.find('\\') != std::string_view::npos)
        return false;
    for (std::size_t begin = 1; begin < path.size();) {
        const std::size_t end = std::min(path.find('/', begin), path.size());
        const std::string_view segment = path.substr(begin, end - begin);
        if (segment.empty() || segment == "." || segment == "..")
            return false;
        begin = end + 1;
    }
    return true;
}

/// The part before the first `separator`, which is taken out of `rest` with it.
std::string_view take_until(std::string_view& rest, char separator) {
    const std::size_t end = rest.find(separator);
    const std::string_view part = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
    return part;
}

} // namespace

std::optional<Target> parse_target(std::string_view text) {
    std::string_view rest = text;
    const auto path = decode(take_until(rest, '?'), false);
    if (!path || !is_safe_path(*path))
        return std::nullopt;
    Target target{*path, {}};
    while (!rest.empty()) {
        std::string_view value = take_until(rest, '&');
        const auto decoded_name = decode(take_until(value, '='), true);
        const auto decoded_value = decode(value, true);
        if (!decoded_name || !decoded_value)
            return std::nullopt;
        target.query[*decoded_name] = *decoded_value;
    }
    return target;
}

std::string cookie_name(std::uint16_t port) {
    return "plisse_token_" + std::to_string(port);
}

bool has_cookie(std::string_view field, std::string_view name, std::string_view secret) {
    while (!field.empty()) {
        std::string_view value = take_until(field, ';');
        value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
        if (take_until(value, '=') == name && is_same_secret(value, secret))
            return true;
    }
    return false;
}

bool is_same_secret(std::string_view given, std::string_view secret) {
    if (given.size() != secret.size())
        return false;
    volatile unsigned char difference = 0; // volatile: no early end
    for (std::size_t i = 0; i < secret.size(); ++i)
        difference = difference | static_cast<unsigned char>(given[i] ^ secret[i]);
    return difference == 0;
}

std::string safe_download_name(std::string_view name) {
    std::string safe(name);
    for (char& c : safe)
        if (is_control(c) || static_cast<unsigned char>(c) >= 0x80 || c == '"' || c == '/' || c == '\\')
            c = '_';
    return safe;
}

} // namespace plisse::studio
