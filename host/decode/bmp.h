#pragma once

#include "host/decode/bytes.h"
#include "host/decode/picture.h"

namespace wedge::decode {

/// Windows and OS/2 bitmaps: headers of 12, 40, 52, 56, 64, 108 and 124 bytes; 1, 4 and 8 bits with a palette, 16, 24
/// and 32 bits, with masks of their own or without; run-length coded (4 and 8 bits); from the bottom or the top.
/// The fourth byte of 32 bits without masks is alpha, unless it is 0 everywhere.
/// Throws Failure for all else, beyond the limits, and where data are missing.
Picture decodeBmp(Bytes bytes, const Limits& limits);

} // namespace wedge::decode
