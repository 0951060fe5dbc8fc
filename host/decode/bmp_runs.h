#pragma once

#include "host/decode/bytes.h"
#include "host/decode/picture.h"

#include <span>

namespace wedge::decode {

/// Decodes the run-length coded pixels of a bitmap, of 4 or 8 bits, into the picture. What they skip keeps its colour.
/// Throws Failure where they end early, leave the picture, or have a colour that the palette lacks.
void decodeBmpRuns(ByteReader& in, unsigned bits, std::span<const std::uint32_t> palette, Picture& picture);

} // namespace wedge::decode
