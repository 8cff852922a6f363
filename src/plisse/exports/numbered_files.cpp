#include <plisse/exports/numbered_files.h>

#include <algorithm>
#include <string_view>

#include <fmt/core.h>

#include <plisse/base/error.h>

namespace plisse {

namespace fs = std::filesystem;

namespace {

bool is_numbered_file(std::string_view file, const std::string& name, const std::string& extension) {
    if (file.size() <= name.size() + 1 + extension.size() || !file.starts_with(name + ".") ||
        !file.ends_with(extension))
        return false;
    const std::string_view number = file.substr(name.size() + 1, file.size() - name.size() - 1 - extension.size());
    return std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
}

} // namespace

std::string numbered_file(const std::string& name, std::size_t k, const std::string& extension) {
    return fmt::format("{}.{:04}{}", name, k + 1, extension);
}

void expect_own_folder(const fs::path& folder, const std::string& name, const std::string& extension) {
    if (!fs::exists(folder))
        return;
    if (!fs::is_directory(folder))
        throw InputError(folder.string(), "this is a file", "give the name of a folder");
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string file = entry.path().filename().string();
        if (!entry.is_regular_file() || !is_numbered_file(file, name, extension))
            throw InputError(folder.string(),
                             fmt::format("the folder holds other things than an export, such as {}", file),
                             "give another folder, or empty this one");
    }
}

} // namespace plisse
