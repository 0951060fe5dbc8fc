#include "host/image/exr_part.h"

#include <map>
#include <string_view>

namespace wedge::image {

namespace {

using decode::Failure;

constexpr std::uint64_t mostChannels = 1024;

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

void readChannels(ExrCursor& in, ExrPart& part)
{
    for (std::string name = in.name(); !name.empty(); name = in.name()) {
        const std::uint32_t kind = in.u32(); // uint, half, float
        in.skip(4); // whether a perceptual scale, and nothing
        const std::uint32_t across = in.u32(), down = in.u32();
        if ((across != 1 || down != 1) && !part.subsampled)
            part.subsampled = name;
        if (kind > 2 || ++part.channels > mostChannels)
            throw Failure(kind > 2 ? "a channel is of an unknown kind"
                                   : "it has more than " + std::to_string(mostChannels) + " channels");
        part.bytesPerPixel += kind == 1 ? 2 : 4;
    }
}

void checkStrings(ExrCursor& in, std::uint64_t end)
{
    while (in.position() < end)
        in.skip(in.u32());
}

void checkPreview(ExrCursor& in, std::uint64_t size)
{
    const std::uint64_t width = in.u32(), height = in.u32();
    if (width > size || height > size || 8 + 4 * width * height != size)
        throw Failure("its preview has not the size that it says");
    in.skip(size - 8);
}

void readValue(ExrCursor& in, const std::string& name, const std::string& type, std::uint64_t size, ExrPart& part)
{
    const std::uint64_t end = in.position() + size;
    const auto fixed = fixedSize(type);
    if (size > in.left() || (fixed && *fixed != size) || (type == "floatvector" && size % 4 != 0))
        throw Failure("its attribute '" + name + "' has not the size that it says");
    if (type == "chlist") {
        if (name == "channels")
            readChannels(in, part);
        else {
            ExrPart unused;
            readChannels(in, unused);
        }
    } else if (type == "box2i" && (name == "dataWindow" || name == "displayWindow")) {
        ExrBox box { in.i32(), in.i32(), in.i32(), in.i32() };
        (name == "dataWindow" ? part.data : part.display) = box;
    } else if (name == "compression" && type == "compression") {
        part.compression = in.byte();
    } else if (name == "tiles" && type == "tiledesc") {
        part.tiles = ExrTiles { in.u32(), in.u32() };
        const unsigned mode = in.byte();
        if (mode % 16 > 2 || mode / 16 > 1)
            throw Failure("its tiles are of an unknown mode");
    } else if (name == "chunkCount" && type == "int") {
        part.chunkCount = in.i32();
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

} // namespace

bool readExrPart(ExrCursor& in, ExrPart& part)
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

} // namespace wedge::image
