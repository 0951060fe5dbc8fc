#include "host/decode/hdr.h"

#include "host/decode/srgb.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace wedge::decode {

namespace {

std::string_view line(ByteReader& in)
{
    constexpr std::size_t longest = 4096;
    ByteReader ahead = in;
    for (std::size_t length = 0; length < longest; ++length) {
        if (ahead.byte() == '\n') {
            const Bytes bytes = in.take(length + 1);
            const std::string_view text(reinterpret_cast<const char*>(bytes.data()), length);
            return text.ends_with('\r') ? text.substr(0, length - 1) : text; // lines of another system
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
    const std::string whole(text);
    if (!number("-Y ", size.height) || !number(" +X ", size.width) || !text.empty())
        throw Failure("its rows do not go from top to bottom and left to right (-Y N +X M), but '" + whole + "'",
            "save it in this order, or check that the file is whole");
    return size;
}

[[noreturn]] void failOfVariable(std::string_view line, const std::string& wanted)
{
    throw Failure("its header has '" + std::string(line) + "', which is not " + wanted,
        "repair the line, or write the file anew");
}

/// The numbers behind "NAME=", as many as are wanted.
template <std::size_t Count>
std::array<double, Count> numbers(std::string_view line, const std::string& wanted)
{
    constexpr std::string_view spaces = " \t\r";
    std::array<double, Count> values {};
    std::string_view text = line.substr(line.find('=') + 1);
    const auto skipSpaces = [&] { text.remove_prefix(std::min(text.find_first_not_of(spaces), text.size())); };
    for (double& value : values) {
        skipSpaces();
        if (text.starts_with('+'))
            text.remove_prefix(1);
        const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (status != std::errc() || !std::isfinite(value))
            failOfVariable(line, wanted);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (!text.empty() && spaces.find(text.front()) == std::string_view::npos)
            failOfVariable(line, wanted);
    }
    skipSpaces();
    if (!text.empty())
        failOfVariable(line, wanted);
    return values;
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
    for (std::string_view text = line(in_); !text.empty(); text = line(in_))
        readVariable(text);
    if (!hasFormat_)
        throw Failure("it does not say that its format is 32-bit_rle_rgbe");
    for (const double factor : multiplied_) {
        if (!(factor >= 1e-30 && factor <= 1e30))
            throw Failure("its EXPOSURE and COLORCORR lines come to a factor that is out of range",
                "repair the lines, or write the file anew");
    }
    size_ = resolution(line(in_));
}

void HdrReader::readVariable(std::string_view line)
{
    const auto multiply = [&](std::size_t channel, double factor) {
        if (!(factor > 0.0))
            failOfVariable(line, "above 0");
        multiplied_[channel] *= factor;
    };
    if (line.starts_with("FORMAT=")) {
        if (line != "FORMAT=32-bit_rle_rgbe")
            throw Failure("its format is not 32-bit_rle_rgbe", "save it as RGBE");
        hasFormat_ = true;
    } else if (line.starts_with("EXPOSURE=")) {
        const double factor = numbers<1>(line, "a number")[0];
        for (std::size_t channel = 0; channel < 3; ++channel)
            multiply(channel, factor);
    } else if (line.starts_with("COLORCORR=")) {
        const auto factors = numbers<3>(line, "three numbers");
        for (std::size_t channel = 0; channel < 3; ++channel)
            multiply(channel, factors[channel]);
    } else if (line.starts_with("PRIMARIES=")) {
        const auto p = numbers<8>(line, "eight numbers");
        matrix_ = matrixToRec709({ { p[0], p[1] }, { p[2], p[3] }, { p[4], p[5] }, { p[6], p[7] } });
    } else if (line.starts_with("GAMMA=")) {
        if (numbers<1>(line, "a number")[0] != 1.0)
            throw Failure(
                "its pixels are encoded, by its line '" + std::string(line) + "'", "save it with linear pixels");
    }
}

float HdrReader::value(const Rgbe& pixel, std::size_t channel) const
{
    constexpr double most = std::numeric_limits<float>::max();
    const float stored = hdrValue(pixel[channel], pixel[3]);
    return static_cast<float>(std::min(stored / multiplied_[channel], most));
}

std::array<float, 3> HdrReader::radiance(const Rgbe& pixel) const
{
    const std::array<float, 3> values { value(pixel, 0), value(pixel, 1), value(pixel, 2) };
    return matrix_ ? converted(*matrix_, values) : values;
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

Picture decodeHdrFor(TextureUse use, Bytes bytes, const Limits& limits)
{
    HdrReader reader(bytes);
    limits.admit(reader.size(), bytes.size());
    const bool colours = use == TextureUse::Colours;
    const auto encode = [&](float value) { return byteOf(colours ? encodeSrgb(std::min(value, 1.0f)) : value); };
    std::array<std::vector<std::uint8_t>, 3> encoded; // of exponent and mantissa, each channel
    for (std::size_t c = 0; c < 3; ++c) {
        encoded[c].resize(1 << 16);
        for (std::size_t i = 0; i < encoded[c].size(); ++i) {
            const auto mantissa = static_cast<std::uint8_t>(i % 256), exponent = static_cast<std::uint8_t>(i / 256);
            encoded[c][i] = encode(reader.value({ mantissa, mantissa, mantissa, exponent }, c));
        }
    }
    Picture picture(reader.size());
    picture.sameForAllUses = false;
    reader.readRows([&](int y, std::span<const Rgbe> pixels) {
        std::uint32_t* row = picture.rowFromTop(y);
        for (std::size_t x = 0; x < pixels.size(); ++x) {
            const Rgbe& p = pixels[x];
            const std::size_t scale = std::size_t { p[3] } * 256;
            if (colours && reader.matrix()) {
                const std::array<float, 3> colour = reader.radiance(p);
                row[x] = packRgba(encode(colour[0]), encode(colour[1]), encode(colour[2]));
            } else {
                row[x] = packRgba(encoded[0][scale + p[0]], encoded[1][scale + p[1]], encoded[2][scale + p[2]]);
            }
        }
    });
    return picture;
}

Picture decodeHdr(Bytes bytes, const Limits& limits) { return decodeHdrFor(TextureUse::Colours, bytes, limits); }

} // namespace wedge::decode
