#include <plisse/exports/unfinished_files.h>

#include <stdexcept>
#include <system_error>

#include <fmt/core.h>
#include <unistd.h>

namespace plisse {

namespace fs = std::filesystem;

UnfinishedFiles::~UnfinishedFiles() {
    std::error_code ignored;
    for (const Entry& entry : entries_)
        fs::remove_all(entry.unfinished, ignored);
}

fs::path UnfinishedFiles::add(const fs::path& path, const std::string& tag, bool keep) {
    fs::path unfinished = path;
    unfinished += fmt::format(".{}-{}", tag, ::getpid());
    entries_.push_back({unfinished, keep ? path : fs::path()});
    return unfinished;
}

fs::path UnfinishedFiles::add_file(const fs::path& path) {
    return add(path, "partial", true);
}

fs::path UnfinishedFiles::add_scratch(const fs::path& beside) {
    return add(beside, fmt::format("scratch-{}", entries_.size()), false);
}

fs::path UnfinishedFiles::add_folder(const fs::path& path) {
    const fs::path clean = path.has_filename() ? path : path.parent_path(); // "folder/" is "folder"
    fs::path unfinished = add(clean, "partial", true);
    std::error_code error;
    fs::remove_all(unfinished, error);
    if (!fs::create_directory(unfinished, error))
        throw std::runtime_error(fmt::format("{}: the folder cannot be made: {}", path.string(), error.message()));
    return unfinished;
}

void UnfinishedFiles::finish() {
    for (const Entry& entry : entries_)
        if (!entry.path.empty())
            move(entry);
}

void UnfinishedFiles::move(const Entry& entry) const {
    std::error_code error;
    fs::path aside;
    if (fs::is_directory(entry.unfinished) && fs::exists(entry.path)) { // a folder cannot be replaced in one step
        aside = entry.path;
        aside += fmt::format(".old-{}", ::getpid());
        fs::rename(entry.path, aside, error);
    }
    if (!error)
        fs::rename(entry.unfinished, entry.path, error);
    if (error) {
        const std::string why = error.message();
        if (!aside.empty())
            fs::rename(aside, entry.path, error);
        throw std::runtime_error(fmt::format("{}: cannot be moved into place: {}", entry.path.string(), why));
    }
    if (!aside.empty())
        fs::remove_all(aside, error);
}

OutputFile::OutputFile(fs::path path) : path_(std::move(path)), stream_(path_, std::ios::binary | std::ios::trunc) {
    if (!stream_)
        fail();
}

void OutputFile::append(const fs::path& path) {
    std::ifstream source(path, std::ios::binary);
    if (source.peek() != std::ifstream::traits_type::eof())
        stream_ << source.rdbuf();
    if (source.bad())
        throw std::runtime_error(path.string() + ": cannot be read again");
}

void OutputFile::close() {
    stream_.close();
    if (!stream_)
        fail();
}

void OutputFile::fail() const {
    throw std::runtime_error(fmt::format("{}: the file cannot be written; see that the folder can be written to and "
                                         "the disk is not full",
                                         path_.string()));
}

} // namespace plisse
