#include "host/render/stored_samples.h"

#include "host/graph/execution.h"
#include "host/render/sample_passes.h"
#include "kernels/shared/frame.h"
#include "kernels/shared/sample_filter.h"

#include <algorithm>
#include <utility>

namespace wedge::render {

using device::PassKind;
using graph::Launch;
using graph::reads;
using graph::readsAsIs;
using graph::tallies;
using graph::updates;
using graph::value;

namespace {

constexpr int reach = WEDGE_SAMPLE_REACH;
constexpr std::uint32_t channels = 3;

/// Rows of a band: whole tiles, and as many as there is memory for that is no more than other planes of a large frame
/// have; at least one row of tiles, whatever that takes.
int rowsOfBand(const PlaneLayout& layout, std::uint32_t perPixel)
{
    constexpr std::uint64_t budget = 32u << 20; // bytes
    const std::uint64_t ofRow =
        std::uint64_t { layout.stride } * perPixel * channels * (sizeof(float) + sizeof(std::uint16_t));
    const std::uint64_t rows = std::max<std::uint64_t>(budget / ofRow, 2 * reach + WEDGE_TILE) - 2 * reach;
    const std::uint64_t image = (layout.height + WEDGE_TILE - 1) / WEDGE_TILE * WEDGE_TILE;
    return static_cast<int>(std::min(rows / WEDGE_TILE * WEDGE_TILE, image));
}

/// Rows first to before last of a window.
Window rowsFrom(const Window& window, std::int64_t first, std::int64_t last)
{
    const auto row = [&](std::int64_t y) {
        return static_cast<int>(std::clamp<std::int64_t>(y, window.y0, window.y1));
    };
    return { window.x0, row(first), window.x1, row(last) };
}

} // namespace

StoredSamples::StoredSamples(
    FrameBuilder& frame, ChosenSampleFilter chosen, std::uint32_t perPixel, std::uint32_t first)
    : notFinite(frame.graph.plane<Count>("samples not finite", graph::counts))
    , excess(frame.graph.plane<Radiance>("light of rejected samples", graph::vectors))
    , frame_(frame)
    , chosen_(std::move(chosen))
    , perPixel_(perPixel)
    , first_(first)
    , exposure_(frame.graph.list<Share>("exposure of stored samples", graph::floats, 1))
{
    frame.zero(excess, notFinite);
    declareLists();
    if (!probed()) {
        frame.fill("exposure", exposure_, chosen_.filter->exposure(chosen_.values));
    }
}

void StoredSamples::declareLists()
{
    graph::Graph& g = frame_.graph;
    rows_ = rowsOfBand(frame_.layout, perPixel_);
    // The last band has its own pixels filtered, and needs no band after it.
    const auto rows = static_cast<std::uint32_t>(rows_);
    count_ = (frame_.layout.height + reach + rows - 1) / rows;
    slots_ = (rows + 2 * reach) * frame_.layout.stride;
    const std::uint64_t numbers = std::uint64_t { slots_ } * perPixel_ * channels;
    drawn = g.plane<Count>("samples drawn", graph::counts);
    radiance_ = g.list<Radiance>("radiance of stored samples", graph::floats, numbers);
    // Sixteen are read at once, some beyond a pixel's last.
    colours_ = g.list<Packed>("colours of stored samples", shortCounts, numbers + 16);
    ranges_ = g.list<Extremes>("ranges of stored samples", graph::floats, std::uint64_t { 2 } * slots_);
    frame_.zero(drawn, radiance_, colours_, ranges_);
}

StoredSamples StoredSamples::ofMore(std::uint32_t perPixel) const
{
    StoredSamples out = *this;
    out.perPixel_ = perPixel;
    out.replaces_ = true;
    out.declareLists();
    return out;
}

void StoredSamples::takeKept(const StoredSamples& other)
{
    sums = other.sums;
    taken = other.taken;
    notFinite = other.notFinite; // of all samples: those that were taken twice count once
    parts = other.parts;
    excess = other.excess;
    density = other.density;
}

void StoredSamples::expose(const graph::Handle<Sums>& ofProbes, const graph::Handle<Count>& takenByProbes)
{
    exposureOfProbes(frame_, ofProbes, takenByProbes, exposure_);
}

RowsOf StoredSamples::rows() const
{
    return [rows = rows_](const Launch& launch) {
        const auto band = static_cast<std::int64_t>(launch.run.iteration(1));
        return rowsFrom(launch.window, band * rows, (band + 1) * rows);
    };
}

graph::Sink StoredSamples::sink() const
{
    return { .file = "sinks/band_samples.h",
        .name = "BandSamples",
        .begin = { "slots", "exposure", "ranges" },
        .take = { "slots", "perPixel", "radiance", "colours" },
        .finish = { "slots", "ranges" },
        .defines = chosen_.filter->comparesRgb(chosen_.values) ? device::Defines { { "WEDGE_RGB_SAMPLES", "1" } }
                                                               : device::Defines() };
}

Arguments StoredSamples::sunk()
{
    return graph::together("stored",
        { value("slots", slots_), value("perPixel", perPixel_), reads("exposure", exposure_),
            tallies("ranges", ranges_), tallies("radiance", radiance_), tallies("colours", colours_) });
}

void StoredSamples::keep()
{
    const shared::AnalysisParams whole = frame_.analysisParams();
    const auto rows = [rows = rows_](const Launch& launch) {
        const auto first = static_cast<std::int64_t>(launch.run.iteration()) * rows - reach;
        return rowsFrom(launch.window, first, first + rows);
    };
    const auto p = graph::made("p", [whole, rows](const Launch& launch) {
        shared::AnalysisParams out = whole;
        setRectangle(out, rows(launch));
        return out;
    });
    const std::size_t most = std::size_t { frame_.layout.width } * static_cast<std::size_t>(rows_);
    frame_.graph.add({ .name = samplePass,
        .kind = PassKind::Filter,
        .kernel = chosen_.filter->kernel(),
        .arguments = joined({ p, value("firstPass", first_) },
            graph::together("stored",
                { value("slots", slots_), value("perPixel", perPixel_), reads("drawn", drawn, graph::around(reach)),
                    readsAsIs("radiance", radiance_), readsAsIs("colours", colours_), readsAsIs("ranges", ranges_),
                    reads("exposure", exposure_) }),
            chosen_.filter->arguments(chosen_.values, frame_.analysed()),
            graph::together("kept",
                { updates("sums", sums), updates("excess", excess), updates("taken", taken),
                    updates("notFinite", notFinite),
                    parts.graph != 0 ? updates("parts", parts) : graph::absent("parts", packedColours),
                    density.graph != 0 ? updates("density", density) : graph::absent("density") })),
        .domain = graph::Domain::Items,
        .count =
            [rows](const Launch& launch) {
                const Window window = rows(launch);
                return window.empty()
                    ? 0
                    : static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
            },
        .mostItems = most,
        .mostOfGroup = WEDGE_TILE,
        .condition =
            replaces_ ? [](const graph::Run& run) { return !run.cut(); } : std::function<bool(const graph::Run&)>() });
}

void StoredSamples::spread()
{
    render::spread(frame_, chosen_.filter->spread(chosen_.values), chosen_.filter->widest(chosen_.values),
        { excess, taken, sums, parts });
}

void StoredSamples::means(graph::Handle<Value>& mean) const { meansOfKept(frame_, sums, taken, mean); }

} // namespace wedge::render
