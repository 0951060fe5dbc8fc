#include "host/image/exr_header.h"
#include "host/image/exr_part.h"

#include "host/decode/limits.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

namespace wedge::image {

namespace {

using decode::Failure;

constexpr std::uint32_t tiledFlag = 0x200, deepFlag = 0x800, multiPartFlag = 0x1000, knownFlags = 0x1e00;
constexpr int mostParts = 256;

decode::Size sizeOf(const ExrBox& box)
{
    // Far enough from the ends of 32 bits that differences of coordinates have room.
    constexpr std::int64_t farthest = 1 << 24;
    for (const std::int64_t at : { box.x0, box.y0, box.x1, box.y1 }) {
        if (at < -farthest || at > farthest)
            throw Failure("its data or display window is out of range");
    }
    return { static_cast<int>(box.width()), static_cast<int>(box.height()) };
}

/// Rows of one chunk, by OpenEXR's number of the compression.
std::uint64_t rowsPerChunk(unsigned compression)
{
    constexpr std::array<std::uint64_t, 10> rows = { 1, 1, 1, 16, 32, 16, 32, 32, 32, 256 };
    if (compression >= rows.size())
        throw Failure("its compression is of an unknown kind", "save it with ZIP compression");
    return rows[compression];
}

/// OpenEXR takes memory for a chunk, and for a row of tiles, before it has read one.
void requireModest(std::uint64_t bytes, std::uint64_t fileBytes)
{
    constexpr std::uint64_t modest = std::uint64_t { 64 } << 20, perByte = 64;
    if (bytes > modest && bytes / perByte > fileBytes)
        throw Failure("its chunks or tiles are too large for a file of " + std::to_string(fileBytes) + " bytes");
}

/// How the pixels of a part, of levels the finest, are cut into chunks.
struct Grid {
    std::uint64_t width = 0, height = 0; // of the picture
    std::uint64_t chunkWidth = 0, chunkHeight = 0;
    std::uint64_t columns() const { return (width + chunkWidth - 1) / chunkWidth; }
    std::uint64_t rows() const { return (height + chunkHeight - 1) / chunkHeight; }
    std::uint64_t count() const { return columns() * rows(); }
    /// Pixels of a chunk, which the picture's edge may cut.
    std::uint64_t pixels(std::uint64_t chunk) const
    {
        const std::uint64_t x = chunk % columns() * chunkWidth, y = chunk / columns() * chunkHeight;
        return std::min(chunkWidth, width - x) * std::min(chunkHeight, height - y);
    }
};

/// All channels of a chunk are unpacked, whatever is read of them, at three seconds a gigabyte. As many channels as a
/// render has layers may be there for as many pixels as go unquestioned, since those of an empty scene pack to next to
/// nothing; a small file has no need of more.
void requireModestChannels(
    const ExrPart& part, const decode::Size& size, std::uint64_t fileBytes, const decode::Limits& limits)
{
    constexpr std::uint64_t layers = 64, bytesOfLayers = 4 * layers, bytesOfMore = layers, perByte = 64;
    const std::uint64_t unquestioned =
        static_cast<std::uint64_t>(limits.unquestioned) * (part.channels <= layers ? bytesOfLayers : bytesOfMore);
    const std::uint64_t raw = static_cast<std::uint64_t>(size.pixels()) * part.bytesPerPixel;
    if (raw > unquestioned && raw / perByte > fileBytes)
        throw Failure("it claims " + std::to_string(part.channels) + " channels of " + std::to_string(size.width) + "x"
                + std::to_string(size.height) + " pixels in " + std::to_string(fileBytes) + " bytes",
            limits.remedy);
}

Grid checkPart(const ExrPart& part, bool tiled, std::uint64_t fileBytes, const decode::Limits& limits)
{
    if (!part.data || !part.display || !part.compression || part.channels == 0 || (tiled && !part.tiles))
        throw Failure("its header is not complete");
    const decode::Size size = sizeOf(*part.data);
    limits.admit(size, fileBytes);
    const decode::Size frame = sizeOf(*part.display);
    if (frame.width < 1 || frame.height < 1)
        throw Failure("its display window is empty");
    requireModestChannels(part, size, fileBytes, limits);
    const auto width = static_cast<std::uint64_t>(size.width), height = static_cast<std::uint64_t>(size.height);
    Grid grid { width, height, width, rowsPerChunk(*part.compression) };
    if (tiled) {
        grid.chunkWidth = part.tiles->width;
        grid.chunkHeight = part.tiles->height;
        constexpr std::uint64_t mostSide = 1 << 16;
        if (std::min(grid.chunkWidth, grid.chunkHeight) < 1 || std::max(grid.chunkWidth, grid.chunkHeight) > mostSide)
            throw Failure("the size of its tiles is out of range");
    }
    requireModest(std::max(width, grid.chunkWidth) * grid.chunkHeight * part.bytesPerPixel, fileBytes);
    return grid;
}

/// Each chunk has its place in the table that begins here, and its bytes are there. OpenEXR would go in search of
/// those that are not, and take what its memory happens to hold for those that are too short.
void checkChunks(ExrCursor& in, const ExrPart& part, const Grid& grid, std::uint64_t headBytes)
{
    const std::uint64_t table = in.position();
    for (std::uint64_t chunk = 0; chunk < grid.count(); ++chunk) {
        in.seek(table + 8 * chunk);
        const std::uint64_t at = in.u64(), end = in.position() + in.left();
        if (at < table || at > end || end - at < headBytes)
            throw Failure("a chunk of its pixels is missing or damaged");
        in.seek(at + headBytes - 4);
        const std::uint64_t size = in.u32();
        const bool whole = *part.compression == 0 ? size == grid.pixels(chunk) * part.bytesPerPixel : size > 0;
        if (!whole || size > in.left())
            throw Failure("a chunk of its pixels is missing or damaged");
    }
}

[[noreturn]] void failAsDeep()
{
    throw Failure("it has deep data", "flatten it, and save it with the channels R, G and B");
}

/// OpenEXR takes memory for a table of so many chunks, which of types that it does not know are not counted otherwise.
void checkType(const ExrPart& part, bool multiPart, std::uint64_t fileBytes)
{
    const std::string type = part.type.substr(0, part.type.find('\0')); // some programs write the zero, too
    if (multiPart && type.starts_with("deep"))
        failAsDeep();
    if (multiPart && type != "scanlineimage" && type != "tiledimage")
        throw Failure("a part is of the unknown type '" + type + "'", "save it as scan lines or tiles");
    if (part.chunkCount && (*part.chunkCount < 1 || static_cast<std::uint64_t>(*part.chunkCount) > fileBytes / 8))
        throw Failure("it claims " + std::to_string(*part.chunkCount) + " chunks of pixels in "
            + std::to_string(fileBytes) + " bytes");
}

/// OpenEXR reads it at another size than the rest, which no pixel here has.
void requireFullSampling(const ExrPart& part)
{
    if (part.subsampled)
        throw Failure("its channel " + *part.subsampled + " is subsampled", "convert the image to R, G and B");
}

} // namespace

void checkExrHeaders(Imf::IStream& stream, std::uint64_t fileBytes, const decode::Limits& limits)
{
    ExrCursor in(stream, fileBytes);
    if (fileBytes == 0)
        throw Failure("it is empty");
    if (fileBytes < 8 || in.u32() != 0x01312f76)
        throw Failure("it is no EXR");
    const std::uint32_t version = in.u32();
    if (version % 256 != 2 || (version & ~(knownFlags | 255u)) != 0)
        throw Failure("it is of an unknown version", "save it as EXR 2");
    if (version & deepFlag)
        failAsDeep();
    const bool multiPart = version & multiPartFlag;
    std::uint64_t chunks = 0;
    std::optional<ExrPart> first;
    Grid firstGrid;
    const auto isTiled = [&](const ExrPart& part) {
        // The type has a zero behind it where a program wrote that, too.
        return multiPart ? part.type.starts_with("tiledimage") : (version & tiledFlag) != 0;
    };
    for (int parts = 0; parts == 0 || multiPart; ++parts) {
        ExrPart part;
        if (!readExrPart(in, part) && parts > 0)
            break;
        if (parts == mostParts)
            throw Failure("it has more than " + std::to_string(mostParts) + " parts");
        checkType(part, multiPart, fileBytes);
        const Grid grid = checkPart(part, isTiled(part), fileBytes, limits);
        chunks += grid.count();
        if (!first) {
            requireFullSampling(part);
            first = std::move(part);
            firstGrid = grid;
        }
    }
    // Each chunk has a place in the table, and says at least which it is and how long.
    if (chunks * 16 > in.left())
        throw Failure("it ends before the picture does");
    // Before its pixels a chunk has the part where there are several, its row or its tile and level, and its bytes.
    checkChunks(in, *first, firstGrid, (multiPart ? 4 : 0) + (isTiled(*first) ? 16 : 4) + 4);
    stream.seekg(0);
}

} // namespace wedge::image
