// What a driver's compiled kernels looked like when they had been loaded and launched without harm.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace wedge::device {

/// Sizes and checksums of the files that a driver loads unchecked. One process at a time may use the record of a
/// folder.
class CacheRecord {
public:
    /// Reads the record of the folder.
    explicit CacheRecord(std::filesystem::path folder);

    /// Starts an empty record; false where that cannot be written.
    static bool begin(const std::filesystem::path& folder);
    static bool isRecord(const std::filesystem::path& path);

    /// False where it is missing or damaged itself, so that nothing is known of any file.
    bool isValid() const { return valid_; }

    /// Removes the files that are not what they were, and returns how many those were. othersWrite: a file that was
    /// written since is then taken for theirs.
    std::size_t removeDamaged(bool othersWrite);

    /// Takes in the files that are new, or were written since.
    void takeIn();

private:
    struct Entry {
        std::uint64_t checksum = 0;
        std::uint64_t bytes = 0;
        std::int64_t written = 0; ///< when, by the file system's clock
        bool operator==(const Entry&) const = default;
    };
    using Entries = std::map<std::string, Entry>;

    /// The files that a driver loads, by their paths in the folder; of each only what is known without reading it.
    Entries found() const;
    bool parse(const std::string& text);
    bool store() const;

    std::filesystem::path folder_;
    Entries entries_;
    bool valid_ = false;
};

} // namespace wedge::device
