#include <plisse/exports/xml_text.h>

namespace plisse {

std::string xml_escaped(std::string_view text) {
    std::string out;
    for (char c : text)
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '"')
            out += "&quot;";
        else if (static_cast<unsigned char>(c) < ' ')
            out += ' ';
        else
            out += c;
    return out;
}

} // namespace plisse
