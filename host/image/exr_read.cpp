#include "host/image/exr.h"
#include "host/image/exr_attributes.h"
#include "host/image/input_checks.h"

#include "host/error.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <algorithm>

namespace wedge::image {

namespace {

std::map<std::string, MetadataValue> readMetadata(const Imf::Header& header)
{
    std::map<std::string, MetadataValue> metadata;
    for (auto it = header.begin(); it != header.end(); ++it) {
        const std::string name = it.name();
        const Imf::Attribute* attribute = &it.attribute();
        if (isFormatAttribute(name))
            continue;
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(attribute)) {
            metadata[name] = text->value();
        } else if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(attribute)) {
            metadata[name] = real->value();
        } else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(attribute)) {
            metadata[name] = whole->value();
        } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(attribute)) {
            std::array<float, 16> values;
            std::copy_n(matrix->value().getValue(), values.size(), values.begin());
            metadata[name] = values;
        }
    }
    return metadata;
}

void requireSize(const std::string& path, const Imf::Header& header)
{
    // Wide integers, because a damaged file may name any corner.
    const Imath::Box2i data = header.dataWindow();
    const Imath::Box2i display = header.displayWindow();
    int channels = 0;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        ++channels;
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
            throw Error(
                std::string("EXR channel ") + it.name() + " is subsampled", path, "convert the image to R, G and B");
    }
    requireDecodable(
        path, std::int64_t { data.max.x } - data.min.x + 1, std::int64_t { data.max.y } - data.min.y + 1, 4 * channels);
    requireDecodable(path, std::int64_t { display.max.x } - display.min.x + 1,
        std::int64_t { display.max.y } - display.min.y + 1, 1);
}

LayeredImage read(const std::string& path)
{
    Imf::InputFile file(path.c_str());
    const Imf::Header& header = file.header();
    requireSize(path, header);
    const Imath::Box2i data = header.dataWindow();
    const Imath::Box2i display = header.displayWindow();
    LayeredImage image;
    image.width = display.max.x - display.min.x + 1;
    image.height = display.max.y - display.min.y + 1;
    image.window = { data.min.x - display.min.x, data.min.y - display.min.y, data.max.x - display.min.x + 1,
        data.max.y - display.min.y + 1 };
    image.metadata = readMetadata(header);
    const std::size_t pixels = static_cast<std::size_t>(image.window.width()) * image.window.height();
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
        image.channels.push_back({ it.name(), std::vector<float>(pixels), it.channel().type == Imf::UINT });
    Imf::FrameBuffer frame;
    for (Channel& channel : image.channels) // half and uint are converted to float by OpenEXR
        frame.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), data));
    file.setFrameBuffer(frame);
    file.readPixels(data.min.y, data.max.y);
    return image;
}

} // namespace

LayeredImage readExr(const std::string& path)
{
    requireReadableFile(path, "EXR image");
    try {
        return read(path);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        // OpenEXR names the file as well, which the user need not read twice.
        const std::string reason = error.what();
        const std::size_t named = reason.find(path + "\". ");
        failToRead(path, "EXR image", named == std::string::npos ? reason : reason.substr(named + path.size() + 3));
    }
}

} // namespace wedge::image
