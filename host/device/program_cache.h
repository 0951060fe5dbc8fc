#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wedge::device {

/// Program binaries on disk, found by a key that holds all they depend on. Whatever goes wrong with the disk is a
/// miss, never an error: an entry that is truncated, altered, or of another key is ignored and later overwritten.
class ProgramCache {
public:
    using Binary = std::vector<unsigned char>;

    /// folder: made when first stored into; empty turns the cache off.
    explicit ProgramCache(std::filesystem::path folder);

    /// In the folder that the environment asks for now (WantedCache), or the one that stands in for it (CacheRoot).
    static ProgramCache fromEnvironment();

    /// The binary stored under exactly this key, if it is there unharmed.
    std::optional<Binary> load(std::string_view key) const;

    /// Stores by writing aside and renaming, so that programs running at once never read half an entry; then drops
    /// the oldest entries beyond a few hundred.
    void store(std::string_view key, const Binary& binary) const;

    const std::filesystem::path& folder() const { return folder_; }
    /// Where the entry of a key lies; empty if the cache is off.
    std::filesystem::path entry(std::string_view key) const;

private:
    void dropOldest() const;

    std::filesystem::path folder_;
};

} // namespace wedge::device
