#pragma once

#include "host/decode/bytes.h"
#include "host/decode/picture.h"
#include "host/decode/primaries.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace wedge::decode {

/// How samples are handed out, whatever the file holds.
enum class PngSamples {
    Rgba8, ///< four bytes a pixel; of 16 bits the upper 8
    Rgb16, ///< six bytes a pixel, big-endian, without alpha
    Rgba16, ///< eight bytes a pixel, big-endian
};

/// PNG of any kind (grey, colour, palette, 1 to 16 bits, interlaced), in memory. Chunks that do not matter to the
/// pixels are checked and skipped. Throws Failure for damage and missing data anywhere, up to IEND.
class PngReader {
public:
    /// Reads up to the pixels. The bytes must outlive the reader.
    explicit PngReader(Bytes bytes);
    ~PngReader();

    Size size() const;

    /// The gamma of the encoding that the file states, or 0 where it is sRGB, as it is where nothing is stated. Of what
    /// a file may state the first counts, as the specification has it: cICP, sRGB, gAMA; profiles (iCCP) are not read.
    double gamma() const;

    /// What makes its colours, once linear, those of Rec.709, if anything does: from cICP, or cHRM without sRGB.
    const std::optional<ColourMatrix>& matrix() const;

    /// The linear value of every sample of 16 bits, by gamma().
    std::vector<float> linearValues() const;

    /// Some pixels of a row: `first`, `first` + `step` and so on up to the width. samples: those of the whole row.
    struct Row {
        int y, first, step;
        const std::uint8_t* samples;
    };

    /// Hands out every pixel once, in as many passes as the file has; memory is taken for one row. Only once.
    void readRows(PngSamples samples, const std::function<void(const Row&)>& row);

private:
    struct Decoder;
    std::unique_ptr<Decoder> decoder_;
};

/// Colours that the file says are encoded otherwise, or of other primaries than sRGB, become sRGB's.
Picture decodePngFor(TextureUse use, Bytes bytes, const Limits& limits);

/// The same for colours.
Picture decodePng(Bytes bytes, const Limits& limits);

} // namespace wedge::decode
