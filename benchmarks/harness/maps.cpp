#include "benchmarks/harness/maps.h"

#include "benchmarks/harness/heat_map.h"
#include "host/error.h"
#include "host/image/png.h"
#include "host/render/layers.h"
#include "kernels/shared/frame.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

namespace fs = std::filesystem;

/// Writes maps of one frame.
class MapWriter {
public:
    MapWriter(Lab& lab, const render::Settings& settings, const std::string& folder)
        : lab_(lab)
        , settings_(settings)
        , folder_(folder)
    {
    }

    /// Counts go logarithmically from 1.
    void write(const std::string& quantity, const std::string& unit, const std::vector<float>& values, bool logarithmic)
    {
        Map map { pathOf("_" + quantity), quantity, unit, logarithmic ? 1.0 : 0.0, 0.0, logarithmic };
        std::vector<float> sorted = values;
        const auto place = sorted.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(sorted.size() - 1));
        std::ranges::nth_element(sorted, place);
        map.high = std::max(static_cast<double>(*place), map.low + 1e-6);
        image::writePng(map.file, heatMap(values, settings_.width, settings_.height, map.low, map.high, logarithmic));
        maps.push_back(std::move(map));
    }

    std::string pathOf(const std::string& suffix) const
    {
        return (fs::path(folder_) / fmt::format("{}{}.png", lab_.name(), suffix)).string();
    }

    std::vector<Map> maps;

private:
    Lab& lab_;
    const render::Settings& settings_;
    std::string folder_;
};

/// "width_indirect" of the channel "filterWidthIndirect.pixels"; "" of other channels.
std::string widthName(const std::string& channel)
{
    const std::string before = "filterWidth", after = ".pixels";
    if (!channel.starts_with(before) || !channel.ends_with(after)) {
        return "";
    }
    std::string term = channel.substr(before.size(), channel.size() - before.size() - after.size());
    std::ranges::transform(term, term.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return "width_" + (term.empty() ? "light" : term);
}

} // namespace

std::vector<Map> writeMaps(Lab& lab, render::Settings settings, const std::string& folder)
{
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) {
        throw Error("folder for maps", folder, failed.message() + ", name another one");
    }
    settings.width = lab.plan().width;
    settings.height = lab.plan().height;
    settings.seed = 1;
    render::Renderer& renderer = lab.renderer();
    const render::FrameStatistics frame = renderer.render(settings, {}, true);
    const image::LayeredImage layers = render::readLayers(renderer, settings, frame, { "samples", "filterWidth" });
    MapWriter writer(lab, settings, folder);
    image::writePng(writer.pathOf(""), image::beauty(layers));
    writer.write("samples", "samples/pixel", layers.find("samples.Y")->values, true);
    // A pinhole scene file has none of the rest.
    const image::LayeredImage blurs =
        render::readLayers(renderer, settings, frame, { "filterWidthLens", "filterWidthMotion", "primarySamples" });
    if (renderer.frame().distributed) {
        writer.write("primary", "samples/pixel", blurs.find("primarySamples.Y")->values, true);
        writer.write("width_lens", "pixels", blurs.find("filterWidthLens.pixels")->values, false);
    }
    if (scene::geometryMoves(renderer.scene()) || scene::cameraMoves(renderer.scene())) {
        writer.write("width_motion", "pixels", blurs.find("filterWidthMotion.pixels")->values, false);
    }
    for (const image::Channel& channel : layers.channels) {
        if (const std::string name = widthName(channel.name); !name.empty()) {
            writer.write(name, "pixels", channel.values, false);
        }
    }
    lab.say(fmt::format("{} maps in {}", writer.maps.size(), folder));
    return std::move(writer.maps);
}

} // namespace wedge::benchmark
