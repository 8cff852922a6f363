#pragma once

#include <span>
#include <string>

#include <plisse/picture/image.h>

namespace plisse {

/// A picture and the lines below it.
struct Panel {
    Image image;
    std::string title, caption;
};

/// Puts pictures of one size in a grid, row by row, each with its title and caption, under a heading (which may be
/// empty). At least one panel.
Image contact_sheet(std::span<const Panel> panels, const std::string& heading);

} // namespace plisse
