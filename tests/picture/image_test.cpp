#include <cstdio>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <png.h>

#include <plisse/base/random.h>
#include <plisse/picture/colors.h>
#include <plisse/picture/contact_sheet.h>
#include <plisse/picture/legend.h>
#include <plisse/picture/text.h>
#include <plisse/picture/write_png.h>

namespace plisse {
namespace {

constexpr Pixel white{255, 255, 255};
constexpr Pixel black{0, 0, 0};

std::filesystem::path scratch_file(const std::string& name) {
    return std::filesystem::path(testing::TempDir()) / name;
}

Image read_png(const std::filesystem::path& path) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&header, path.c_str()))
        return {};
    header.format = PNG_FORMAT_RGB;
    Image image(static_cast<int>(header.width), static_cast<int>(header.height));
    png_image_finish_read(&header, nullptr, &image.at(0, 0), 0, nullptr);
    return image;
}

int count_pixels(const Image& image, Pixel pixel) {
    int count = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            count += image.at(x, y) == pixel;
    return count;
}

TEST(WritePng, KeepsEveryPixel) {
    Random random(2);
    Image image(37, 23);
    for (int y = 0; y < 23; ++y)
        for (int x = 0; x < 37; ++x)
            image.at(x, y) = {static_cast<std::uint8_t>(random.below(256)),
                              static_cast<std::uint8_t>(random.below(256)),
                              static_cast<std::uint8_t>(random.below(256))};
    const auto path = scratch_file("keeps.png");
    write_png(path, image);
    write_png(path, image); // over an old one
    const Image read = read_png(path);
    ASSERT_EQ(read.width(), 37);
    ASSERT_EQ(read.height(), 23);
    for (int y = 0; y < 23; ++y)
        for (int x = 0; x < 37; ++x)
            ASSERT_EQ(read.at(x, y), image.at(x, y));
    EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
    std::filesystem::remove(path);
}

TEST(WritePng, SaysWhichFileItCannotWrite) {
    const auto path = scratch_file("no-such-folder") / "picture.png";
    try {
        write_png(path, Image(2, 2));
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
    }
}

TEST(WritePng, LeavesNothingBehindWhenItCannotFinish) {
    const auto folder = scratch_file("a-folder.png");
    std::filesystem::create_directories(folder / "inside");
    EXPECT_THROW(write_png(folder, Image(2, 2)), std::runtime_error);
    EXPECT_FALSE(std::filesystem::exists(folder.string() + ".part"));
    std::filesystem::remove_all(folder);
}

TEST(Image, DropsWhatFallsOutside) {
    Image image(4, 4, white);
    image.fill(-2, -2, 3, 3, black);
    EXPECT_EQ(count_pixels(image, black), 1);
    image.paste(Image(3, 3, black), 3, 2);
    EXPECT_EQ(count_pixels(image, black), 3);
    EXPECT_EQ(image.at(3, 3), black);
}

TEST(Text, TakesTheRoomItSays) {
    const std::string text = "plisse: qgy|";
    Image image(text_width(text, 2) + 20, text_height(2) + 20, white);
    draw_text(image, 10, 10, text, 2, black);
    const int drawn = count_pixels(image, black);
    EXPECT_GT(drawn, 4 * 60);
    Image inside(text_width(text, 2), text_height(2), white);
    draw_text(inside, 0, 0, text, 2, black);
    EXPECT_EQ(count_pixels(inside, black), drawn);
}

TEST(Text, ShowsEveryCharacterDifferently) {
    std::vector<Image> seen;
    for (int code = 32; code < 127; ++code) {
        Image image(5, 9, white);
        draw_text(image, 0, 0, std::string(1, static_cast<char>(code)), 1, black);
        for (const Image& other : seen) {
            bool same = true;
            for (int y = 0; y < 9; ++y)
                for (int x = 0; x < 5; ++x)
                    same = same && image.at(x, y) == other.at(x, y);
            EXPECT_FALSE(same) << static_cast<char>(code);
        }
        seen.push_back(image);
    }
}

TEST(MapColor, GrowsSteadilyLighter) {
    double last = -1;
    for (int i = 0; i <= 50; ++i) {
        const Color color = map_color(i / 50.0);
        const double luminance = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
        EXPECT_GT(luminance, last);
        EXPECT_GT(color.minCoeff(), -1e-6);
        EXPECT_LT(color.maxCoeff(), 1);
        last = luminance;
    }
    EXPECT_EQ(map_color(-3), map_color(0));
    EXPECT_EQ(map_color(7), map_color(1));
}

TEST(Colors, SurviveTheWayToPixels) {
    for (unsigned hex : {0x000000U, 0xffffffU, 0x8040c0U, 0x123456U}) {
        const Pixel pixel = to_pixel(color_from_hex(hex));
        EXPECT_NEAR(pixel.red, hex >> 16, 1);
        EXPECT_NEAR(pixel.green, hex >> 8 & 0xff, 1);
        EXPECT_NEAR(pixel.blue, hex & 0xff, 1);
    }
}

TEST(Colors, TellBodiesAndSidesApart) {
    for (int a = 0; a < 8; ++a) {
        for (int b = 0; b < a; ++b)
            EXPECT_GT((body_color(a) - body_color(b)).norm(), 0.08f) << a << " " << b;
        EXPECT_GT((body_color(a) - obstacle_color()).norm(), 0.08f);
        EXPECT_LT(back_color(body_color(a)).sum(), body_color(a).sum());
    }
}

TEST(ContactSheet, PutsEveryPanelInItsPlace) {
    std::vector<Panel> panels;
    for (int i = 0; i < 5; ++i)
        panels.push_back({Image(60, 40, {static_cast<std::uint8_t>(10 * i + 10), 0, 0}), "title", "caption"});
    const Image sheet = contact_sheet(panels, "heading");
    EXPECT_GT(sheet.width(), 3 * 60);
    EXPECT_LT(sheet.width(), 4 * 60 + 60);
    for (int i = 0; i < 5; ++i)
        EXPECT_EQ(count_pixels(sheet, {static_cast<std::uint8_t>(10 * i + 10), 0, 0}), 60 * 40);
    const Image single = contact_sheet(std::span(panels).first(1), "");
    EXPECT_EQ(count_pixels(single, {10, 0, 0}), 60 * 40);
}

TEST(Legend, ShowsBothEndsOfTheMap) {
    Image image(legend_width, 300, white);
    draw_legend(image, 0, {"stretch", MeshAttribute::Domain::face, {0.9, 1.2}, 0.9, 1.2});
    EXPECT_GT(count_pixels(image, to_pixel(map_color(0.0015))) + count_pixels(image, to_pixel(map_color(0.002))), 0);
    EXPECT_LT(count_pixels(image, white), legend_width * 300 - 20 * 200);
    Image tiny(legend_width, 20, white);
    draw_legend(tiny, 0, {"stretch", MeshAttribute::Domain::face, {}, 0, 1}); // no room: nothing, and no crash
    EXPECT_EQ(count_pixels(tiny, white), legend_width * 20);
}

} // namespace
} // namespace plisse
