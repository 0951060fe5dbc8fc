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
    const auto planeOf = [&](const device::Buffer<std::uint32_t>& b) { return b.downloadAll(queue_); };
    const auto sumOf = [&](const auto& counts) {
        const auto all = counts.downloadAll(queue_);
        return std::accumulate(all.begin(), all.end(), std::uint64_t { 0 });
    };
    const bool pixels = !frame_->distributed; // which have tallies
    const std::vector<std::uint32_t> none;
    const std::vector<std::uint32_t> samples = pixels ? none : planeOf(frame_->samples);
    const std::vector<std::uint32_t> indirect = pixels ? none : planeOf(frame_->indirectSamples);
    const std::vector<std::uint32_t> objects = planeOf(frame_->objectId);
    const image::Window output = outputWindow(settings);
    const std::vector<Term>& terms = compiled_->declared().terms();
    const std::size_t direct = countOf(Part::Direct, terms), reflected = terms.size() - direct;
    // Pixels of several receivers take samples of all terms whatever is there.
    const auto lobesOf = [&](Part part) {
        return static_cast<std::size_t>(
            std::ranges::count_if(terms, [&](const Term& t) { return t.part == part && t.ofLobes; }));
    };
    const std::size_t directLobes = lobesOf(Part::Direct), reflectedLobes = lobesOf(Part::Indirect);
    const bool apart = !frame_->distributed && directLobes + reflectedLobes > 0;
    const std::vector<float> specular = apart ? frame_->specular.downloadAll(queue_) : std::vector<float> {};
    const std::size_t size = frame_->layout.size;
    std::uint64_t total = pixels ? sumOf(frame_->samplesTally) : 0;
    std::uint64_t indirectTotal = pixels ? sumOf(frame_->indirectTally) : 0;
    std::uint64_t directPixels = 0, indirectPixels = 0;
    for (int y = output.y0; y < output.y1; ++y) {
        for (int x = output.x0; x < output.x1; ++x) {
            const std::size_t i =
                shared::pixelIndex(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), frame_->layout.stride);
            if (objects[i] == 0) {
                continue;
            }
            ++statistics.shadedPixels;
            if (!pixels) {
                total += samples[i];
                indirectTotal += indirect[i];
            }
            const bool matte = apart && !(specular[i] + specular[size + i] + specular[2 * size + i] > 0);
            directPixels += matte ? direct - directLobes : direct;
            indirectPixels += matte ? reflected - reflectedLobes : reflected;
        }
    }
    const bool whole = settings.method == Method::AxisAligned;
    statistics.primaryRays = static_cast<std::uint64_t>(whole ? settings.width : output.width())
        * static_cast<std::uint64_t>(whole ? settings.height : output.height());
    if (frame_->distributed) {
        const std::vector<std::uint32_t> primary = frame_->primaryTaken.downloadAll(queue_);
        statistics.primaryRays = std::accumulate(primary.begin(), primary.end(), std::uint64_t { 0 });
        std::uint64_t shown = 0;
        for (int y = output.y0; y < output.y1; ++y) {
            for (int x = output.x0; x < output.x1; ++x) {
                shown += primary[shared::pixelIndex(
                    static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), frame_->layout.stride)];
            }
        }
        statistics.primarySpp = static_cast<double>(shown) / (static_cast<double>(output.width()) * output.height());
    }
    statistics.indirectRays = pixels ? sumOf(frame_->pathRaysTally) : sumOf(frame_->pathRays);
    statistics.shadowRays = (pixels ? sumOf(frame_->raysTally) : sumOf(frame_->rays)) - statistics.indirectRays;
    const auto mean = [](std::uint64_t sum, std::uint64_t count) {
        return count > 0 ? static_cast<double>(sum) / static_cast<double>(count) : 0.0;
    };
    statistics.directSpp = mean(total - indirectTotal, directPixels);
    statistics.indirectSpp = mean(indirectTotal, indirectPixels);
    statistics.sppMean = mean(total, directPixels + indirectPixels);
    queue_.takeRecords();
}

} // namespace wedge::render
