#include "host/render/layers.h"

#include "host/error.h"
#include "host/render/effect.h"
#include "host/render/filter_chain.h"
#include "host/render/metadata.h"

#include <algorithm>
#include <cassert>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::render {
namespace {

constexpr const char* widthLayer = "filterWidth";

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

/// All layers, in their order; those of effects last. Frames show each by its name (Outputs).
std::vector<LayerInfo> layersOf(const Settings& settings, const PreparedScene* scene)
{
    const SampleFilter* samples = sampleFilterOf(settings).filter;
    const std::vector<std::string> rgb { "R", "G", "B" }, xyz { "X", "Y", "Z" };
    std::vector<LayerInfo> out = {
        { "albedo", rgb, "diffuse reflectance with its texture, 0 on a miss" },
        { "normal", xyz, "unit shading normal in world space on the viewer's side, 0 on a miss" },
        { "position", xyz, "point hit in world space, metres, 0 on a miss" },
        { "depth", { "Z" }, "distance along the ray, metres, to a surface or a visible light; +inf on a miss" },
        { "emission", rgb, "radiance of emitting surfaces, lights and background seen directly" },
        { "direct", rgb,
            "radiance reflected from lights, filtered; beauty = emission + direct + indirect, before filters of the "
            "image" },
        { "directNoisy", rgb, "the same before the filter" },
        { "indirect", rgb, "radiance reflected from other surfaces, filtered; of ambient occlusion what is open" },
        { "indirectNoisy", rgb, "the same before the filter" },
        { "samples", { "Y" }, "samples taken of all terms (lights, indirect diffuse, indirect glossy) together" },
        { "rays", { "Y" }, "rays traced for the pixel, the camera's included" },
        { widthLayer, { "world", "pixels" },
            "standard deviation of the filter in metres and in pixels, 0 where the term is not (method aaf; "
                + widthLayers() + ")" },
        { "filterWidthLens", { "pixels" },
            "standard deviation of the image's filter of what the lens blurs, 0 where there is none (method aaf)", "",
            0.0f },
        { "filterWidthMotion", { "pixels" }, "the same of textures of what moves, along its motion", "", 0.0f },
        { "motion", { "U", "V" },
            "pixels to the right and down that the surface moves while the shutter is open, 0 on a miss", "", 0.0f },
        { "primarySamples", { "Y" }, "rays from the camera, 1 without lens, shutter and antialiasing", "", 1.0f },
        { "pixelSize", { "Y" }, "side of the pixel as it projects to the surface, metres, 0 on a miss" },
        { "rejected", rgb,
            "of terms that a filter of samples goes over, what their means lost by it, as it arrives, before it is "
            "spread: rejectedIndirect, rejectedGlossy",
            samples != nullptr ? "" : "the frame has no filter of samples (--add-filter path-density)", 0.0f },
        { "pathDensity", { "Y" },
            "of the same terms how alone their samples are, for filter path-density: their mean distance to the "
            "nearest, 0 to 4 pixels",
            samples != nullptr && samples->measuresDensity() ? "" : "the frame has no filter path-density", 0.0f },
        { "objectId", { "I" }, "number of the object hit, from 1; 0 on a miss, 4294967295 where several are" },
    };
    for (const auto& effect : effects()) {
        std::ranges::move(effect->layers(settings, scene), std::back_inserter(out));
    }
    return out;
}

/// Copies planes of the renderer's frame to channels of an image, over its window.
class LayerReader {
public:
    LayerReader(Renderer& renderer, image::LayeredImage& image)
        : renderer_(renderer)
        , frame_(renderer.frame())
        , image_(image)
        , objectId_(frame_.counts("objectId").downloadAll(renderer.queue()))
    {
    }

    void beauty() { planes("", frame_.find("beauty"), { "R", "G", "B" }); }

