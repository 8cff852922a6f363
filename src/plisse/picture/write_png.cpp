#include <plisse/picture/write_png.h>

#include <cstdio>
#include <memory>
#include <stdexcept>
#include <system_error>

#include <png.h>

namespace plisse {

namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

// libpng's simplified interface: no jumps over C++ objects.
bool write_rows(std::FILE* file, const Image& image) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width());
    header.height = static_cast<png_uint_32>(image.height());
    header.format = PNG_FORMAT_RGB;
    static_assert(sizeof(Pixel) == 3);
    return png_image_write_to_stdio(&header, file, 0, &image.at(0, 0), 3 * image.width(), nullptr) != 0;
}

} // namespace

void write_png(const std::filesystem::path& path, const Image& image) {
    std::filesystem::path unfinished = path;
    unfinished += ".part";
    const auto fail = [&](const char* why) {
        std::error_code ignored;
        std::filesystem::remove(unfinished, ignored);
        throw std::runtime_error(path.string() + ": " + why);
    };
    std::unique_ptr<std::FILE, CloseFile> file(std::fopen(unfinished.c_str(), "wb"));
    if (!file)
        throw std::runtime_error(path.string() + ": cannot be opened for writing");
    if (!write_rows(file.get(), image))
        fail("the picture could not be written");
    if (std::fclose(file.release()) != 0)
        fail("the picture could not be written to the end");
    std::error_code error;
    std::filesystem::rename(unfinished, path, error);
    if (error)
        fail("the finished picture could not be moved into place");
}

} // namespace plisse
