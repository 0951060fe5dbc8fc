#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace wedge::decode {

struct Size {
    int width = 0, height = 0;
    std::int64_t pixels() const { return std::int64_t { width } * height; }
    bool operator==(const Size&) const = default;
};

constexpr std::int64_t defaultMaxPixels = std::int64_t { 1 } << 26;

/// What the header of an image may claim; held against it before memory is taken.
struct Limits {
    std::int64_t pixels = defaultMaxPixels;
    int side = 32768;
    /// Beyond so many pixels the claim is held against the size of the file: at most mostPixelsPerByte, and beyond
    /// twice as many usualPixelsPerByte.
    std::int64_t unquestioned = std::int64_t { 1 } << 23;
    /// No picture of real detail has more pixels a byte. It keeps a file of less than a megabyte below 2^25 pixels.
    std::int64_t usualPixelsPerByte = 32;
    /// Pixels that are left of what all images of a scene may have together.
    std::int64_t together = std::numeric_limits<std::int64_t>::max();
    /// Where admit() adds up the pixels that it has let through, if anywhere: a file costs its time also where it
    /// fails.
    std::int64_t* admitted = nullptr;
    /// How the user allows more.
    const char* remedy = "scale the image down";

    /// Throws Failure where an image of that size, in a file of so many bytes, is beyond the limits.
    void admit(Size size, std::size_t fileBytes) const;
};

/// Deflate packs no more than 1032 : 1, so that even a picture of one colour, of 8 bits a pixel or more, stays below
/// this.
constexpr std::int64_t mostPixelsPerByte = 1100;

/// For images that are measured: 32-bit floats, three a pixel, of any shape, and of the metrics 100 bytes a pixel and
/// half a microsecond: of less than a megabyte they have at most 2^22.
constexpr Limits referenceLimits {
    .side = 1 << 16, .unquestioned = std::int64_t { 1 } << 21, .usualPixelsPerByte = 4, .remedy = "use a smaller image"
};

} // namespace wedge::decode
