#include "include_arrows.h"

#include <algorithm>
#include <array>
#include <regex>
#include <sstream>

namespace plisse::house {

namespace {

/// Each folder may include those before it.
constexpr std::array<std::string_view, 15> order = {"base",     "linalg",   "geometry",  "spatial", "mesh",
                                                    "transfer", "decimate", "subdivide", "energy",  "contact",
                                                    "solve",    "model",    "drive",     "scene",   "steer"};
/// Beside the order: nothing includes them, and they include these only.
constexpr std::array<std::string_view, 2> aside = {"picture", "exports"};
constexpr std::array<std::string_view, 2> seen_from_aside = {"base", "mesh"};

bool is_aside(std::string_view folder) {
    return std::find(aside.begin(), aside.end(), folder) != aside.end();
}

bool may_include(std::string_view from, std::string_view to) {
    if (from == to)
        return true;
    if (is_aside(from))
        return std::find(seen_from_aside.begin(), seen_from_aside.end(), to) != seen_from_aside.end();
    const auto from_place = std::find(order.begin(), order.end(), from);
    return std::find(order.begin(), from_place, to) != from_place;
}

} // namespace

bool is_known_folder(const std::string& folder) {
    return is_aside(folder) || std::find(order.begin(), order.end(), folder) != order.end();
}

std::vector<std::string> wrong_includes(const std::string& folder, std::string_view text) {
    static const std::regex include(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
    static const std::regex own_header(R"(plisse/([^/]+)/[^/]+)");
    std::vector<std::string> wrong;
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
        std::smatch found, header;
        if (!std::regex_match(line, found, include))
            continue;
        const std::string path = found[2];
        if (found[1] == "\"" || path.find("..") != std::string::npos || path.starts_with("apps/"))
            wrong.push_back("'" + line + "' is not of the form <plisse/folder/file.h>");
        else if (std::regex_match(path, header, own_header) && !may_include(folder, header[1].str()))
            wrong.push_back("'" + line + "' points from " + folder + " to " + header[1].str());
    }
    return wrong;
}

} // namespace plisse::house
