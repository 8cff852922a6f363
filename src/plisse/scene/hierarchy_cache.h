#pragma once

#include <filesystem>
#include <optional>

#include <plisse/decimate/hierarchy_store.h>

namespace plisse {

/// FOLDER/<fingerprint>.hierarchy: a line that names the format and the sources it was made with, then the bytes of
/// the decimation with their checksum. What another plisse made or what is damaged is said and not used. A cache that
/// cannot be written to is said once, and does no harm. The files used last are kept, at most `most_files`.
class HierarchyCache : public HierarchyStore {
public:
    static constexpr int most_files = 32;

    /// The folder is made when something is kept. context: hears what there is to say, and must outlive the cache.
    HierarchyCache(std::filesystem::path folder, Context& context) : folder_(std::move(folder)), context_(context) {}

    std::optional<DecimationResult> load(const std::string& fingerprint) override;
    void save(const std::string& fingerprint, const DecimationResult& result) override;

    /// $PLISSE_CACHE, else $XDG_CACHE_HOME/plisse, else $HOME/.cache/plisse; nothing where PLISSE_CACHE is empty or
    /// none is set.
    static std::optional<std::filesystem::path> default_folder();

private:
    std::filesystem::path path_of(const std::string& fingerprint) const;
    void drop_oldest() const;

    std::filesystem::path folder_;
    Context& context_;
};

} // namespace plisse
