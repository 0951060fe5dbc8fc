#include "host/image/read_image.h"

#include "host/image/readers.h"

#include "host/decode/failure.h"
#include "host/decode/hdr.h"
#include "host/error.h"
#include "host/file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <new>
#include <optional>
#include <stdexcept>

namespace wedge::image {

namespace {

class HdrImage : public ImageFile::Reader {
public:
    HdrImage(const std::string& path, const decode::Limits& limits)
        : limits_(limits)
        , bytes_(readFile(path, "HDR image", maxImageFile))
    {
    }

    ImageFile::Header open() override
    {
        hdr_.emplace(decode::bytesOf(bytes_));
        limits_.admit(hdr_->size(), bytes_.size());
        const auto [width, height] = hdr_->size();
        return { .width = width, .height = height, .data = { 0, 0, width, height }, .bytes = bytes_.size() };
    }

    RgbImage read() override
    {
        const decode::Size size = hdr_->size();
        RgbImage image { size.width, size.height, {} };
        image.rgb.reserve(static_cast<std::size_t>(size.pixels()) * 3);
        hdr_->readRows([&](int, std::span<const decode::Rgbe> pixels) {
            for (const decode::Rgbe& p : pixels) {
                const std::array<float, 3> colour = hdr_->radiance(p);
                image.rgb.insert(image.rgb.end(), colour.begin(), colour.end());
            }
        });
        return image;
    }

private:
    decode::Limits limits_;
    std::string bytes_;
    std::optional<decode::HdrReader> hdr_;
};

} // namespace

void failToRead(const std::string& path, const std::string& kind, const std::exception& reason)
{
    if (const auto* error = dynamic_cast<const Error*>(&reason))
        throw Error(*error);
    if (dynamic_cast<const std::bad_alloc*>(&reason) != nullptr
        || dynamic_cast<const std::length_error*>(&reason) != nullptr) // a size that no memory could hold
        throw Error("cannot read " + kind + " (host memory is exhausted)", path, "use a smaller image");
    std::string line = reason.what();
    // OpenEXR names the file as well, which the user need not read twice.
    const std::size_t named = line.find(path + "\". ");
    if (named != std::string::npos)
        line.erase(0, named + path.size() + 3);
    std::replace(line.begin(), line.end(), '\n', ' ');
    const auto* failure = dynamic_cast<const decode::Failure*>(&reason);
    throw Error("cannot read " + kind + " (" + line + ")", path,
        failure ? failure->remedy() : "check that the file is whole and of its type");
}

namespace {

/// A part of the frame that `image` shows the window `data` of.
RgbImage partOf(RgbImage image, const Window& data, const Window& part)
{
    if (part == data)
        return image;
    RgbImage out { part.width(), part.height(), {} };
    out.rgb.resize(3 * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    const Window common = data.within(part);
    const auto row = [](const Window& window, int y) {
        return 3 * static_cast<std::ptrdiff_t>(y - window.y0) * window.width();
    };
    for (int y = common.y0; y < common.y1 && !common.empty(); ++y) {
        const auto from = image.rgb.begin() + row(data, y) + 3 * (common.x0 - data.x0);
        std::copy_n(from, 3 * common.width(), out.rgb.begin() + row(part, y) + 3 * (common.x0 - part.x0));
    }
    return out;
}

} // namespace

ImageFile::ImageFile(const std::string& path, const decode::Limits& limits)
    : path_(path)
    , limits_(limits)
{
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
        [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    if (extension != ".exr" && extension != ".png" && extension != ".hdr")
        throw Error("image file of unknown format", path, "use .exr, .png or .hdr");
    kind_ = extension == ".exr" ? "EXR image" : extension == ".png" ? "PNG image" : "HDR image";
    try {
        if (extension == ".exr")
            reader_ = exrReader(path, limits);
        else if (extension == ".png")
            reader_ = pngReader(path, limits);
        else
            reader_ = std::make_unique<HdrImage>(path, limits);
        header_ = reader_->open();
        stored_ = header_.data.within(whole());
        if (stored_.empty())
            throw decode::Failure("its data window lies outside of its display window, so that nothing of it is seen",
                "write it anew, with pixels inside of the display window");
    } catch (const std::exception& error) {
        failToRead(path, kind_, error);
    }
}

ImageFile::~ImageFile() = default;

RgbImage ImageFile::read(const Window& part)
{
    try {
        if (!stored_.contains(part)) // memory that no header has been held against
            limits_.admit({ part.width(), part.height() }, header_.bytes);
        return partOf(reader_->read(), header_.data, part);
    } catch (const std::exception& error) {
        failToRead(path_, kind_, error);
    }
}

RgbImage readImage(const std::string& path) { return ImageFile(path).read(); }

} // namespace wedge::image
