#pragma once

#include "host/decode/limits.h"
#include "host/image/image.h"

#include <memory>
#include <string>
#include <utility>

namespace wedge::image {

/// An image file that is open, of which the header alone has been read: its size is known before anything is decoded.
/// The format is told by the extension in either case: .exr (root R, G, B or Y over the data window), .png (decoded
/// from sRGB), .hdr (Radiance).
class ImageFile {
public:
    /// Throws Error for other extensions, and for files that cannot be read, or are beyond the limits.
    explicit ImageFile(const std::string& path, const decode::Limits& limits = decode::referenceLimits);
    ~ImageFile();

    int width() const { return width_; }
    int height() const { return height_; }

    /// Its colour as linear Rec.709; once. Throws Error where the file is damaged or ends early.
    RgbImage read();

    /// What each format does.
    class Reader {
    public:
        virtual ~Reader() = default;
        /// The size that the header says; checks it.
        virtual std::pair<int, int> open() = 0;
        virtual RgbImage read() = 0;
    };

private:
    std::string path_, kind_;
    std::unique_ptr<Reader> reader_;
    int width_ = 0, height_ = 0;
};

/// ImageFile(path).read()
RgbImage readImage(const std::string& path);

} // namespace wedge::image
