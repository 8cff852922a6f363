#include <plisse/scene/hierarchy_cache.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include <plisse/scene/json_document.h>
#include <plisse/scene/whole_file.h>

namespace plisse {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view extension = ".hierarchy";

/// What a file of this program begins with.
std::string header() {
    return "plisse hierarchy 1, sources " PLISSE_HIERARCHY_SOURCES "\n";
}

const char* variable(const char* name) {
    const char* value = std::getenv(name);
    return value && *value ? value : nullptr;
}

} // namespace

std::optional<DecimationResult> HierarchyCache::load(const std::string& fingerprint) {
    const fs::path path = path_of(fingerprint);
    std::error_code error;
    if (!fs::exists(path, error))
        return {};
    const auto refuse = [&](const char* why) {
        context_.on_message(fmt::format("{}: {}; the hierarchy is built again", path.string(), why));
        return std::optional<DecimationResult>();
    };
    std::string content;
    try {
        content = read_bytes(path);
    } catch (const InputError&) {
        return refuse("the cached hierarchy cannot be read");
    }
    const std::string expected = header();
    if (!content.starts_with(expected))
        return refuse("the cached hierarchy is stale or no such file: another version of plisse wrote it");
    auto result = from_bytes(std::string_view(content).substr(expected.size()));
    if (!result)
        return refuse("the cached hierarchy is damaged");
    fs::last_write_time(path, fs::file_time_type::clock::now(), error); // used last, dropped last
    return result;
}

void HierarchyCache::save(const std::string& fingerprint, const DecimationResult& result) {
    try {
        fs::create_directories(folder_);
        write_file_atomically(path_of(fingerprint), header() + to_bytes(result));
        drop_oldest();
    } catch (const std::exception& error) {
        context_.on_message(fmt::format("the hierarchy could not be cached for the next run: {}", error.what()));
    }
}

std::optional<fs::path> HierarchyCache::default_folder() {
    if (std::getenv("PLISSE_CACHE")) {
        const char* folder = variable("PLISSE_CACHE");
        return folder ? std::optional<fs::path>(folder) : std::nullopt;
    }
    if (const char* caches = variable("XDG_CACHE_HOME"))
        return fs::path(caches) / "plisse";
    if (const char* home = variable("HOME"))
        return fs::path(home) / ".cache" / "plisse";
    return {};
}

fs::path HierarchyCache::path_of(const std::string& fingerprint) const {
    return folder_ / (fingerprint + std::string(extension));
}

void HierarchyCache::drop_oldest() const {
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
        if (entry.path().extension() == extension)
            files.emplace_back(entry.last_write_time(), entry.path());
    std::sort(files.begin(), files.end());
    for (std::size_t f = 0; f + most_files < files.size(); ++f)
        fs::remove(files[f].second);
}

} // namespace plisse
