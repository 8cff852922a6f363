#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace plisse::studio {

/// What stands after the method of a request, decoded.
struct Target {
    std::string path;                         ///< begins with "/"
    std::map<std::string, std::string> query; ///< of a name that comes twice, the last
};

/// Nothing for what is no path: one that does not begin with "/", has a segment ".", ".." or (but for the last) an
/// empty one, a control character, backslash or NUL (written out or as %00), or a "%" without two hexadecimal digits.
std::optional<Target> parse_target(std::string_view text);

/// Of the cookie that carries the token. Browsers keep one jar for all ports of a machine, so it names the port.
std::string cookie_name(std::uint16_t port);

/// Whether a Cookie field carries this cookie with this secret. Takes the same time wherever the secrets differ.
bool has_cookie(std::string_view field, std::string_view name, std::string_view secret);

/// Takes the same time wherever they differ.
bool is_same_secret(std::string_view given, std::string_view secret);

/// For a Content-Disposition field: whatever could end it or name another folder becomes "_".
std::string safe_download_name(std::string_view name);

} // namespace plisse::studio
