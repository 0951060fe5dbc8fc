#include "benchmarks/common/references.h"

#include "benchmarks/common/fingerprint.h"
#include "host/device/source.h"
#include "host/error.h"
#include "host/image/exr.h"
#include "host/image/metrics.h"
#include "host/render/distributed_frame.h"
#include "host/render/effect.h"
#include "host/render/layers.h"
#include "host/render/metadata.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

constexpr const char* noiseKey = "referenceNoise";
constexpr const char* kernelsKey = "referenceKernels";
constexpr const char* deviationLayer = "deviation";

/// Of the kernels that an image, or a layer of it, is made by.
std::string kernelFingerprint(
    const render::Renderer& renderer, const render::Settings& settings, const std::string& layer)
{
    const bool distributed = render::isDistributed(settings, renderer.scene());
    std::vector<const char*> files = { distributed ? "waves/wave_primary.cl" : "frame/primary.cl" };
    if (distributed) {
        files.insert(files.end(), { "waves/waves.cl", "waves/accumulate.cl" });
    } else {
        files.push_back("frame/composite.cl");
    }
    if (layer != "indirect") {
        files.insert(files.end(), { "light/area_light.cl", "light/delta_lights.cl" });
    }
    if (render::tracesPaths(settings) || renderer.scene().picture() != nullptr) {
        files.push_back("paths/indirect.cl");
    }
    Fingerprint f;
    for (const char* file : files) {
        f.add(device::flattenKernel("", file).text);
    }
    return f.text();
}

std::string pathOf(const render::Renderer& renderer, const render::Settings& settings, const std::string& folder,
    const std::string& name, const std::string& layer)
{
    Fingerprint f;
    add(f, renderer.scene());
    f.add(layer);
    f.add(deviationLayer); // files without it are of older versions
    for (const auto& [key, value] : render::describe(settings)) {
        f.add(key);
        f.add(value);
    }
    f.add(settings.width);
    f.add(settings.height);
    f.add(settings.seed);
    f.add(settings.antialias);
    f.add(render::version());
    return (std::filesystem::path(folder) / fmt::format("{}_{}.exr", name, f.text())).string();
}

image::RgbImage half(
    render::Renderer& renderer, render::Settings settings, std::uint32_t index, const std::string& layer)
{
    settings.spp /= 2;
    settings.maxSpp = std::max(settings.maxSpp, settings.spp);
    settings.indirect.maxSpp = std::max(settings.indirect.maxSpp, settings.spp);
    settings.seed = 2 * settings.seed + index;
    const render::FrameStatistics statistics = renderer.render(settings, {}, !layer.empty());
    return imageOf(renderer, settings, statistics, layer);
}

/// Adds the channels PREFIX R, G and B.
void addChannels(image::LayeredImage& out, const std::string& prefix, const image::RgbImage& from)
{
    const std::size_t pixels = from.rgb.size() / 3;
    const char* names[] = { "R", "G", "B" };
    for (std::size_t c = 0; c < 3; ++c) {
        image::Channel channel { prefix + names[c], std::vector<float>(pixels) };
        for (std::size_t i = 0; i < pixels; ++i) {
            channel.values[i] = from.rgb[3 * i + c];
        }
        out.channels.push_back(std::move(channel));
    }
}

image::LayeredImage layered(const Reference& reference, const std::string& kernels)
{
    const image::RgbImage& from = reference.image;
    image::LayeredImage out;
    out.width = from.width;
    out.height = from.height;
    out.window = { 0, 0, from.width, from.height };
    addChannels(out, "", from);
    addChannels(out, deviationLayer + std::string("."), reference.deviation);
    out.metadata[noiseKey] = static_cast<float>(reference.noise);
    out.metadata[kernelsKey] = kernels;
    return out;
}

/// Leaves of all channels those of a layer, as the image's colour.
void takeForBeauty(image::LayeredImage& frame, const std::string& layer)
{
    std::erase_if(frame.channels, [&](const image::Channel& c) { return !c.name.starts_with(layer + "."); });
    for (image::Channel& channel : frame.channels) {
        channel.name.erase(0, layer.size() + 1);
    }
}

Reference readBack(const std::string& path, int spp, const std::string& usedKernels)
{
    image::LayeredImage file = image::readExr(path);
    const auto noise = file.metadata.find(noiseKey);
    const auto kernels = file.metadata.find(kernelsKey);
    if (noise == file.metadata.end() || kernels == file.metadata.end()) {
        throw Error("reference " + path, "was not written by a benchmark", "delete it");
    }
    Reference out { image::beauty(file, path), std::get<float>(noise->second), spp, path, true,
        std::get<std::string>(kernels->second) != usedKernels, {} };
    takeForBeauty(file, deviationLayer);
    out.deviation = image::beauty(file, path);
    return out;
}

} // namespace

image::RgbImage imageOf(render::Renderer& renderer, const render::Settings& settings,
    const render::FrameStatistics& statistics, const std::string& layer)
{
    const std::vector<std::string> layers = layer.empty() ? std::vector<std::string> {} : std::vector { layer };
    image::LayeredImage frame = render::readLayers(renderer, settings, statistics, layers);
    if (!layer.empty()) {
        takeForBeauty(frame, layer);
    }
    image::RgbImage image = image::beauty(frame, layer);
    if (!std::ranges::all_of(image.rgb, [](float v) { return std::isfinite(v); })) {
        throw Error("rendered image", "has a value that is not finite", "this is a fault in wedge, please report it");
    }
    return image;
}

Reference obtainReference(render::Renderer& renderer, const render::Settings& settings, const std::string& folder,
    const std::string& name, const std::string& layer)
{
    const std::string path = pathOf(renderer, settings, folder, name, layer);
    const std::string kernels = kernelFingerprint(renderer, settings, layer);
    if (std::filesystem::exists(path)) {
        return readBack(path, settings.spp, kernels);
    }
    Reference out { half(renderer, settings, 0, layer), 0, settings.spp, path, false, false, {} };
    const image::RgbImage second = half(renderer, settings, 1, layer);
    // Both halves have the error e; their difference has sqrt 2 e, their mean e / sqrt 2.
    // As the file keeps it, so that a later run reports the same.
    out.noise = static_cast<float>(0.5 * image::rmse(out.image, second));
    out.deviation = second;
    std::ranges::transform(
        out.image.rgb, second.rgb, out.deviation.rgb.begin(), [](float a, float b) { return 0.5f * (a - b); });
    std::ranges::transform(
        out.image.rgb, second.rgb, out.image.rgb.begin(), [](float a, float b) { return 0.5f * (a + b); });
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed) {
        throw Error("folder for references", folder, failed.message() + ", name another one");
    }
    image::writeExr(path, layered(out, kernels));
    return out;
}

} // namespace wedge::benchmark
