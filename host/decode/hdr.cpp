#include "host/decode/hdr.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace wedge::decode {

namespace {

std::string_view line(ByteReader& in)
{
    constexpr std::size_t longest = 4096;
    ByteReader ahead = in;
    for (std::size_t length = 0; length < longest; ++length) {
        if (ahead.byte() == '\n') {
            const Bytes bytes = in.take(length + 1);
            return { reinterpret_cast<const char*>(bytes.data()), length };
        }
    }
    throw Failure("a line of its header is too long");
}

/// "-Y 480 +X 640"
Size resolution(std::string_view text)
{
    Size size;
    const auto number = [&](std::string_view axis, int& value) {
        if (!text.starts_with(axis))
            return false;
        text.remove_prefix(axis.size());
        const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        return status == std::errc() && value > 0;
    };
    if (!number("-Y ", size.height) || !number(" +X ", size.width) || !text.empty())
        throw Failure("its rows do not go from top to bottom and left to right (-Y N +X M)",
            "save it in this order, or check that the file is whole");
    return size;
}

/// A row in which each of the four channels has runs of its own.
void readNewRuns(ByteReader& in, std::span<Rgbe> row)
{
    for (std::size_t channel = 0; channel < 4; ++channel) {
        for (std::size_t x = 0; x < row.size();) {
            const unsigned code = in.byte();
            const std::size_t count = code > 128 ? code - 128 : code;
            if (count == 0 || count > row.size() - x)
                throw Failure("a run of pixels is empty or goes beyond its row");
            const std::uint8_t* values = in.take(code > 128 ? 1 : count).data();
            for (std::size_t i = 0; i < count; ++i)
                row[x++][channel] = values[code > 128 ? 0 : i];
        }
    }
}

/// A row of pixels, where (1, 1, 1, n) repeats the one before n times; directly behind another, n * 256 times.
void readPixels(ByteReader& in, std::span<Rgbe> row)
{
    int shift = 0;
    for (std::size_t x = 0; x < row.size();) {
        const Bytes p = in.take(4);
        if (p[0] != 1 || p[1] != 1 || p[2] != 1) {
            row[x++] = { p[0], p[1], p[2], p[3] };
            shift = 0;
            continue;
        }
        const std::size_t count = shift < 24 ? std::size_t { p[3] } << shift : row.size();
        if (x == 0 || count > row.size() - x)
            throw Failure("a run of pixels has no pixel or goes beyond its row");
        std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), count, row[x - 1]);
        x += count;
        shift += 8;
    }
}

} // namespace

HdrReader::HdrReader(Bytes bytes)
    : in_(bytes)
{
    const std::string_view first = line(in_);
    if (first != "#?RADIANCE" && first != "#?RGBE")
        throw Failure("it is not Radiance HDR");
    bool known = false;
    for (std::string_view text = line(in_); !text.empty(); text = line(in_)) {
        if (text.starts_with("FORMAT=") && text != "FORMAT=32-bit_rle_rgbe")
            throw Failure("its format is not 32-bit_rle_rgbe", "save it as RGBE");
        known |= text.starts_with("FORMAT=");
    }
    if (!known)
        throw Failure("it does not say that its format is 32-bit_rle_rgbe");
    size_ = resolution(line(in_));
}

void HdrReader::readRows(const std::function<void(int y, std::span<const Rgbe> pixels)>& row)
{
    std::vector<Rgbe> pixels(static_cast<std::size_t>(size_.width));
    const bool mayHaveNewRuns = size_.width >= 8 && size_.width < 32768;
    for (int y = 0; y < size_.height; ++y) {
        ByteReader ahead = in_;
        const Bytes mark = ahead.take(4);
        if (mayHaveNewRuns && mark[0] == 2 && mark[1] == 2 && mark[2] < 128) {
            if ((mark[2] << 8 | mark[3]) != size_.width)
                throw Failure("one of its rows has another width");
            in_ = ahead;
            readNewRuns(in_, pixels);
        } else {
            readPixels(in_, pixels);
        }
        row(y, pixels);
    }
}

float hdrValue(std::uint8_t mantissa, std::uint8_t exponent)
{
    return exponent == 0 ? 0.0f : std::ldexp(static_cast<float>(mantissa), exponent - 136);
}

Picture decodeHdr(Bytes bytes, const Limits& limits)
{
    HdrReader reader(bytes);
    limits.admit(reader.size(), bytes.size());
    std::vector<std::uint8_t> encoded(1 << 16); // of exponent and mantissa
    for (std::size_t i = 0; i < encoded.size(); ++i) {
        const float value = hdrValue(static_cast<std::uint8_t>(i % 256), static_cast<std::uint8_t>(i / 256));
        encoded[i] = static_cast<std::uint8_t>(std::pow(std::min(value, 1.0f), 1.0f / 2.2f) * 255.0f + 0.5f);
    }
    Picture picture(reader.size());
    reader.readRows([&](int y, std::span<const Rgbe> pixels) {
        std::uint32_t* row = picture.rowFromTop(y);
        for (std::size_t x = 0; x < pixels.size(); ++x) {
            const Rgbe& p = pixels[x];
            const std::size_t scale = std::size_t { p[3] } * 256;
            row[x] = packRgba(encoded[scale + p[0]], encoded[scale + p[1]], encoded[scale + p[2]]);
        }
    });
    return picture;
}

} // namespace wedge::decode
