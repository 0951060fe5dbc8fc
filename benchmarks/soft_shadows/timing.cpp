#include "benchmarks/soft_shadows/timing.h"

#include "host/render/report.h"

#include <functional>
#include <stdexcept>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

using device::PassKind;
using render::FrameStatistics;
using Column = std::pair<const char*, std::function<double(const FrameStatistics&)>>;

std::function<double(const FrameStatistics&)> ofPass(const char* name)
{
    return [name](const FrameStatistics& f) { return f.milliseconds(std::string(name)); };
}

std::function<double(const FrameStatistics&)> ofKind(PassKind kind)
{
    return [kind](const FrameStatistics& f) { return f.milliseconds(kind); };
}

double overhead(const FrameStatistics& f) { return f.overheadFraction() * f.deviceMilliseconds; }

const std::vector<Column>& columns()
{
    static const std::vector<Column> all = {
        { "primary", ofPass("primary rays") },
        { "first_pass", ofPass("first pass") },
        { "second_pass", ofPass("second pass") },
        { "tracing", ofKind(PassKind::Trace) },
        { "widths", ofPass("widths") },
        { "counts", ofPass("counts") },
        { "first_pass_filter", ofPass("filter of first pass") },
        { "widths_and_counts", ofKind(PassKind::Analysis) },
        { "filter", ofKind(PassKind::Filter) },
        { "composite", ofKind(PassKind::Composite) },
        { "transfer", ofKind(PassKind::Transfer) },
        { "overhead", overhead },
        { "total", [](const FrameStatistics& f) { return f.deviceMilliseconds; } },
        { "wall", [](const FrameStatistics& f) { return f.wallMilliseconds; } },
        { "fps_with", [](const FrameStatistics& f) { return 1e3 / f.deviceMilliseconds; } },
        { "fps_without", [](const FrameStatistics& f) { return 1e3 / (f.deviceMilliseconds - overhead(f)); } },
        { "overhead_fraction", [](const FrameStatistics& f) { return f.overheadFraction(); } },
        { "wall_gap", [](const FrameStatistics& f) { return 1.0 - f.deviceMilliseconds / f.wallMilliseconds; } },
    };
    return all;
}

} // namespace

const Summary& Timing::operator[](const std::string& column) const
{
    for (const auto& [name, summary] : columns) {
        if (name == column) {
            return summary;
        }
    }
    throw std::out_of_range("no such column: " + column);
}

Timing timeFrames(Lab& lab, render::Settings settings)
{
    settings.width = lab.plan().width;
    settings.height = lab.plan().height;
    settings.seed = 1;
    lab.renderer().rehearse(settings);
    lab.renderer().render(settings);
    std::vector<FrameStatistics> frames;
    for (int i = 0; i < lab.plan().frames; ++i) {
        frames.push_back(lab.renderer().render(settings));
    }
    Timing out;
    out.spp = frames.front().sppMean;
    std::vector<double> rates;
    for (const FrameStatistics& frame : frames) {
        rates.push_back(render::megaraysPerSecond(frame));
    }
    out.megaraysPerSecond = summarize(rates).median;
    for (const auto& [name, value] : columns()) {
        std::vector<double> values;
        for (const FrameStatistics& frame : frames) {
            values.push_back(value(frame));
        }
        out.columns.emplace_back(name, summarize(values));
    }
    progress(fmt::format("{}: {} frames of the {} setting, {:.1f} ms each", lab.name(), frames.size(),
        settings.published ? "published" : "default", out["total"].median));
    return out;
}

} // namespace wedge::benchmark
