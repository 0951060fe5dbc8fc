#include "host/render/layers.h"

#include "host/error.h"
#include "host/render/effect.h"
#include "host/render/metadata.h"

#include <algorithm>
#include <cassert>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::render {
namespace {

constexpr const char* widthLayer = "filterWidth";
constexpr const char* lensWidthLayer = "filterWidthLens";
constexpr const char* motionWidthLayer = "filterWidthMotion";

/// Copies planes of the frame to channels of the image over the output's window.
class LayerReader {
public:
    LayerReader(Renderer& renderer, const Settings& settings, const image::Window& window, image::LayeredImage& image)
        : renderer_(renderer)
        , settings_(settings)
        , window_(window)
        , image_(image)
        , objectId_(renderer.frame().objectId.downloadAll(renderer.queue()))
    {
    }

    const Frame& frame() const { return renderer_.frame(); }

    enum class Where { Everywhere, OnSurfaces }; ///< OnSurfaces: 0 where nothing was hit

    /// One channel a letter of `letters`, from consecutive planes.
    void vector(const std::string& layer, const char* letters, const device::Buffer<float>& planes, Where where)
    {
        const std::vector<float> values = planes.downloadAll(renderer_.queue());
        for (std::size_t k = 0; letters[k] != '\0'; ++k) {
            const std::size_t offset = k * frame().layout.size;
            channel(layer + letters[k], where, [&](std::size_t i) { return values[offset + i]; });
        }
    }

    void depth()
    {
        const std::vector<float> values = frame().depth.downloadAll(renderer_.queue());
        channel("depth.Z", Where::Everywhere, [&](std::size_t i) { return values[i]; });
    }

    void samples()
    {
        const std::vector<std::uint32_t> values = frame().samples.downloadAll(renderer_.queue());
        channel("samples.Y", Where::OnSurfaces, [&](std::size_t i) { return static_cast<float>(values[i]); });
    }

    void rays()
    {
        const std::vector<std::uint32_t> values = frame().rays.downloadAll(renderer_.queue());
        const std::vector<std::uint32_t> primary = primarySamplesOf();
        channel("rays.Y", Where::Everywhere, [&](std::size_t i) { return static_cast<float>(primary[i] + values[i]); });
    }

    void primarySamples()
    {
        const std::vector<std::uint32_t> values = primarySamplesOf();
        channel("primarySamples.Y", Where::Everywhere, [&](std::size_t i) { return static_cast<float>(values[i]); });
    }

    /// What is reflected: everywhere in distributed frames, where filters carry it to pixels that hit nothing
    /// themselves.
    void reflected(const std::string& layer, const device::Buffer<float>& planes)
    {
        vector(layer, "RGB", planes, frame().distributed ? Where::Everywhere : Where::OnSurfaces);
    }

    void unfiltered(const std::string& layer) { reflected(layer + ".", frame().unfiltered.at(layer)); }

    /// Of an image whose pixels have one primary sample: 0.
    void ofDistributed(const std::string& layer, const char* letters, const device::Buffer<float>& planes)
    {
        if (frame().distributed) {
            vector(layer, letters, planes, Where::Everywhere);
            return;
        }
        for (; *letters != '\0'; ++letters) {
            channel(layer + *letters, Where::Everywhere, [](std::size_t) { return 0.0f; });
        }
    }

    /// 0 also where the image is not filtered.
    void blurWidth(const std::string& name, const device::Buffer<float>& plane)
    {
        const bool filtered =
            frame().distributed && settings_.filtering != Filtering::None && settings_.distributed.blur;
        const std::vector<float> values =
            filtered ? plane.downloadAll(renderer_.queue()) : std::vector<float>(frame().layout.size, 0.0f);
        channel(name + ".pixels", Where::Everywhere, [&](std::size_t i) { return values[i]; });
    }

    void objectId()
    {
        channel("objectId.I", Where::Everywhere, [&](std::size_t i) { return static_cast<float>(objectId_[i]); });
        image_.channels.back().integer = true;
    }

    /// 0 where the term is not (the analysis has -1 there), and of terms that an early stop kept from being analysed.
    void filterWidths()
    {
        const std::vector<float> pixelSize = frame().pixelSize.downloadAll(renderer_.queue());
        const std::vector<float> none(frame().layout.size, 0.0f);
        for (const TermPlanes& term : renderer_.termPlanes()) {
            const std::vector<float>& beta = term.beta.empty() ? none : term.beta;
            const std::string name = widthLayer + term.name;
            channel(name + ".world", Where::OnSurfaces, [&](std::size_t i) { return std::max(0.0f, beta[i]); });
            channel(name + ".pixels", Where::OnSurfaces,
                [&](std::size_t i) { return pixelSize[i] > 0 ? std::max(0.0f, beta[i]) / pixelSize[i] : 0.0f; });
        }
    }

