#pragma once

#include "host/decode/bytes.h"
#include "host/decode/picture.h"

#include <cstdlib>

/// Small enough that an execution stays fast, whatever the header claims.
constexpr wedge::decode::Limits fuzzLimits { .pixels = 1 << 16, .side = 4096 };

/// Decodes the bytes; the only way to refuse them is a Failure.
template <class Decode>
int decodeForFuzzing(const std::uint8_t* data, std::size_t size, Decode&& decode)
{
    try {
        const wedge::decode::Picture picture = decode(wedge::decode::Bytes(data, size), fuzzLimits);
        if (picture.rgba.size() != static_cast<std::size_t>(picture.size.pixels()))
            std::abort();
    } catch (const wedge::decode::Failure&) {
    }
    return 0;
}
