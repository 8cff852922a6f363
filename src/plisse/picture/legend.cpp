#include <plisse/picture/legend.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <plisse/picture/colors.h>
#include <plisse/picture/text.h>

namespace plisse {

namespace {

constexpr Pixel ink{58, 64, 72};
constexpr int margin = 16;
constexpr int bar_width = 20;

/// Does any value lie beyond the end of the colour map?
bool exceeds(const Scalars& scalars) {
    return std::any_of(scalars.values.begin(), scalars.values.end(),
                       [&](double value) { return std::isfinite(value) && value > scalars.high; });
}

} // namespace

void draw_legend(Image& image, int left, const Scalars& scalars) {
    const int scale = text_width(scalars.name, 2) + margin <= legend_width ? 2 : 1;
    const int top = margin + 2 * text_height(scale);
    const int bar_height = image.height() - top - margin;
    if (bar_height < 4 * text_height(scale))
        return;
    draw_text(image, left, margin, scalars.name, scale, ink);
    for (int y = 0; y < bar_height; ++y)
        image.fill(left, top + y, bar_width, 1, to_pixel(map_color(1 - (y + 0.5) / bar_height)));
    const int text_left = left + bar_width + 8;
    for (int mark = 0; mark <= 4; ++mark) {
        const double value = scalars.low + (scalars.high - scalars.low) * (4 - mark) / 4;
        const int y = top + mark * (bar_height - text_height(scale)) / 4;
        const char* const beyond = mark == 0 && exceeds(scalars) ? ">" : "";
        draw_text(image, text_left, y, fmt::format("{}{:.4g}", beyond, value), scale, ink);
    }
}

} // namespace plisse