    /// Of each term that has some; 0 of those that an early stop kept from being filtered.
    void ofTerms(const TermLayer& layer)
    {
        for (const TermPlanes& term : renderer_.termPlanes()) {
            const std::string name = layer.info.name + term.name;
            const auto known = frame().termLayers.find(name);
            if (known == frame().termLayers.end()) {
                continue;
            }
            const std::vector<float> values = known->second.downloadAll(renderer_.queue());
            assert(values.size() == layer.channels.size() * frame().layout.size);
            for (std::size_t plane = 0; plane < layer.channels.size(); ++plane) {
                const std::size_t offset = plane * frame().layout.size;
                channel(name + "." + layer.channels[plane], Where::OnSurfaces,
                    [&](std::size_t i) { return values[offset + i]; });
            }
        }
    }

    const Settings& settings() const { return settings_; }

private:
    std::vector<std::uint32_t> primarySamplesOf()
    {
        return frame().distributed ? frame().primaryTaken.downloadAll(renderer_.queue())
                                   : std::vector<std::uint32_t>(frame().layout.size, 1u);
    }

    template <class Value>
    void channel(const std::string& name, Where where, const Value& value)
    {
        image::Channel out { name, {}, false };
        out.values.reserve(static_cast<std::size_t>(window_.width()) * window_.height());
        for (int y = window_.y0; y < window_.y1; ++y) {
            for (int x = window_.x0; x < window_.x1; ++x) {
                const std::size_t i = shared::pixelIndex(
                    static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), frame().layout.stride);
                out.values.push_back(where == Where::Everywhere || objectId_[i] != 0 ? value(i) : 0.0f);
            }
        }
        image_.channels.push_back(std::move(out));
    }

    Renderer& renderer_;
    const Settings& settings_;
    image::Window window_;
    image::LayeredImage& image_;
    std::vector<std::uint32_t> objectId_;
};

using Where = LayerReader::Where;

struct Layer {
    LayerInfo info;
    std::function<void(LayerReader&)> read;
};

/// How layers of filter widths are called.
std::string widthLayers()
{
    std::vector<std::string> names;
    for (const auto& effect : effects()) {
        if (std::string name = effect->widthLayers(); !name.empty()) {
            names.push_back(std::move(name));
        }
    }
    return fmt::format("{}", fmt::join(names, "; "));
}

/// Those of effects last.
std::vector<Layer> layerTable()
{
    std::vector<Layer> table = {
        { { "albedo", "R G B: diffuse reflectance with its texture, 0 on a miss" },
            [](LayerReader& r) { r.vector("albedo.", "RGB", r.frame().diffuse, Where::OnSurfaces); } },
        { { "normal", "X Y Z: unit shading normal in world space on the viewer's side, 0 on a miss" },
            [](LayerReader& r) { r.vector("normal.", "XYZ", r.frame().normal, Where::OnSurfaces); } },
        { { "position", "X Y Z: point hit in world space, metres, 0 on a miss" },
            [](LayerReader& r) { r.vector("position.", "XYZ", r.frame().position, Where::OnSurfaces); } },
        { { "depth", "Z: distance along the ray, metres, to a surface or a visible light; +inf on a miss" },
            [](LayerReader& r) { r.depth(); } },
        { { "emission", "R G B: radiance of emitting surfaces, lights and background seen directly" },
            [](LayerReader& r) { r.vector("emission.", "RGB", r.frame().emission, Where::Everywhere); } },
        { { "direct", "R G B: radiance reflected from lights, filtered; beauty = emission + direct + indirect" },
            [](LayerReader& r) { r.reflected("direct.", r.frame().direct); } },
        { { "directNoisy", "R G B: the same before the filter" },
            [](LayerReader& r) { r.reflected("directNoisy.", r.frame().directNoisy); } },
        { { "indirect", "R G B: radiance reflected from other surfaces, filtered; of ambient occlusion what is open" },
            [](LayerReader& r) { r.reflected("indirect.", r.frame().indirect); } },
        { { "indirectNoisy", "R G B: the same before the filter" },
            [](LayerReader& r) { r.reflected("indirectNoisy.", r.frame().indirectNoisy); } },
        { { "samples", "Y: samples taken of all terms (lights, indirect diffuse, indirect glossy) together" },
            [](LayerReader& r) { r.samples(); } },
        { { "rays", "Y: rays traced for the pixel, the camera's included" }, [](LayerReader& r) { r.rays(); } },
        { { widthLayer,
              "world, pixels: standard deviation of the filter in metres and in pixels, 0 where the term is not "
              "(method aaf; "
                  + widthLayers() + ")" },
            [](LayerReader& r) { r.filterWidths(); } },
        { { lensWidthLayer,
              "pixels: standard deviation of the image's filter of what the lens blurs, 0 where there is none "
              "(method aaf)" },
            [](LayerReader& r) { r.blurWidth(lensWidthLayer, r.frame().lensWidth); } },
        { { motionWidthLayer, "pixels: the same of textures of what moves, along its motion" },
            [](LayerReader& r) { r.blurWidth(motionWidthLayer, r.frame().motionWidth); } },
        { { "motion",
              "U V: pixels to the right and down that the surface moves while the shutter is open, 0 on a miss" },
            [](LayerReader& r) { r.ofDistributed("motion.", "UV", r.frame().motion); } },
        { { "primarySamples", "Y: rays from the camera, 1 without lens, shutter and antialiasing" },
            [](LayerReader& r) { r.primarySamples(); } },
        { { "objectId", "I: number of the object hit, from 1; 0 on a miss, 4294967295 where several are" },
            [](LayerReader& r) { r.objectId(); } },
    };
    for (const auto& effect : effects()) {
        if (const std::optional<LayerInfo> layer = effect->layer()) {
            table.push_back({ *layer, [name = layer->name](LayerReader& r) { r.unfiltered(name); } });
        }
        if (const std::optional<TermLayer> layer = effect->termLayer({})) {
            table.push_back(
                { layer->info, [&effect](LayerReader& r) { r.ofTerms(effect->termLayer(r.settings()).value()); } });
        }
    }
    return table;
}

