#pragma once

#include <span>
#include <string_view>

namespace plisse::studio {

/// A file of the studio's page, as the browser asks for it.
struct Asset {
    /// Below the page's root, without a slash at its beginning: "index.html", "assets/index-1a2b3c.js".
    std::string_view path;
    std::string_view mime_type;
    std::span<const unsigned char> bytes;
};

/// The files of the studio's page, which are part of the program; sorted by path.
std::span<const Asset> page_assets();

} // namespace plisse::studio
