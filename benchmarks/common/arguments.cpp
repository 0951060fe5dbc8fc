#include "benchmarks/common/arguments.h"

#include "benchmarks/common/scene_source.h"
#include "host/error.h"
#include "host/scene/scene.h"

#include <charconv>

#include <fmt/format.h>

namespace wedge::benchmark {

void setSize(MeasurePlan& plan, const std::string& text)
{
    const char* end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, plan.width);
    const bool split = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    const auto height = std::from_chars(split ? width.ptr + 1 : end, end, plan.height);
    if (!split || height.ec != std::errc() || height.ptr != end || plan.width < 8 || plan.height < 8
        || plan.width > scene::maxImageSide || plan.height > scene::maxImageSide) {
        throw UsageError("--size", text, fmt::format("give WIDTHxHEIGHT, each from 8 to {}", scene::maxImageSide));
    }
}

void addOptions(CLI::App& parser, Arguments& a, const std::string& table, const MeasurePlan& plan,
    const MeasurePlan& quick, const std::string& quickMeans)
{
    a.references = defaultReferenceFolder();
    parser.add_flag("--quick", a.quick, quickMeans);
    parser.add_option("--scene", a.scenes, "a scene's name or a scene file; again for more (all there are)")
        ->expected(1)
        ->take_all();
    parser.add_option("--json", a.json, "where the results go, rewritten after each scene");
    parser.add_option("--device", a.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--reference-dir", a.references, "where references are kept (beside this program)");
    parser
        .add_option("--reference-spp", a.referenceSpp,
            fmt::format("samples of the references ({}, quick {})", plan.referenceSpp, quick.referenceSpp))
        ->check(CLI::Range(16, 1 << 20));
    parser.add_option("--size", a.size,
        fmt::format(
            "WIDTHxHEIGHT of the images ({}x{}, quick {}x{})", plan.width, plan.height, quick.width, quick.height));
    parser.add_flag("--timing-only", a.timingOnly, "only what " + table + " has");
    parser.add_flag("--list", a.list, "list the scenes");
}

void apply(const Arguments& a, MeasurePlan& plan, int halves)
{
    plan.timingOnly = a.timingOnly;
    plan.referenceFolder = a.references;
    if (!a.size.empty()) {
        setSize(plan, a.size);
    }
    if (a.referenceSpp > 0) {
        plan.referenceSpp = halves * ((a.referenceSpp + halves - 1) / halves);
    }
}

} // namespace wedge::benchmark
