#include "benchmarks/rendering_filters/filter_lab.h"

#include "benchmarks/common/lab.h"
#include "benchmarks/common/statistics.h"
#include "host/render/layers.h"
#include "host/scene/scene.h"

#include <algorithm>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

constexpr const char* filterPass = "filters of samples";
constexpr const char* indirectLayer = "indirect";

/// What is said of the frames of one setting, seed by seed.
struct Gathered {
    std::vector<ImageErrors> beauty {}, indirect {};
    std::vector<double> tracing {}, filter {}, total {}, denoising {};

    /// timed: a frame without layers, with which filters of samples leave nothing out.
    void add(const render::FrameStatistics& timed, const ImageErrors& ofBeauty, const ImageErrors& ofIndirect,
        double denoisingMilliseconds)
    {
        beauty.push_back(ofBeauty);
        indirect.push_back(ofIndirect);
        tracing.push_back(timed.milliseconds(device::PassKind::Trace));
        filter.push_back(timed.milliseconds(filterPass));
        total.push_back(timed.deviceMilliseconds);
        denoising.push_back(denoisingMilliseconds);
    }

    /// head: all else.
    FilterPoint point(FilterPoint head) const
    {
        head.beauty = averaged(beauty);
        head.indirect = averaged(indirect);
        head.tracing = summarize(tracing).median;
        head.filter = summarize(filter).median;
        head.total = summarize(total).median;
        head.denoising = summarize(denoising).median;
        return head;
    }
};

/// The plain mean, and the filter that claims are about.
bool isMain(const FilterVariant& variant) { return variant.text == plainMean || variant.text == densityVariant; }

} // namespace

FilterLab::FilterLab(const SceneSource& source, const device::Device& device, const FilterPlan& plan)
    : plan_(plan)
    , name_(source.name)
    , renderer_(scene::loadScene(source.file()), device)
    , beauty_(truth(""))
    , indirect_(truth(indirectLayer))
{
}

render::Settings FilterLab::sized(render::Settings settings, std::uint32_t seed) const
{
    settings.width = plan_.width;
    settings.height = plan_.height;
    settings.bounces = plan_.bounces;
    settings.antialias = plan_.antialias;
    settings.seed = seed;
    return settings;
}

Truth FilterLab::truth(const std::string& layer)
{
    return obtainTruth(
        renderer_, sized(render::monteCarlo(plan_.referenceSpp), 0), plan_.referenceFolder, name_, layer);
}

Denoised FilterLab::denoised(const render::Settings& settings, const render::FrameStatistics& frame)
{
    return plan_.denoiser->denoise(guidedImage(render::readLayers(renderer_, settings, frame, { "albedo", "normal" })));
}

void FilterLab::measure(
    std::vector<FilterPoint>& out, const render::Settings& wanted, int spp, const FilterVariant& variant)
{
    render::Settings settings = sized(wanted, 1);
    settings.filters = variant.filters;
    FilterPoint head;
    head.method = wanted.method;
    head.variant = variant.text;
    head.spp = spp;
    head.memory = renderer_.planUnbacked(settings).total();
    renderer_.rehearse(settings);
    renderer_.rehearse(settings, true);
    const bool denoises = plan_.denoiser != nullptr && isMain(variant);
    Gathered filtered, denoisedToo;
    for (int seed = 1; seed <= plan_.seeds; ++seed) {
        settings.seed = static_cast<std::uint32_t>(seed);
        const render::FrameStatistics timed = renderer_.render(settings);
        const render::FrameStatistics frame = renderer_.render(settings, {}, true);
        const ImageErrors indirect = indirect_.errorsOf(imageOf(renderer_, settings, frame, indirectLayer));
        filtered.add(timed, beauty_.errorsOf(imageOf(renderer_, settings, frame)), indirect, 0);
        if (denoises) {
            const Denoised found = denoised(settings, frame);
            denoisedToo.add(timed, beauty_.errorsOf(found.image), indirect, found.milliseconds);
        }
    }
    out.push_back(filtered.point(head));
    progress("rendering_filters",
        fmt::format("{}: {} {:4} spp {:<22} rmse {:.6f}  {:.0f} ms", name_, render::methodName(wanted), spp,
            variant.text, out.back().beauty.rmse, out.back().total));
    if (denoises) {
        head.variant += denoisedSuffix;
        out.push_back(denoisedToo.point(head));
    }
}

std::vector<FilterPoint> FilterLab::measureAll(const std::vector<FilterVariant>& variants)
{
    std::vector<FilterPoint> out;
    for (const int spp : plan_.spp) {
        for (const FilterVariant& variant : variants) {
            if (spp <= variant.mostSpp) {
                measure(out, render::monteCarlo(spp), spp, variant);
            }
        }
    }
    for (const int spp : plan_.filteredSpp) {
        for (const FilterVariant& variant : variants) {
            if (isMain(variant)) {
                measure(out, render::axisAligned(spp), spp, variant);
            }
        }
    }
    return out;
}

} // namespace wedge::benchmark
