#pragma once

#include "host/decode/bytes.h"
#include "host/decode/picture.h"

namespace wedge::decode {

/// JPEG (baseline and progressive, grey, YCbCr, RGB, CMYK and YCCK) by libjpeg. Throws Failure for damaged and missing
/// data, beyond the limits, for arithmetic coding, and for what would take libjpeg more memory or time than any usual
/// file: coefficients beyond 128 MiB that are also more than 64 times the file, or more than 64 scans.
Picture decodeJpeg(Bytes bytes, const Limits& limits);

} // namespace wedge::decode
