#include <plisse/picture/contact_sheet.h>

#include <cassert>
#include <cmath>

#include <plisse/picture/text.h>

namespace plisse {

namespace {

constexpr int gap = 14;
constexpr Pixel paper{255, 255, 255};
constexpr Pixel ink{45, 50, 58};
constexpr Pixel faint_ink{112, 119, 128};

/// The largest scale up to `scale` at which the text fits; 1 if none does.
int fitting_scale(const std::string& text, int width, int scale) {
    while (scale > 1 && text_width(text, scale) > width)
        --scale;
    return scale;
}

} // namespace

Image contact_sheet(std::span<const Panel> panels, const std::string& heading) {
    assert(!panels.empty());
    const int count = static_cast<int>(panels.size());
    const int columns = count <= 3 ? count : static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
    const int rows = (count + columns - 1) / columns;
    const int panel_width = panels.front().image.width();
    const int panel_height = panels.front().image.height();
    const int heading_height = heading.empty() ? 0 : text_height(3) + gap;
    const int caption_height = 3 * text_height(2);

    Image sheet(columns * (panel_width + gap) + gap,
                heading_height + rows * (panel_height + caption_height + gap) + gap, paper);
    const int heading_scale = fitting_scale(heading, sheet.width() - 2 * gap, 3);
    draw_text(sheet, gap, gap, heading, heading_scale, ink);
    for (int i = 0; i < count; ++i) {
        const Panel& panel = panels[static_cast<std::size_t>(i)];
        const int left = gap + (i % columns) * (panel_width + gap);
        const int top = gap + heading_height + (i / columns) * (panel_height + caption_height + gap);
        const int below = top + panel_height + text_height(2) / 2;
        sheet.paste(panel.image, left, top);
        draw_text(sheet, left, below, panel.title, fitting_scale(panel.title, panel_width, 2), ink);
        draw_text(sheet, left, below + text_height(2) * 5 / 4, panel.caption,
                  fitting_scale(panel.caption, panel_width, 2), faint_ink);
    }
    return sheet;
}

} // namespace plisse
