#include "host/decode/png.h"

#include "host/decode/srgb.h"

namespace wedge::decode {

namespace {

/// Colours of another encoding or of other primaries as those of sRGB.
void readConverted(PngReader& reader, Picture& picture)
{
    const std::vector<float> linear = reader.linearValues();
    std::vector<std::uint8_t> encoded;
    for (const float value : linear)
        encoded.push_back(byteOf(encodeSrgb(value)));
    reader.readRows(PngSamples::Rgba16, [&](const PngReader::Row& row) {
        std::uint32_t* to = picture.rowFromTop(row.y);
        for (int x = row.first; x < picture.size.width; x += row.step) {
            const std::uint8_t* p = row.samples + 8 * static_cast<std::ptrdiff_t>(x);
            const auto sample = [&](int c) { return static_cast<std::size_t>(p[2 * c] << 8 | p[2 * c + 1]); };
            if (reader.matrix()) {
                const std::array<float, 3> colour =
                    converted(*reader.matrix(), { linear[sample(0)], linear[sample(1)], linear[sample(2)] });
                to[x] = packRgba(
                    byteOf(encodeSrgb(colour[0])), byteOf(encodeSrgb(colour[1])), byteOf(encodeSrgb(colour[2])), p[6]);
            } else {
                to[x] = packRgba(encoded[sample(0)], encoded[sample(1)], encoded[sample(2)], p[6]);
            }
        }
    });
}

} // namespace

Picture decodePngFor(TextureUse use, Bytes bytes, const Limits& limits)
{
    PngReader reader(bytes);
    limits.admit(reader.size(), bytes.size());
    Picture picture(reader.size());
    picture.sameForAllUses = reader.gamma() == 0.0 && !reader.matrix();
    if (use == TextureUse::Colours && !picture.sameForAllUses) {
        readConverted(reader, picture);
        return picture;
    }
    reader.readRows(PngSamples::Rgba8, [&](const PngReader::Row& row) {
        std::uint32_t* to = picture.rowFromTop(row.y);
        for (int x = row.first; x < picture.size.width; x += row.step) {
            const std::uint8_t* p = row.samples + 4 * static_cast<std::ptrdiff_t>(x);
            to[x] = packRgba(p[0], p[1], p[2], p[3]);
        }
    });
    return picture;
}

Picture decodePng(Bytes bytes, const Limits& limits) { return decodePngFor(TextureUse::Colours, bytes, limits); }

} // namespace wedge::decode
