#include "host/image/read_image.h"

#include "host/image/readers.h"

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

    std::pair<int, int> open() override
    {
        hdr_.emplace(decode::bytesOf(bytes_));
        limits_.admit(hdr_->size(), bytes_.size());
        return { hdr_->size().width, hdr_->size().height };
    }

    RgbImage read() override
    {
        const decode::Size size = hdr_->size();
        RgbImage image { size.width, size.height, {} };
        image.rgb.reserve(static_cast<std::size_t>(size.pixels()) * 3);
        hdr_->readRows([&](int, std::span<const decode::Rgbe> pixels) {
            for (const decode::Rgbe& p : pixels) {
                for (std::size_t c = 0; c < 3; ++c)
                    image.rgb.push_back(decode::hdrValue(p[c], p[3]));
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

ImageFile::ImageFile(const std::string& path, const decode::Limits& limits)
    : path_(path)
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
        std::tie(width_, height_) = reader_->open();
    } catch (const std::exception& error) {
        failToRead(path, kind_, error);
    }
}

ImageFile::~ImageFile() = default;

RgbImage ImageFile::read()
{
    try {
        return reader_->read();
    } catch (const std::exception& error) {
        failToRead(path_, kind_, error);
    }
}

RgbImage readImage(const std::string& path) { return ImageFile(path).read(); }

} // namespace wedge::image
