#pragma once

#include "host/decode/failure.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace wedge::decode {

using Bytes = std::span<const std::uint8_t>;

inline Bytes bytesOf(std::string_view text)
{
    return { reinterpret_cast<const std::uint8_t*>(text.data()), text.size() };
}

inline bool startsWith(Bytes bytes, std::string_view text)
{
    return bytes.size() >= text.size()
        && std::string_view(reinterpret_cast<const char*>(bytes.data()), text.size()) == text;
}

/// Reads bytes from the front; throws Failure where there are fewer than asked for.
class ByteReader {
public:
    explicit ByteReader(Bytes bytes)
        : bytes_(bytes)
    {
    }
    std::size_t left() const { return bytes_.size() - at_; }
    std::size_t position() const { return at_; }
    Bytes take(std::size_t count)
    {
        if (count > left())
            throw Failure("it ends before the picture does");
        at_ += count;
        return bytes_.subspan(at_ - count, count);
    }
    std::uint8_t byte() { return take(1)[0]; }
    // Little-endian.
    std::uint16_t u16()
    {
        const Bytes b = take(2);
        return static_cast<std::uint16_t>(b[0] | b[1] << 8);
    }
    std::uint32_t u32()
    {
        const std::uint32_t low = u16();
        return low | std::uint32_t { u16() } << 16;
    }

private:
    Bytes bytes_;
    std::size_t at_ = 0;
};

} // namespace wedge::decode
