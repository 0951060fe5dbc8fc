#include "host/device/program_cache.h"

#include "host/device/cache_root.h"
#include "host/hash.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

namespace wedge::device {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view extension = ".clbin";
constexpr std::size_t maxEntries = 300;

/// What an entry begins with; the key and the binary follow.
struct Header {
    char magic[8] = { 'w', 'e', 'd', 'g', 'e', 'b', 'i', '1' };
    std::uint64_t keyBytes = 0;
    std::uint64_t binaryBytes = 0;
    std::uint64_t binaryHash = 0;
};

/// By its name, which is a hash: others of the folder are not ours to drop.
bool isEntry(const fs::directory_entry& entry)
{
    const std::string stem = entry.path().stem().string();
    std::error_code ignored;
    return entry.path().extension() == extension && stem.size() == 16
        && std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isxdigit(c) != 0; })
        && entry.symlink_status(ignored).type() == fs::file_type::regular;
}

} // namespace

ProgramCache::ProgramCache(fs::path folder)
    : folder_(std::move(folder))
{
}

ProgramCache ProgramCache::fromEnvironment()
{
    const CacheRoot& root = CacheRoot::ofProcess();
    const WantedCache wanted = WantedCache::fromEnvironment();
    return ProgramCache(wanted == root.wanted ? root.folder : wanted.folder);
}

fs::path ProgramCache::entry(std::string_view key) const
{
    return folder_.empty() ? fs::path() : folder_ / fmt::format("{:016x}{}", hashOf(key), extension);
}

std::optional<ProgramCache::Binary> ProgramCache::load(std::string_view key) const
{
    if (folder_.empty()) {
        return std::nullopt;
    }
    std::ifstream stream(entry(key), std::ios::binary);
    const std::string all((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    Header header;
    if (all.size() < sizeof(header)) {
        return std::nullopt;
    }
    const Header expected;
    std::memcpy(&header, all.data(), sizeof(header));
    const std::string_view body = std::string_view(all).substr(sizeof(header));
    if (std::memcmp(header.magic, expected.magic, sizeof(header.magic)) != 0 || header.keyBytes != key.size()
        || body.size() < key.size() || header.binaryBytes != body.size() - key.size() || !body.starts_with(key)) {
        return std::nullopt;
    }
    const std::string_view binary = body.substr(key.size());
    if (binary.empty() || hashOf(binary) != header.binaryHash) {
        return std::nullopt;
    }
    return Binary(binary.begin(), binary.end());
}

void ProgramCache::store(std::string_view key, const Binary& binary) const
{
    if (folder_.empty() || binary.empty()) {
        return;
    }
    std::error_code ignored;
    fs::create_directories(folder_, ignored);
    const fs::path target = entry(key);
    fs::path aside = target;
    aside += fmt::format(".{}", ::getpid());
    Header header;
    header.keyBytes = key.size();
    header.binaryBytes = binary.size();
    header.binaryHash = hashOf(binary);
    std::ofstream stream(aside, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(&header), sizeof(header));
    stream.write(key.data(), static_cast<std::streamsize>(key.size()));
    stream.write(reinterpret_cast<const char*>(binary.data()), static_cast<std::streamsize>(binary.size()));
    stream.close();
    if (stream) {
        fs::rename(aside, target, ignored);
        dropOldest();
    } else {
        fs::remove(aside, ignored);
    }
}

void ProgramCache::dropOldest() const
{
    std::error_code ignored;
    std::vector<std::pair<fs::file_time_type, fs::path>> entries;
    for (fs::directory_iterator it(folder_, ignored), end; it != end; it.increment(ignored)) {
        if (isEntry(*it)) {
            entries.emplace_back(it->last_write_time(ignored), it->path());
        }
    }
    std::sort(entries.begin(), entries.end());
    for (std::size_t i = 0; i + maxEntries < entries.size(); ++i) {
        fs::remove(entries[i].second, ignored);
    }
}

} // namespace wedge::device
