#pragma once

#include "host/decode/bytes.h"
#include "host/decode/picture.h"

#include <cstdint>
#include <doctest/doctest.h>
#include <string>
#include <vector>

namespace wedge::decode::test {

/// Bytes of a file in the making; numbers are little-endian.
struct File {
    std::string bytes;

    File& u8(unsigned value)
    {
        bytes += static_cast<char>(value);
        return *this;
    }
    File& u16(unsigned value) { return u8(value & 255).u8(value >> 8 & 255); }
    File& u32(std::uint32_t value) { return u16(value & 0xffff).u16(value >> 16); }
    File& add(const std::string& more)
    {
        bytes += more;
        return *this;
    }
};

inline std::string text(std::initializer_list<int> values)
{
    std::string out;
    for (const int value : values)
        out += static_cast<char>(value);
    return out;
}

/// Why the bytes are refused, or an empty string. Anything but a Failure ends the test.
template <class Decode>
std::string failureOf(const std::string& bytes, Decode&& decode, const Limits& limits = {})
{
    // A copy of the very size on the heap, so that sanitizers see a byte read too many.
    const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
    try {
        decode(Bytes(copy), limits);
    } catch (const Failure& failure) {
        CHECK(std::string(failure.what()) != "");
        return failure.what();
    }
    return "";
}

template <class Decode>
void checkEveryTruncationFails(const std::string& whole, Decode&& decode)
{
    CHECK(failureOf(whole, decode) == "");
    for (std::size_t size = 0; size < whole.size(); ++size) {
        CAPTURE(size);
        CHECK(failureOf(whole.substr(0, size), decode) != "");
    }
}

/// Whatever one byte becomes, the decoder returns.
template <class Decode>
void checkNoDamagedByteCrashes(const std::string& whole, Decode&& decode)
{
    const Limits limits { .pixels = 1 << 16 };
    for (std::size_t at = 0; at < whole.size(); ++at) {
        for (const int change : { 0x01, 0x80, 0xff, 0x0f, 0x55 }) {
            std::string damaged = whole;
            damaged[at] = static_cast<char>(damaged[at] ^ change);
            failureOf(damaged, decode, limits);
        }
    }
}

/// The pixels from the upper left corner on, row by row.
inline std::vector<std::uint32_t> fromTop(Picture picture)
{
    std::vector<std::uint32_t> out;
    for (int y = 0; y < picture.size.height; ++y)
        out.insert(out.end(), picture.rowFromTop(y), picture.rowFromTop(y) + picture.size.width);
    return out;
}

using Pixels = std::vector<std::uint32_t>;

} // namespace wedge::decode::test
