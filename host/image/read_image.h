#pragma once

#include "host/decode/limits.h"
#include "host/image/image.h"

#include <memory>
#include <string>

namespace wedge::image {

/// An image file that is open, of which the header alone has been read: its size is known before anything is decoded.
/// The format is told by the extension in either case: .exr (root R, G, B or Y), .png, .hdr (Radiance). The picture is
/// the display window of an EXR, of which the data window is the part that is stored; others store all of theirs.
class ImageFile {
public:
    /// What a header says.
    struct Header {
        int width = 0, height = 0; ///< of the picture
        Window data; ///< the pixels in the file, which may go beyond the picture
        std::size_t bytes = 0; ///< of the file
        bool isCubeMap = false; ///< an EXR's envmap attribute that is not `latlong`
    };

    /// Throws Error for other extensions, and for files that cannot be read, are beyond the limits, or store nothing of
    /// their picture.
    explicit ImageFile(const std::string& path, const decode::Limits& limits = decode::referenceLimits);
    ~ImageFile();

    int width() const { return header_.width; }
    int height() const { return header_.height; }
    Window whole() const { return { 0, 0, width(), height() }; }
    /// The part of the picture that is stored.
    const Window& stored() const { return stored_; }
    bool isCubeMap() const { return header_.isCubeMap; }

    /// That part of the picture as linear Rec.709, black where nothing is stored; once. Throws Error where the file is
    /// damaged or ends early, and where the part is beyond the limits.
    RgbImage read(const Window& part);
    /// The whole picture.
    RgbImage read() { return read(whole()); }

    /// What each format does.
    class Reader {
    public:
        virtual ~Reader() = default;
        /// Reads the header and checks it.
        virtual Header open() = 0;
        /// All pixels in the file.
        virtual RgbImage read() = 0;
    };

private:
    std::string path_, kind_;
    decode::Limits limits_;
    std::unique_ptr<Reader> reader_;
    Header header_;
    Window stored_;
};

/// The whole picture of a file, as ImageFile reads it.
RgbImage readImage(const std::string& path);

} // namespace wedge::image
