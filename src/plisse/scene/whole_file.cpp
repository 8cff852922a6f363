#include <plisse/scene/whole_file.h>

#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include <fmt/core.h>

namespace plisse {

void write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
    std::filesystem::path unfinished = path;
    unfinished += ".tmp";
    std::ofstream out(unfinished, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    std::error_code error;
    if (out)
        std::filesystem::rename(unfinished, path, error);
    if (!out || error) {
        std::filesystem::remove(unfinished, error);
        throw std::runtime_error(fmt::format("{}: the file cannot be written; see that the folder can be written to "
                                             "and the disk is not full",
                                             path.string()));
    }
}

std::string fnv1a64(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (char byte : bytes) {
        hash ^= static_cast<unsigned char>(byte);
        hash *= 0x100000001b3ULL;
    }
    return fmt::format("{:016x}", hash);
}

} // namespace plisse
