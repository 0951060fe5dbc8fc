#pragma once

#include "host/image/image.h"
#include "host/image/view.h"

#include <string>

namespace wedge::image {

/// Writes an 8-bit sRGB PNG. Values are multiplied and mapped to 0 .. 1 as the look has it (by default clipped, NaN to
/// 0), encoded with the sRGB curve and rounded. The file names this program as its software, and appears whole or not
/// at all. inputs: kept beside it, for pngInputs(), printable ASCII. Throws Error where it cannot be written, and
/// std::logic_error where the image is empty or contradicts itself.
void writePng(const std::string& path, const RgbImage& image, const Look& look = {}, const std::string& inputs = "");

/// What writePng() was told of a file's inputs; "" of others, and where there is no such file.
std::string pngInputs(const std::string& path);

/// Whether a path leads to a file that writePng() wrote.
bool isOwnPng(const std::string& path);

/// Reads a PNG of any kind (gray, RGB, palette, 1 to 16 bits, interlaced) as linear Rec.709. Alpha is ignored. Samples
/// are taken as sRGB, unless the file states another curve or other primaries (decode::PngReader::gamma(), matrix()).
/// Throws Error for a file that is missing, not a PNG, truncated, damaged or too large.
RgbImage readPng(const std::string& path);

} // namespace wedge::image
