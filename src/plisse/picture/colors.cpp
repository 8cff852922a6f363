#include <plisse/picture/colors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace plisse {

namespace {

float linear_from_srgb(float value) {
    return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

std::array<std::uint8_t, 4096> make_srgb_table() {
    std::array<std::uint8_t, 4096> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double v = static_cast<double>(i) / static_cast<double>(table.size() - 1);
        const double srgb = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
        table[i] = static_cast<std::uint8_t>(std::lround(255 * srgb));
    }
    return table;
}

// OKLab to linear sRGB, with lightness, chroma and hue as polar coordinates.
Color color_from_oklab(double lightness, double chroma, double hue_deg) {
    const double hue = hue_deg * std::numbers::pi / 180;
    const double a = chroma * std::cos(hue);
    const double b = chroma * std::sin(hue);
    const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
    const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
    const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
    const Eigen::Vector3d rgb{4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                              -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                              -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
    return rgb.cwiseMax(0).cwiseMin(1).cast<float>();
}

std::array<Color, 256> make_map() {
    std::array<Color, 256> map;
    for (std::size_t i = 0; i < map.size(); ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(map.size() - 1);
        map[i] = color_from_oklab(0.28 + 0.63 * t, 0.135 - 0.160 * t + 0.185 * t * t, 312 - 205 * t);
    }
    return map;
}

} // namespace

Color color_from_hex(unsigned hex) {
    const auto channel = [hex](int shift) {
        return linear_from_srgb(static_cast<float>((hex >> shift) & 0xffU) / 255.0f);
    };
    return {channel(16), channel(8), channel(0)};
}

Pixel to_pixel(const Color& color) {
    static const std::array<std::uint8_t, 4096> table = make_srgb_table();
    const auto channel = [](float value) {
        return table[static_cast<std::size_t>(std::clamp(value, 0.0f, 1.0f) * 4095.0f + 0.5f)];
    };
    return {channel(color[0]), channel(color[1]), channel(color[2])};
}

Color body_color(int body) {
    constexpr std::array<unsigned, 8> palette = {0xd9805f, 0x4a9aa6, 0xdfb45a, 0x8f74b0,
                                                 0x86a86c, 0x6384bf, 0xcd7a93, 0xa68063};
    return color_from_hex(palette[static_cast<std::size_t>(body) % palette.size()]);
}

Color clay_color() {
    return color_from_hex(0xd8cfc4);
}

Color obstacle_color() {
    return color_from_hex(0xa9adb3);
}

Color back_color(const Color& front) {
    return 0.66f * front + 0.16f * color_from_hex(0x4a5a8c);
}

Color map_color(double share) {
    static const std::array<Color, 256> map = make_map();
    const double place = 255 * std::clamp(share, 0.0, 1.0);
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(place), 254);
    const auto rest = static_cast<float>(place - static_cast<double>(i));
    return (1 - rest) * map[i] + rest * map[i + 1];
}

} // namespace plisse
