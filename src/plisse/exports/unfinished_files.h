#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace plisse {

/// Files and folders that are written beside their places and moved there together when all are done. Without finish(),
/// and when it fails, those not yet moved are removed. Paths handed out stay valid as long as the object lives.
class UnfinishedFiles {
public:
    UnfinishedFiles() = default;
    ~UnfinishedFiles();
    UnfinishedFiles(const UnfinishedFiles&) = delete;
    UnfinishedFiles& operator=(const UnfinishedFiles&) = delete;

    /// Where to write the file until it is whole.
    std::filesystem::path add_file(const std::filesystem::path& path);
    /// A new folder to fill until it is whole. It takes the place of one that exists.
    std::filesystem::path add_folder(const std::filesystem::path& path);
    /// A file for the time of writing only.
    std::filesystem::path add_scratch(const std::filesystem::path& beside);

    /// Moves all into their places, in the order they were added. Throws std::runtime_error.
    void finish();

private:
    struct Entry {
        std::filesystem::path unfinished, path; ///< a scratch file has no path
    };
    std::filesystem::path add(const std::filesystem::path& path, const std::string& tag, bool keep);
    void move(const Entry& entry) const;

    std::vector<Entry> entries_;
};

/// A file that is written from its beginning. Throws std::runtime_error when it cannot be.
class OutputFile {
public:
    explicit OutputFile(std::filesystem::path path);
    void write(std::string_view bytes) { stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); }
    /// Appends all that another file holds.
    void append(const std::filesystem::path& path);
    /// To be called last: what could not be written is an error.
    void close();

private:
    [[noreturn]] void fail() const;

    std::filesystem::path path_;
    std::ofstream stream_;
};

} // namespace plisse
