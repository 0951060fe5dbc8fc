#pragma once

#include "host/decode/bytes.h"
#include "host/decode/picture.h"

namespace wedge::decode {

/// Whether the bytes begin with a header of this format that does not contradict itself; it has no signature.
bool isTga(Bytes bytes);

/// Truevision TGA: colour-mapped, true-colour and grey (8 bits, or 16 with an attribute), plain and run-length coded,
/// 15, 16 (five bits a channel and an attribute), 24 and 32 bits (with an attribute), from any corner. Attributes are
/// alpha where the descriptor counts bits of them, unless an extension area says what they are; and where they are 0
/// everywhere the picture is opaque. What is multiplied with its alpha is divided by it.
/// Throws Failure for all else, beyond the limits, and where data are missing.
Picture decodeTga(Bytes bytes, const Limits& limits);

} // namespace wedge::decode