/// Why the layer cannot be made; "" if it can.
std::string obstacle(const std::string& layer, const Settings& settings, const PreparedScene& scene)
{
    const std::vector<Term> terms = frameTerms(settings, scene);
    if (layer.starts_with("indirect") && countOf(Part::Indirect, terms) == 0) {
        return absenceOf(Part::Indirect);
    }
    for (const auto& effect : effects()) {
        const std::optional<LayerInfo> own = effect->layer();
        if (own && own->name == layer && !effect->unfiltered(settings, scene)) {
            return "the frame has no " + effect->name();
        }
        const std::optional<TermLayer> ofTerms = effect->termLayer(settings);
        if (ofTerms && ofTerms->info.name == layer && ofTerms->channels.empty()) {
            return ofTerms->absence;
        }
    }
    if (!layer.starts_with(widthLayer)) {
        return "";
    }
    if (settings.method != Method::AxisAligned) {
        return "method " + methodName(settings.method) + " has no filter";
    }
    return layer == widthLayer && terms.empty() ? absenceOf(Part::Direct) : "";
}

std::vector<std::string> split(const std::string& list)
{
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= list.size();) {
        const std::size_t comma = std::min(list.find(',', at), list.size());
        parts.push_back(list.substr(at, comma - at));
        at = comma + 1;
    }
    return parts;
}

bool contains(const std::vector<std::string>& names, const std::string& name)
{
    return std::ranges::find(names, name) != names.end();
}

} // namespace

std::vector<LayerInfo> knownLayers()
{
    std::vector<LayerInfo> out;
    for (const Layer& layer : layerTable()) {
        out.push_back(layer.info);
    }
    return out;
}

std::vector<std::string> selectLayers(const std::string& list, const Settings& settings, const PreparedScene& scene)
{
    std::vector<std::string> known;
    for (const LayerInfo& info : knownLayers()) {
        known.push_back(info.name);
    }
    const std::vector<std::string> wanted = list.empty() ? std::vector<std::string> {} : split(list);
    for (const std::string& name : wanted) {
        if (name != "all" && !contains(known, name)) {
            throw UsageError("unknown layer", name, fmt::format("choose all or some of: {}", fmt::join(known, ", ")));
        }
        if (const std::string why = obstacle(name, settings, scene); !why.empty()) {
            throw UsageError("layer cannot be made, " + why, name, "leave it out of --layers");
        }
    }
    std::vector<std::string> selected;
    for (const std::string& name : known) {
        const bool inAll = contains(wanted, "all") && obstacle(name, settings, scene).empty();
        if (inAll || contains(wanted, name)) {
            selected.push_back(name);
        }
    }
    return selected;
}

image::LayeredImage readLayers(Renderer& renderer, const Settings& settings, const FrameStatistics& statistics,
    const std::vector<std::string>& layers)
{
    assert(layers.empty() || renderer.frame().keepsLayers);
    image::LayeredImage image;
    image.width = settings.width;
    image.height = settings.height;
    image.window = outputWindow(settings);
    image.metadata = frameMetadata(renderer, settings, statistics);
    LayerReader reader(renderer, settings, image.window, image);
    reader.vector("", "RGB", reader.frame().beauty, Where::Everywhere);
    for (const Layer& layer : layerTable()) {
        if (contains(layers, layer.info.name)) {
            layer.read(reader);
        }
    }
    return image;
}

} // namespace wedge::render
