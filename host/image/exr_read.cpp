#include "host/image/exr.h"
#include "host/image/exr_attributes.h"
#include "host/image/exr_header.h"
#include "host/image/readers.h"

#include "host/decode/failure.h"
#include "host/decode/limits.h"
#include "host/decode/primaries.h"
#include "host/file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <algorithm>
#include <optional>
#include <stdexcept>

namespace wedge::image {

namespace {

/// The file that was opened and checked; OpenEXR would open the name once more.
class FileStream : public Imf::IStream {
public:
    explicit FileStream(const std::string& path)
        : Imf::IStream(path.c_str())
        , file_(openFile(path, "EXR image"))
    {
    }
    std::uint64_t bytes() const { return file_.bytes; }

    bool read(char to[], int count) override
    {
        const auto wanted = static_cast<std::size_t>(count);
        if (count < 0 || std::fread(to, 1, wanted, file_.stream.get()) != wanted)
            throw std::runtime_error("it ends before the picture does");
        return tellg() < bytes();
    }
    std::uint64_t tellg() override { return static_cast<std::uint64_t>(ftello(file_.stream.get())); }
    void seekg(std::uint64_t position) override
    {
        if (fseeko(file_.stream.get(), static_cast<off_t>(std::min(position, bytes())), SEEK_SET) != 0)
            throw std::runtime_error("a place in it cannot be reached");
    }
    void clear() override { std::clearerr(file_.stream.get()); }

private:
    OpenFile file_;
};

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

/// What makes its colours those of Rec.709, if anything does; they are where it has no chromaticities.
std::optional<decode::ColourMatrix> matrixOf(const Imf::Header& header)
{
    if (!Imf::hasChromaticities(header))
        return std::nullopt;
    const auto point = [](const Imath::V2f& xy) { return decode::Chromaticity { xy.x, xy.y }; };
    const Imf::Chromaticities& c = Imf::chromaticities(header);
    std::optional<decode::Chromaticity> neutral;
    if (Imf::hasAdoptedNeutral(header))
        neutral = point(Imf::adoptedNeutral(header));
    return decode::matrixToRec709({ point(c.red), point(c.green), point(c.blue), point(c.white) }, neutral);
}

class ExrImage : public ImageFile::Reader {
public:
    explicit ExrImage(const std::string& path, const decode::Limits& limits = decode::referenceLimits)
        : path_(path)
        , limits_(limits)
        , stream_(path)
    {
    }

    ImageFile::Header open() override
    {
        checkExrHeaders(stream_, stream_.bytes(), limits_);
        file_.emplace(stream_);
        const Imath::Box2i data = file_->header().dataWindow();
        const Imath::Box2i display = file_->header().displayWindow();
        layout_.width = display.max.x - display.min.x + 1;
        layout_.height = display.max.y - display.min.y + 1;
        layout_.window = { data.min.x - display.min.x, data.min.y - display.min.y, data.max.x - display.min.x + 1,
            data.max.y - display.min.y + 1 };
        const Imf::ChannelList& channels = file_->header().channels();
        for (auto it = channels.begin(); it != channels.end(); ++it) {
            layout_.channels.push_back({ it.name(), {}, it.channel().type == Imf::UINT });
        }
        const bool isCubeMap = Imf::hasEnvmap(file_->header()) && Imf::envmap(file_->header()) != Imf::ENVMAP_LATLONG;
        return { .width = layout_.width,
            .height = layout_.height,
            .data = layout_.window,
            .bytes = stream_.bytes(),
            .isCubeMap = isCubeMap };
    }

    /// The root colour over the data window, as Rec.709; other channels are passed over.
    RgbImage read() override
    {
        const auto channels = beautyChannels(layout_, path_);
        const bool gray = channels[0] == channels[1];
        RgbImage image { layout_.window.width(), layout_.window.height(), {} };
        image.rgb.resize(3 * pixels());
        const std::size_t pixelBytes = 3 * sizeof(float);
        Imf::FrameBuffer frame;
        for (std::size_t c = 0; c < (gray ? 1 : 3); ++c)
            frame.insert(channels[c]->name,
                Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + c, dataWindow(), pixelBytes,
                    pixelBytes * static_cast<std::size_t>(image.width)));
        readPixels(frame);
        for (std::size_t i = 0; gray && i < image.rgb.size(); i += 3)
            image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
        if (const auto matrix = matrixOf(file_->header()); matrix && !gray)
            decode::convert(*matrix, image.rgb);
        return image;
    }

    LayeredImage readAll()
    {
        constexpr std::size_t modest = std::size_t { 1 } << 26, perByte = 256;
        const std::size_t values = pixels() * layout_.channels.size();
        if (values > modest && values / perByte > stream_.bytes())
            throw decode::Failure("it has " + std::to_string(layout_.channels.size()) + " channels of "
                + std::to_string(pixels()) + " pixels in " + std::to_string(stream_.bytes()) + " bytes");
        LayeredImage image = layout_;
        image.metadata = readMetadata(file_->header());
        Imf::FrameBuffer frame;
        for (Channel& channel : image.channels) { // half and uint are converted to float by OpenEXR
            channel.values.resize(pixels());
            frame.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), dataWindow()));
        }
        readPixels(frame);
        return image;
    }

private:
    std::size_t pixels() const
    {
        return static_cast<std::size_t>(layout_.window.width()) * static_cast<std::size_t>(layout_.window.height());
    }
    Imath::Box2i dataWindow() const { return file_->header().dataWindow(); }
    void readPixels(const Imf::FrameBuffer& frame)
    {
        file_->setFrameBuffer(frame);
        file_->readPixels(dataWindow().min.y, dataWindow().max.y);
    }

    std::string path_;
    decode::Limits limits_;
    FileStream stream_;
    std::optional<Imf::InputFile> file_;
    LayeredImage layout_; // all but values and metadata
};

} // namespace

std::unique_ptr<ImageFile::Reader> exrReader(const std::string& path, const decode::Limits& limits)
{
    return std::make_unique<ExrImage>(path, limits);
}

LayeredImage readExr(const std::string& path)
{
    try {
        ExrImage image(path);
        image.open();
        return image.readAll();
    } catch (const std::exception& error) {
        failToRead(path, "EXR image", error);
    }
}

} // namespace wedge::image
