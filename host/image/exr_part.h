#pragma once

#include "host/decode/failure.h"

#include <OpenEXR/ImfIO.h>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

namespace wedge::image {

/// Reads little-endian numbers, and knows how much of the file is left.
class ExrCursor {
public:
    ExrCursor(Imf::IStream& in, std::uint64_t size)
        : in_(in)
        , size_(size)
    {
    }
    std::uint64_t position() const { return at_; }
    std::uint64_t left() const { return size_ - at_; }
    void seek(std::uint64_t position)
    {
        at_ = 0;
        advance(position);
        in_.seekg(at_);
    }
    void skip(std::uint64_t count)
    {
        advance(count);
        in_.seekg(at_);
    }
    std::uint8_t byte()
    {
        char c = 0;
        advance(1);
        in_.read(&c, 1);
        return static_cast<std::uint8_t>(c);
    }
    std::uint32_t u32()
    {
        std::uint32_t value = 0;
        for (int shift = 0; shift < 32; shift += 8)
            value |= std::uint32_t { byte() } << shift;
        return value;
    }
    std::uint64_t u64()
    {
        const std::uint64_t low = u32();
        return low | std::uint64_t { u32() } << 32;
    }
    std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
    std::string name()
    {
        std::string text;
        while (const std::uint8_t c = byte()) {
            if (text.size() == 255)
                throw decode::Failure("a name in its header is too long");
            text += static_cast<char>(c);
        }
        return text;
    }

private:
    void advance(std::uint64_t count)
    {
        if (count > left())
            throw decode::Failure("it ends inside its header");
        at_ += count;
    }

    Imf::IStream& in_;
    std::uint64_t size_, at_ = 0;
};

struct ExrBox {
    std::int64_t x0 = 0, y0 = 0, x1 = 0, y1 = 0; // inclusive
    std::int64_t width() const { return x1 - x0 + 1; }
    std::int64_t height() const { return y1 - y0 + 1; }
};

struct ExrTiles {
    std::uint64_t width = 0, height = 0;
};

/// What the header of one part says of its pixels.
struct ExrPart {
    std::set<std::string> names;
    std::optional<ExrBox> data, display;
    std::optional<unsigned> compression;
    std::optional<ExrTiles> tiles;
    std::uint64_t channels = 0, bytesPerPixel = 0;
    std::optional<std::string> subsampled; ///< the first channel that is
    std::optional<std::int32_t> chunkCount;
    std::string type;
};

/// Reads one header; false where there is no further part. Throws decode::Failure where an attribute is there twice,
/// has not the size of its type, or does not fit into the file.
bool readExrPart(ExrCursor& in, ExrPart& part);

} // namespace wedge::image
