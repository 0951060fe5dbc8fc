#include "host/app/pass_table.h"

#include "host/render/report.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace wedge::app {
namespace {

using device::PassKind;
using device::PassRecord;

/// The passes in their order, all transfers as the last one: there are dozens, and none takes long.
std::vector<PassRecord> rows(const std::vector<PassRecord>& passes)
{
    std::vector<PassRecord> out;
    PassRecord transfers { "transfers", PassKind::Transfer, 0.0, 0, 0, {} };
    for (const PassRecord& pass : passes) {
        if (pass.kind == PassKind::Transfer) {
            transfers.milliseconds += pass.milliseconds;
        } else {
            out.push_back(pass);
        }
    }
    out.push_back(transfers);
    return out;
}

} // namespace

std::string passTable(const render::FrameStatistics& s, const render::Settings& settings)
{
    const std::vector<PassRecord> passes = rows(s.passes);
    std::size_t width = 11;
    for (const PassRecord& pass : passes) {
        width = std::max(width, pass.name.size());
    }
    const auto share = [&](double ms) { return s.deviceMilliseconds > 0 ? 100 * ms / s.deviceMilliseconds : 0.0; };
    std::string text = fmt::format("{:<{}}  {:<9}  {:>10}  {:>6}\n", "pass", width, "kind", "ms", "%");
    for (const PassRecord& pass : passes) {
        text += fmt::format("{:<{}}  {:<9}  {:>10.2f}  {:>6.1f}\n", pass.name, width, device::passKindName(pass.kind),
            pass.milliseconds, share(pass.milliseconds));
    }
    text += fmt::format("{:<{}}  {:<9}  {:>10.2f}  {:>6.1f}\n", "device time", width, "", s.deviceMilliseconds, 100.0);
    text += fmt::format("{:<{}}  {:<9}  {:>10.2f}\n", "wall clock", width, "", s.wallMilliseconds);
    text += fmt::format("overhead (analysis, filter, composite) {:.1f} %\n", 100 * s.overheadFraction());
    text += fmt::format("samples {:.1f} a shaded pixel and term, rays {:.1f} a pixel, {:.1f} Mrays/s\n", s.sppMean,
        render::raysPerPixel(s, settings), render::megaraysPerSecond(s));
    return text;
}

} // namespace wedge::app
