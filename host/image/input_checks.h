#pragma once

#include <cstdint>
#include <string>

namespace wedge::image {

/// Throws Error where decoding width x height pixels of bytesPerPixel would take more than this program allows: more
/// than 2^28 pixels, or more than 1 GiB that is also more than 4096 times the size of the file (no compression in use
/// packs a picture that tightly, so the header lies and memory is not spent on it).
void requireDecodable(const std::string& path, std::int64_t width, std::int64_t height, std::int64_t bytesPerPixel);

/// The Error for an image file that cannot be read: reason in one line, and a remedy that fits whether the file is
/// missing, a directory, empty, or there but not readable as this format.
[[noreturn]] void failToRead(const std::string& path, const std::string& format, const std::string& reason);

/// Throws the Error of failToRead where the path is missing, a directory, empty, or may not be read.
void requireReadableFile(const std::string& path, const std::string& format);

} // namespace wedge::image
