#pragma once

#include <cassert>
#include <cstdint>
#include <vector>

namespace plisse {

/// One pixel, sRGB.
struct Pixel {
    std::uint8_t red = 0, green = 0, blue = 0;
    bool operator==(const Pixel&) const = default;
};

/// A picture: rows from the top, pixels from the left.
class Image {
public:
    Image() = default;
    Image(int width, int height, Pixel fill = {}) : width_(width), height_(height) {
        assert(width > 0 && height > 0);
        pixels_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill);
    }

    int width() const { return width_; }
    int height() const { return height_; }
    Pixel& at(int x, int y) { return pixels_[index(x, y)]; }
    const Pixel& at(int x, int y) const { return pixels_[index(x, y)]; }

    /// Fills the part of the rectangle that lies within the picture.
    void fill(int left, int top, int width, int height, Pixel pixel);
    /// Copies `source` with its top left corner at (left, top); what falls outside is dropped.
    void paste(const Image& source, int left, int top);

private:
    std::size_t index(int x, int y) const {
        assert(x >= 0 && x < width_ && y >= 0 && y < height_);
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }

    int width_ = 0;
    int height_ = 0;
    std::vector<Pixel> pixels_;
};

} // namespace plisse
