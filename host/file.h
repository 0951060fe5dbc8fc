#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

namespace wedge {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

/// A regular file that is open for reading.
struct OpenFile {
    std::unique_ptr<std::FILE, CloseFile> stream;
    std::uintmax_t bytes = 0; ///< its size when it was opened
};

/// Opens a file. Throws Error when it is missing, a folder, anything else that is no regular file (what a FIFO or a
/// device would deliver has no end, or never comes), or unreadable; `kind` ("mesh file") names it in the message.
/// All that a result is made from is opened here and nowhere else, so that FilesOpened knows of it.
OpenFile openFile(const std::filesystem::path& path, const std::string& kind);

/// The whole of a file. Throws Error as openFile, and when it is larger than `limit` bytes.
std::string readFile(const std::filesystem::path& path, const std::string& kind, std::uintmax_t limit);

} // namespace wedge
