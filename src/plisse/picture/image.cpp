#include <plisse/picture/image.h>

#include <algorithm>

namespace plisse {

void Image::fill(int left, int top, int width, int height, Pixel pixel) {
    for (int y = std::max(top, 0); y < std::min(top + height, height_); ++y)
        for (int x = std::max(left, 0); x < std::min(left + width, width_); ++x)
            at(x, y) = pixel;
}

void Image::paste(const Image& source, int left, int top) {
    for (int y = std::max(top, 0); y < std::min(top + source.height(), height_); ++y)
        for (int x = std::max(left, 0); x < std::min(left + source.width(), width_); ++x)
            at(x, y) = source.at(x - left, y - top);
}

} // namespace plisse
