#include "host/image/atomic_file.h"
#include "host/image/exr.h"
#include "host/image/exr_attributes.h"

#include "host/error.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <stdexcept>
#include <thread>

namespace wedge::image {

namespace {

void requireConsistent(const LayeredImage& image)
{
    const Window& window = image.window;
    if (window.width() <= 0 || window.height() <= 0 || image.width <= 0 || image.height <= 0)
        throw std::logic_error("writeExr: empty window");
    const std::size_t pixels = static_cast<std::size_t>(window.width()) * window.height();
    for (const Channel& channel : image.channels) {
        if (channel.values.size() != pixels)
            throw std::logic_error("writeExr: channel " + channel.name + " does not fill the data window");
        if (image.find(channel.name) != &channel)
            throw std::logic_error("writeExr: two channels are named " + channel.name);
    }
    for (const auto& [name, value] : image.metadata)
        if (name.empty() || isFormatAttribute(name))
            throw std::logic_error("writeExr: OpenEXR keeps the attribute name '" + name + "' for itself");
}

struct AttributeWriter {
    Imf::Header& header;
    const std::string& name;

    void operator()(const std::string& value) const { header.insert(name, Imf::StringAttribute(value)); }
    void operator()(float value) const { header.insert(name, Imf::FloatAttribute(value)); }
    void operator()(int value) const { header.insert(name, Imf::IntAttribute(value)); }
    void operator()(const std::array<float, 16>& value) const
    {
        Imath::M44f matrix;
        std::copy(value.begin(), value.end(), matrix.getValue());
        header.insert(name, Imf::M44fAttribute(matrix));
    }
};

Imath::Box2i toBox(const Window& window) { return { { window.x0, window.y0 }, { window.x1 - 1, window.y1 - 1 } }; }

Imf::Header makeHeader(const LayeredImage& image)
{
    Imf::Header header(toBox({ 0, 0, image.width, image.height }), toBox(image.window));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addChromaticities(header, Imf::Chromaticities()); // its default is Rec.709 with white D65
    for (const auto& [name, value] : image.metadata)
        std::visit(AttributeWriter { header, name }, value);
    for (const Channel& channel : image.channels)
        header.channels().insert(channel.name, Imf::Channel(channel.integer ? Imf::UINT : Imf::FLOAT));
    return header;
}

std::vector<std::uint32_t> toIntegers(const std::vector<float>& values)
{
    std::vector<std::uint32_t> integers(values.size());
    std::transform(values.begin(), values.end(), integers.begin(), [](float value) -> std::uint32_t {
        if (!(value > 0.0f))
            return 0;
        if (value >= 4294967296.0f)
            return std::numeric_limits<std::uint32_t>::max();
        return static_cast<std::uint32_t>(std::llround(value));
    });
    return integers;
}

/// Compressing many float layers is the slowest part of writing; OpenEXR does it block by block on its own pool. Where
/// no thread can be had the picture is written without.
void startThreads()
{
    try {
        if (Imf::globalThreadCount() == 0)
            Imf::setGlobalThreadCount(static_cast<int>(std::max(1u, std::thread::hardware_concurrency())));
    } catch (const std::exception&) {
        Imf::setGlobalThreadCount(0);
    }
}

std::string encode(const LayeredImage& image)
{
    startThreads();
    Imf::StdOSStream stream;
    std::deque<std::vector<std::uint32_t>> integers;
    Imf::FrameBuffer frame;
    for (const Channel& channel : image.channels) {
        const void* data = channel.values.data();
        if (channel.integer)
            data = integers.emplace_back(toIntegers(channel.values)).data();
        frame.insert(
            channel.name, Imf::Slice::Make(channel.integer ? Imf::UINT : Imf::FLOAT, data, toBox(image.window)));
    }
    {
        // Its destructor writes the table of offsets.
        Imf::OutputFile file(stream, makeHeader(image));
        file.setFrameBuffer(frame);
        file.writePixels(image.window.height());
    }
    return stream.str();
}

} // namespace

void writeExr(const std::string& path, const LayeredImage& image)
{
    requireConsistent(image);
    AtomicFile file(path);
    // Encoded in memory, because OpenEXR swallows the errors of its last writes, and a full disk must be heard of.
    try {
        file.write(encode(image));
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(std::string("cannot encode EXR image (") + error.what() + ")", path,
            "write fewer layers or a smaller image");
    }
    file.commit();
}

} // namespace wedge::image
