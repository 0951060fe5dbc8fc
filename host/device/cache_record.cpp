#include "host/device/cache_record.h"

#include <array>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <unistd.h>

namespace wedge::device {
namespace {

namespace fs = std::filesystem;

constexpr const char* name = "record";
constexpr const char* aside = "record.new";
constexpr const char* firstLine = "wedge record 1";
constexpr const char* lastLine = "end";

/// Of a file's bytes, eight at a time: it finds damage, and all of the cache is read at every start.
std::optional<std::uint64_t> checksumOf(const fs::path& path)
{
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"), std::fclose);
    if (!file) {
        return std::nullopt;
    }
    std::array<std::uint64_t, 8192> block {};
    std::uint64_t sum = 0xcbf29ce484222325u;
    for (;;) {
        const std::size_t bytes = std::fread(block.data(), 1, sizeof(block), file.get());
        if (bytes < sizeof(block)) { // what an earlier block left behind the end must not count
            std::memset(reinterpret_cast<char*>(block.data()) + bytes, 0, sizeof(block) - bytes);
        }
        for (std::size_t i = 0; i < (bytes + 7) / 8; ++i) {
            sum = (sum ^ block[i]) * 0x9e3779b97f4a7c15u;
            sum ^= sum >> 32;
        }
        if (bytes < sizeof(block)) {
            return std::ferror(file.get()) == 0 ? std::optional(sum ^ bytes) : std::nullopt;
        }
    }
}

/// Whole or not at all, also when the power fails: else damage to it would hide damage to the others.
bool replace(const fs::path& folder, const std::string& text)
{
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
        std::fopen((folder / aside).c_str(), "wbe"), std::fclose);
    if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) < text.size() || std::fflush(file.get()) != 0
        || ::fsync(::fileno(file.get())) != 0) {
        return false;
    }
    std::error_code failed;
    fs::rename(folder / aside, folder / name, failed);
    return !failed;
}

} // namespace

bool CacheRecord::begin(const fs::path& folder)
{
    return replace(folder, fmt::format("{}\n{}\n", firstLine, lastLine));
}

bool CacheRecord::isRecord(const fs::path& path) { return path.filename() == name || path.filename() == aside; }

CacheRecord::CacheRecord(fs::path folder)
    : folder_(std::move(folder))
{
    std::ifstream stream(folder_ / name, std::ios::binary);
    valid_ = parse({ std::istreambuf_iterator<char>(stream), {} });
    if (!valid_) {
        entries_.clear();
    }
}

bool CacheRecord::parse(const std::string& text)
{
    std::istringstream lines(text);
    std::string line;
    if (!std::getline(lines, line) || line != firstLine) {
        return false;
    }
    while (std::getline(lines, line) && line != lastLine) {
        std::istringstream fields(line);
        Entry entry;
        std::string path;
        if (!(fields >> entry.checksum >> entry.bytes >> entry.written).ignore(1) || !std::getline(fields, path)) {
            return false;
        }
        entries_[path] = entry;
    }
    return line == lastLine;
}

bool CacheRecord::store() const
{
    std::string text = fmt::format("{}\n", firstLine);
    for (const auto& [path, entry] : entries_) {
        text += fmt::format("{} {} {} {}\n", entry.checksum, entry.bytes, entry.written, path);
    }
    return replace(folder_, text + lastLine + "\n");
}

CacheRecord::Entries CacheRecord::found() const
{
    Entries files;
    std::error_code failed;
    for (fs::recursive_directory_iterator it(folder_, failed), end; !failed && it != end; it.increment(failed)) {
        const fs::path& path = it->path();
        std::error_code ignored;
        const bool loaded = path.extension() == ".so" || path.extension() == ".bc";
        const std::string relative = path.lexically_relative(folder_).string();
        if (loaded && it->symlink_status(ignored).type() == fs::file_type::regular
            && relative.find('\n') == std::string::npos) {
            const auto written = it->last_write_time(ignored).time_since_epoch().count();
            files[relative] = { 0, it->file_size(ignored), static_cast<std::int64_t>(written) };
        }
    }
    return files;
}

std::size_t CacheRecord::removeDamaged(bool othersWrite)
{
    std::size_t removed = 0;
    for (const auto& [path, now] : found()) {
        const auto known = entries_.find(path);
        if (known == entries_.end() || (othersWrite && now.written != known->second.written)) {
            continue;
        }
        const bool whole = now.bytes == known->second.bytes && checksumOf(folder_ / path) == known->second.checksum;
        std::error_code failed;
        if (!whole && fs::remove(folder_ / path, failed)) {
            entries_.erase(known);
            ++removed;
        }
    }
    if (removed > 0) {
        store();
    }
    return removed;
}

void CacheRecord::takeIn()
{
    if (!valid_) {
        return; // the next start empties the folder
    }
    Entries all;
    for (auto& [path, now] : found()) {
        const auto known = entries_.find(path);
        if (known != entries_.end() && known->second.bytes == now.bytes && known->second.written == now.written) {
            all.insert(*known);
        } else if (const auto checksum = checksumOf(folder_ / path)) {
            now.checksum = *checksum;
            all.emplace(path, now);
        }
    }
    if (all != entries_) {
        entries_ = std::move(all);
        store();
    }
}

} // namespace wedge::device
