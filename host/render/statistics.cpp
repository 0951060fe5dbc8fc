// What a frame cost and took.
#include "host/render/effect.h"
#include "host/render/renderer.h"

#include <algorithm>
#include <numeric>

namespace wedge::render {

using device::PassKind;

double FrameStatistics::milliseconds(PassKind kind) const
{
    return std::accumulate(passes.begin(), passes.end(), 0.0,
        [&](double sum, const device::PassRecord& r) { return sum + (r.kind == kind ? r.milliseconds : 0.0); });
}

double FrameStatistics::milliseconds(const std::string& pass) const
{
    return std::accumulate(passes.begin(), passes.end(), 0.0,
        [&](double sum, const device::PassRecord& r) { return sum + (r.name == pass ? r.milliseconds : 0.0); });
}

double FrameStatistics::overheadFraction() const
{
    const double overhead =
        milliseconds(PassKind::Analysis) + milliseconds(PassKind::Filter) + milliseconds(PassKind::Composite);
    return deviceMilliseconds > 0 ? overhead / deviceMilliseconds : 0.0;
}

void Renderer::countWork(const Settings& settings, FrameStatistics& statistics)
{
    const auto sumOf = [&](const char* tally) {
        const std::vector<std::uint64_t> all = frame_->planes<std::uint64_t>(tally).downloadAll(queue_);
        return std::accumulate(all.begin(), all.end(), std::uint64_t { 0 });
    };
    const std::vector<Term>& terms = compiled_->declared().terms();
    const auto pixelsOf = [&](Part part) {
        // Pixels of several receivers take samples of all terms whatever is there.
        const auto lobes = static_cast<std::uint64_t>(std::ranges::count_if(
            terms, [&](const Term& t) { return t.part == part && t.ofLobes && !frame_->distributed; }));
        return countOf(part, terms) * statistics.shadedPixels - lobes * (lobes > 0 ? sumOf("matteTally") : 0);
    };
    statistics.shadedPixels = sumOf("shadedTally");
    const std::uint64_t directPixels = pixelsOf(Part::Direct), indirectPixels = pixelsOf(Part::Indirect);
    const std::uint64_t total = sumOf("samplesTally"), indirectTotal = sumOf("indirectTally");
    const image::Window output = outputWindow(settings);
    const auto pixelsIn = [](int width, int height) {
        return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    };
    if (frame_->distributed) {
        statistics.primaryRays = sumOf("primaryTally");
        statistics.primarySpp = static_cast<double>(sumOf("primaryShownTally"))
            / static_cast<double>(pixelsIn(output.width(), output.height()));
    } else {
        const PlaneLayout& layout = frame_->layout;
        const bool whole = settings.method == Method::AxisAligned || layout.margin > 0; // a crop analyses all
        statistics.primaryRays = whole ? pixelsIn(static_cast<int>(layout.width), static_cast<int>(layout.height))
                                       : pixelsIn(output.width(), output.height());
    }
    statistics.indirectRays = sumOf("pathRaysTally");
    statistics.shadowRays = sumOf("raysTally") - statistics.indirectRays;
    const auto mean = [](std::uint64_t sum, std::uint64_t count) {
        return count > 0 ? static_cast<double>(sum) / static_cast<double>(count) : 0.0;
    };
    statistics.directSpp = mean(total - indirectTotal, directPixels);
    statistics.indirectSpp = mean(indirectTotal, indirectPixels);
    statistics.sppMean = mean(total, directPixels + indirectPixels);
    if (frame_->has("notFiniteTally")) {
        statistics.notFiniteSamples = sumOf("notFiniteTally");
    }
    if (frame_->has("clampedTally")) {
        statistics.clampedPixels = sumOf("clampedTally");
    }
    queue_.takeRecords();
}

} // namespace wedge::render
