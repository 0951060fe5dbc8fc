#include "host/image/png.h"
#include "host/image/readers.h"

#include "host/decode/png.h"
#include "host/file.h"

#include <optional>

namespace wedge::image {

namespace {

class PngImage : public ImageFile::Reader {
public:
    explicit PngImage(const std::string& path, const decode::Limits& limits = decode::referenceLimits)
        : limits_(limits)
        , bytes_(readFile(path, "PNG image", maxImageFile))
    {
    }

    ImageFile::Header open() override
    {
        png_.emplace(decode::bytesOf(bytes_));
        limits_.admit(png_->size(), bytes_.size());
        const auto [width, height] = png_->size();
        return { .width = width, .height = height, .data = { 0, 0, width, height }, .bytes = bytes_.size() };
    }

    RgbImage read() override
    {
        const decode::Size size = png_->size();
        const std::vector<float> linear = png_->linearValues();
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
        if (png_->matrix())
            decode::convert(*png_->matrix(), image.rgb);
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
