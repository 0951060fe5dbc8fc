#pragma once

#include "host/image/image.h"

#include <string>

namespace wedge::image {

/// Writes a single-part scanline EXR with ZIP compression: 32-bit float channels (UINT where Channel::integer),
/// `chromaticities` of Rec.709 with white D65, displayWindow the full frame, dataWindow image.window, and each metadata
/// entry as an attribute of its type (string, float, int, m44f). The file appears whole or not at all.
/// Throws Error where the file cannot be written, and std::logic_error where the image contradicts itself: a channel of
/// the wrong size or a name used twice, an empty window, a metadata name that the format keeps for itself.
void writeExr(const std::string& path, const LayeredImage& image);

/// Reads the first part of an EXR: scanline or tiled (the full resolution of a mip map), any compression, half, float
/// and uint channels as floats, in alphabetical order. Coordinates are moved so that the display window starts at
/// (0, 0). Attributes of the types of MetadataValue come back as metadata, those that describe the format itself do
/// not. Throws Error for a file that is missing, not an EXR, truncated, damaged, too large for its bytes, or has deep
/// data or subsampled channels.
LayeredImage readExr(const std::string& path);

} // namespace wedge::image
