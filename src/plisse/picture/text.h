#pragma once

#include <string_view>

#include <plisse/picture/image.h>

namespace plisse {

/// Writes a line of text with its top left corner at (left, top), in a built-in font of 5 by 7 dots, each `scale` by
/// `scale` pixels. ASCII; other bytes appear as a box. What falls outside the picture is dropped.
void draw_text(Image& image, int left, int top, std::string_view text, int scale, Pixel color);

/// Pixels that a line of text takes.
int text_width(std::string_view text, int scale);
int text_height(int scale);

} // namespace plisse