    /// All outputs of that layer.
    void layer(const LayerInfo& info)
    {
        bool found = false;
        for (const Frame::Shown& shown : frame_.shown) {
            if (shown.output.layer == info.name) {
                planes(shown.output.name() + ".", shown, info.channels);
                found = true;
            }
        }
        if (!found && info.otherwise) {
            for (const std::string& channel : info.channels) {
                add(info.name + "." + channel, Where::Everywhere, [&](std::size_t) { return *info.otherwise; });
            }
        }
        assert(found || info.otherwise || info.name == widthLayer || !info.absence.empty());
    }

private:
    /// A channel for each of its first planes: behind normals lie those without maps.
    void planes(const std::string& prefix, const Frame::Shown& shown, const std::vector<std::string>& channels)
    {
        assert(shown.planes >= channels.size());
        const std::string name = shown.output.name();
        const auto each = [&](const auto& values) {
            for (std::size_t plane = 0; plane < channels.size(); ++plane) {
                const std::size_t first = plane * frame_.layout.size;
                add(prefix + channels[plane], shown.output.where,
                    [&](std::size_t i) { return static_cast<float>(values[first + i]); });
            }
        };
        if (shown.whole) {
            each(frame_.counts(name).downloadAll(renderer_.queue()));
        } else {
            each(frame_.planes(name).downloadAll(renderer_.queue()));
        }
        image_.channels.back().integer = shown.output.layer == "objectId";
    }

    template <class Value>
    void add(const std::string& name, Where where, const Value& value)
    {
        image::Channel out { name, {}, false };
        const image::Window& window = image_.window;
        out.values.reserve(static_cast<std::size_t>(window.width()) * window.height());
        for (int y = window.y0; y < window.y1; ++y) {
            for (int x = window.x0; x < window.x1; ++x) {
                const std::size_t i = frame_.layout.index(x, y);
                out.values.push_back(where == Where::Everywhere || objectId_[i] != 0 ? value(i) : 0.0f);
            }
        }
        image_.channels.push_back(std::move(out));
    }

    Renderer& renderer_;
    const Frame& frame_;
    image::LayeredImage& image_;
    std::vector<std::uint32_t> objectId_;
};

/// Why the layer cannot be made; "" if it can.
std::string obstacle(const LayerInfo& layer, const Settings& settings, const PreparedScene& scene)
{
    const std::vector<Term> terms = frameTerms(settings, scene);
    if (layer.name.starts_with("indirect") && countOf(Part::Indirect, terms) == 0) {
        return absenceOf(Part::Indirect);
    }
    if (!layer.absence.empty()) {
        return layer.absence;
    }
    if (!layer.name.starts_with(widthLayer)) {
        return "";
    }
    if (settings.method != Method::AxisAligned) {
        return "method " + methodName(settings.method) + " has no filter";
    }
    return layer.name == widthLayer && terms.empty() ? absenceOf(Part::Direct) : "";
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

std::vector<LayerInfo> knownLayers() { return layersOf({}, nullptr); }

std::vector<std::string> selectLayers(const std::string& list, const Settings& settings, const PreparedScene& scene)
{
    const std::vector<LayerInfo> layers = layersOf(settings, &scene);
    const std::vector<std::string> wanted = list.empty() ? std::vector<std::string> {} : split(list);
    for (const std::string& name : wanted) {
        const auto known = std::ranges::find(layers, name, &LayerInfo::name);
        if (name == "all") {
            continue;
        }
        if (known == layers.end()) {
            std::vector<std::string> names;
            std::ranges::transform(layers, std::back_inserter(names), &LayerInfo::name);
            throw UsageError("unknown layer", name, fmt::format("choose all or some of: {}", fmt::join(names, ", ")));
        }
        if (const std::string why = obstacle(*known, settings, scene); !why.empty()) {
            throw UsageError("layer cannot be made, " + why, name, "leave it out of --layers");
        }
    }
    std::vector<std::string> selected;
    for (const LayerInfo& layer : layers) {
        const bool inAll = contains(wanted, "all") && obstacle(layer, settings, scene).empty();
        if (inAll || contains(wanted, layer.name)) {
            selected.push_back(layer.name);
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
    LayerReader reader(renderer, image);
    reader.beauty();
    for (const LayerInfo& layer : layersOf(settings, &renderer.scene())) {
        if (contains(layers, layer.name)) {
            reader.layer(layer);
        }
    }
    return image;
}

} // namespace wedge::render
