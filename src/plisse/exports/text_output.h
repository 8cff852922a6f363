#pragma once

#include <iterator>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace plisse {

/// Appends formatted text.
template <typename... Values>
void put_text(std::string& out, fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out), format, std::forward<Values>(values)...);
}

} // namespace plisse
