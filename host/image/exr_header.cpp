#include "host/image/exr_header.h"

#include "host/decode/failure.h"
#include "host/decode/limits.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace wedge::image {

namespace {

using decode::Failure;

constexpr std::uint32_t tiledFlag = 0x200, deepFlag = 0x800, multiPartFlag = 0x1000, knownFlags = 0x1e00;
constexpr std::uint64_t mostChannels = 1024;
constexpr int mostParts = 256;

/// Reads little-endian numbers, and knows how much of the file is left.
class Cursor {
public:
    Cursor(Imf::IStream& in, std::uint64_t size)
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
                throw Failure("a name in its header is too long");
            text += static_cast<char>(c);
        }
        return text;
    }

private:
    void advance(std::uint64_t count)
    {
        if (count > left())
            throw Failure("it ends inside its header");
        at_ += count;
    }

    Imf::IStream& in_;
    std::uint64_t size_, at_ = 0;
};

struct Box {
    std::int64_t x0 = 0, y0 = 0, x1 = 0, y1 = 0; // inclusive
    std::int64_t width() const { return x1 - x0 + 1; }
    std::int64_t height() const { return y1 - y0 + 1; }
};

struct Tiles {
    std::uint64_t width = 0, height = 0;
};

struct Part {
    std::set<std::string> names;
    std::optional<Box> data, display;
    std::optional<unsigned> compression;
    std::optional<Tiles> tiles;
    std::uint64_t channels = 0, bytesPerPixel = 0;
    std::string type;
};

/// Sizes of the types that have but one; OpenEXR reads so much whatever the file says.
std::optional<std::uint64_t> fixedSize(const std::string& type)
{
    static const std::map<std::string_view, std::uint64_t> sizes = { { "box2i", 16 }, { "box2f", 16 },
        { "chromaticities", 32 }, { "compression", 1 }, { "deepImageState", 1 }, { "double", 8 }, { "envmap", 1 },
        { "float", 4 }, { "int", 4 }, { "keycode", 28 }, { "lineOrder", 1 }, { "m33d", 72 }, { "m33f", 36 },
        { "m44d", 128 }, { "m44f", 64 }, { "rational", 8 }, { "tiledesc", 9 }, { "timecode", 8 }, { "v2d", 16 },
        { "v2f", 8 }, { "v2i", 8 }, { "v3d", 24 }, { "v3f", 12 }, { "v3i", 12 } };
    const auto found = sizes.find(type);
    return found == sizes.end() ? std::nullopt : std::optional(found->second);
}

void readChannels(Cursor& in, Part& part)
{
    while (!in.name().empty()) {
        const std::uint32_t kind = in.u32(); // uint, half, float
        in.skip(4); // whether a perceptual scale, and nothing
        in.skip(8); // sampling, which is checked where it matters
        if (kind > 2 || ++part.channels > mostChannels)
            throw Failure(kind > 2 ? "a channel is of an unknown kind"
                                   : "it has more than " + std::to_string(mostChannels) + " channels");
        part.bytesPerPixel += kind == 1 ? 2 : 4;
    }
}

void checkStrings(Cursor& in, std::uint64_t end)
{
    while (in.position() < end)
        in.skip(in.u32());
}

void checkPreview(Cursor& in, std::uint64_t size)
{
    const std::uint64_t width = in.u32(), height = in.u32();
    if (width > size || height > size || 8 + 4 * width * height != size)
        throw Failure("its preview has not the size that it says");
    in.skip(size - 8);
}

void readValue(Cursor& in, const std::string& name, const std::string& type, std::uint64_t size, Part& part)
{
    const std::uint64_t end = in.position() + size;
    const auto fixed = fixedSize(type);
    if (size > in.left() || (fixed && *fixed != size) || (type == "floatvector" && size % 4 != 0))
        throw Failure("its attribute '" + name + "' has not the size that it says");
    if (type == "chlist") {
        if (name == "channels")
            readChannels(in, part);
        else {
            Part unused;
            readChannels(in, unused);
        }
    } else if (type == "box2i" && (name == "dataWindow" || name == "displayWindow")) {
        Box box { in.i32(), in.i32(), in.i32(), in.i32() };
        (name == "dataWindow" ? part.data : part.display) = box;
    } else if (name == "compression" && type == "compression") {
        part.compression = in.byte();
    } else if (name == "tiles" && type == "tiledesc") {
        part.tiles = Tiles { in.u32(), in.u32() };
        const unsigned mode = in.byte();
        if (mode % 16 > 2 || mode / 16 > 1)
            throw Failure("its tiles are of an unknown mode");
    } else if (name == "type" && type == "string" && size < 64) {
        while (in.position() < end)
            part.type += static_cast<char>(in.byte());
    } else if (type == "stringvector") {
        checkStrings(in, end);
    } else if (type == "preview") {
        checkPreview(in, size);
    } else {
        in.skip(size);
    }
    if (in.position() != end)
        throw Failure("its attribute '" + name + "' has not the size that it says");
}

/// False where there is no further part.
bool readPart(Cursor& in, Part& part)
{
    for (std::string name = in.name(); !name.empty(); name = in.name()) {
        if (!part.names.insert(name).second)
            throw Failure("its attribute '" + name + "' is there twice");
        const std::string type = in.name();
        const std::int32_t size = in.i32();
        if (size < 0)
            throw Failure("its attribute '" + name + "' has not the size that it says");
        readValue(in, name, type, static_cast<std::uint64_t>(size), part);
    }
    return !part.names.empty();
}

decode::Size sizeOf(const Box& box)
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

Grid checkPart(const Part& part, bool tiled, std::uint64_t fileBytes)
{
    if (!part.data || !part.display || !part.compression || part.channels == 0 || (tiled && !part.tiles))
        throw Failure("its header is not complete");
    const decode::Size size = sizeOf(*part.data);
    decode::referenceLimits.admit(size, fileBytes);
    const decode::Size frame = sizeOf(*part.display);
    if (frame.width < 1 || frame.height < 1)
        throw Failure("its display window is empty");
    const auto width = static_cast<std::uint64_t>(size.width), height = static_cast<std::uint64_t>(size.height);
    const std::uint64_t raw = width * height * part.bytesPerPixel;
    constexpr std::uint64_t modest = std::uint64_t { 1 } << 28;
    if (raw > modest && raw / decode::mostPixelsPerByte > fileBytes)
        throw Failure("it claims " + std::to_string(part.channels) + " channels of " + std::to_string(size.width) + "x"
            + std::to_string(size.height) + " pixels in " + std::to_string(fileBytes) + " bytes");
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
void checkChunks(Cursor& in, const Part& part, const Grid& grid, std::uint64_t headBytes)
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

} // namespace

void checkExrHeaders(Imf::IStream& stream, std::uint64_t fileBytes)
{
    Cursor in(stream, fileBytes);
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
    std::optional<Part> first;
    Grid firstGrid;
    const auto isTiled = [&](const Part& part) {
        // The type has a zero behind it where a program wrote that, too.
        return multiPart ? part.type.starts_with("tiledimage") : (version & tiledFlag) != 0;
    };
    for (int parts = 0; parts == 0 || multiPart; ++parts) {
        Part part;
        if (!readPart(in, part) && parts > 0)
            break;
        if (parts == mostParts)
            throw Failure("it has more than " + std::to_string(mostParts) + " parts");
        if (multiPart && part.type.starts_with("deep"))
            failAsDeep();
        const Grid grid = checkPart(part, isTiled(part), fileBytes);
        chunks += grid.count();
        if (!first) {
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
