#include "host/image/colour.h"
#include "host/image/png.h"
#include "host/image/readers.h"

#include "host/decode/png.h"
#include "host/file.h"

#include <cmath>
#include <optional>

namespace wedge::image {

namespace {

/// The linear value of every 16-bit sample.
std::vector<float> linearValues(double gamma)
{
    std::vector<float> values(1 << 16);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float encoded = static_cast<float>(i) / 65535.0f;
        values[i] = gamma == 0.0 ? decodeSrgb(encoded) : std::pow(encoded, static_cast<float>(1.0 / gamma));
    }
    return values;
}

class PngImage : public ImageFile::Reader {
public:
    explicit PngImage(const std::string& path, const decode::Limits& limits = decode::referenceLimits)
        : limits_(limits)
        , bytes_(readFile(path, "PNG image", maxImageFile))
    {
    }

    std::pair<int, int> open() override
    {
        png_.emplace(decode::bytesOf(bytes_));
        limits_.admit(png_->size(), bytes_.size());
        return { png_->size().width, png_->size().height };
    }

    RgbImage read() override
    {
        const decode::Size size = png_->size();
        const std::vector<float> linear = linearValues(png_->gamma());
        RgbImage image { size.width, size.height, {} };
        image.rgb.resize(static_cast<std::size_t>(size.pixels()) * 3);
        png_->readRows(decode::PngSamples::Rgb16, [&](const decode::PngReader::Row& row) {
            float* to = image.rgb.data() + static_cast<std::size_t>(row.y) * size.width * 3;
            for (std::ptrdiff_t x = row.first; x < size.width; x += row.step) {
                const std::uint8_t* p = row.samples + 6 * x;
                for (int c = 0; c < 3; ++c)
                    to[3 * x + c] = linear[static_cast<std::size_t>(p[2 * c] << 8 | p[2 * c + 1])]; // big-endian
            }
        });
        return image;
    }

private:
    decode::Limits limits_;
    std::string bytes_;
    std::optional<decode::PngReader> png_;
};

} // namespace

std::unique_ptr<ImageFile::Reader> pngReader(const std::string& path, const decode::Limits& limits)
{
    return std::make_unique<PngImage>(path, limits);
}

RgbImage readPng(const std::string& path)
{
    try {
        PngImage image(path);
        image.open();
        return image.read();
    } catch (const std::exception& error) {
        failToRead(path, "PNG image", error);
    }
}

} // namespace wedge::image
