#pragma once

#include <string>
#include <string_view>

namespace plisse {

/// Text as it may stand within the quotes of an XML attribute.
std::string xml_escaped(std::string_view text);

} // namespace plisse
