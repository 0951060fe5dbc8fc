#include "benchmarks/common/timing.h"

#include "host/render/report.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

using device::PassKind;
using render::FrameStatistics;

TimingColumn ofKind(const std::string& column, PassKind kind)
{
    return { column, [kind](const FrameStatistics& f) { return f.milliseconds(kind); } };
}

int timedWidth(const MeasurePlan& plan) { return plan.timedWidth > 0 ? plan.timedWidth : plan.width; }
int timedHeight(const MeasurePlan& plan) { return plan.timedHeight > 0 ? plan.timedHeight : plan.height; }

double overhead(const FrameStatistics& f) { return f.overheadFraction() * f.deviceMilliseconds; }

} // namespace

TimingColumn ofPasses(const std::string& column, const std::vector<std::string>& passes)
{
    return { column, [passes](const FrameStatistics& f) {
                double sum = 0;
                for (const std::string& pass : passes) {
                    sum += f.milliseconds(pass);
                }
                return sum;
            } };
}

TimingColumn tracing() { return ofKind("tracing", PassKind::Trace); }

TimingColumn widthsAndCounts() { return ofKind("widths_and_counts", PassKind::Analysis); }

std::vector<TimingColumn> withFrameColumns(std::vector<TimingColumn> columns)
{
    const std::vector<TimingColumn> all = {
        ofKind("filter", PassKind::Filter),
        ofKind("composite", PassKind::Composite),
        ofKind("transfer", PassKind::Transfer),
        { "overhead", overhead },
        { "total", [](const FrameStatistics& f) { return f.deviceMilliseconds; } },
        { "wall", [](const FrameStatistics& f) { return f.wallMilliseconds; } },
        { "fps_with", [](const FrameStatistics& f) { return 1e3 / f.deviceMilliseconds; } },
        { "fps_without", [](const FrameStatistics& f) { return 1e3 / (f.deviceMilliseconds - overhead(f)); } },
        { "overhead_fraction", [](const FrameStatistics& f) { return f.overheadFraction(); } },
        { "wall_gap", [](const FrameStatistics& f) { return 1.0 - f.deviceMilliseconds / f.wallMilliseconds; } },
    };
    columns.insert(columns.end(), all.begin(), all.end());
    return columns;
}

const Summary& Timing::operator[](const std::string& column) const
{
    for (const auto& [name, summary] : columns) {
        if (name == column) {
            return summary;
        }
    }
    throw std::out_of_range("no such column: " + column);
}

double timedPixels(const MeasurePlan& plan) { return static_cast<double>(timedWidth(plan)) * timedHeight(plan); }

Timing timeFrames(
    Lab& lab, render::Settings settings, const std::vector<TimingColumn>& columns, const std::string& label)
{
    settings.width = timedWidth(lab.plan());
    settings.height = timedHeight(lab.plan());
    settings.seed = 1;
    lab.renderer().rehearse(settings);
    const FrameStatistics first = lab.renderer().render(settings);
    std::vector<FrameStatistics> frames;
    frames.reserve(static_cast<std::size_t>(lab.plan().frames));
    for (int i = 0; i < lab.plan().frames; ++i) {
        frames.push_back(lab.renderer().render(settings));
    }
    Timing out;
    out.spp = lab.subject().sppOf(frames.front());
    const auto summaryOf = [&](const auto& value) {
        std::vector<double> values(frames.size());
        std::ranges::transform(frames, values.begin(), value);
        return summarize(std::move(values));
    };
    out.megaraysPerSecond = summaryOf(render::megaraysPerSecond).median;
    for (const auto& [name, value] : columns) {
        out.columns.emplace_back(name, summaryOf(value));
    }
    out.firstFrame = first.wallMilliseconds / out["wall"].median;
    lab.say(fmt::format("{} frames of the {} setting, {:.1f} ms each", frames.size(), label, out["total"].median));
    return out;
}

} // namespace wedge::benchmark
