#pragma once

#include "host/image/read_image.h"

#include <cstdint>

namespace wedge::image {

/// Most bytes of a PNG or HDR file, which is read as a whole.
constexpr std::uintmax_t maxImageFile = std::uintmax_t { 1 } << 30;

// One reader a format. What they throw may be any exception.
std::unique_ptr<ImageFile::Reader> pngReader(const std::string& path, const decode::Limits& limits);
std::unique_ptr<ImageFile::Reader> exrReader(const std::string& path, const decode::Limits& limits);

/// The Error for an image file ("PNG image") that cannot be read for that reason, on one line.
[[noreturn]] void failToRead(const std::string& path, const std::string& kind, const std::exception& reason);

} // namespace wedge::image
