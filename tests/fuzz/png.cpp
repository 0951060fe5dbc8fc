#include "host/decode/png.h"
#include "tests/fuzz/decode_target.h"

// As a texture and as a reference.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    try {
        const wedge::decode::Bytes bytes(data, size);
        wedge::decode::PngReader reader(bytes);
        fuzzLimits.admit(reader.size(), size);
        unsigned sum = 0;
        reader.readRows(wedge::decode::PngSamples::Rgb16, [&](const wedge::decode::PngReader::Row& row) {
            for (int x = row.first; x < reader.size().width; x += row.step)
                sum += row.samples[6 * x] + row.samples[6 * x + 5];
        });
        static_cast<void>(sum);
    } catch (const wedge::decode::Failure&) {
    }
    return decodeForFuzzing(data, size, wedge::decode::decodePng);
}
