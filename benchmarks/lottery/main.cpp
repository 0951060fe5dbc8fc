// lottery: scenes that nobody designed, plain and filtered; docs/benchmarks.md.
#include "benchmarks/common/arguments.h"
#include "benchmarks/common/lab.h"
#include "benchmarks/common/program.h"
#include "benchmarks/common/scene_source.h"
#include "benchmarks/lottery/results.h"
#include "benchmarks/lottery/verdict.h"
#include "host/image/atomic_file.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

constexpr std::uint32_t mostSeeds = 100000;

struct LotteryArguments {
    std::string seeds, json, device, references = defaultReferenceFolder(), images, scenes, size;
    bool quick = false;
    int referenceSpp = 0, version = 1;
};

/// "A:B", both included, or "A".
std::vector<std::uint32_t> seedsOf(const std::string& text)
{
    const std::size_t colon = text.find(':');
    const auto number = [&](const std::string& part) {
        std::uint32_t value = 0;
        const char* end = part.data() + part.size();
        if (const auto [at, code] = std::from_chars(part.data(), end, value); code != std::errc {} || at != end) {
            throw UsageError("seeds", text, "write A:B, two whole numbers, or one");
        }
        return value;
    };
    const std::uint32_t first = number(text.substr(0, colon));
    const std::uint32_t last = colon == std::string::npos ? first : number(text.substr(colon + 1));
    if (last < first || last - first >= mostSeeds) {
        throw UsageError("seeds", text, fmt::format("write A:B with A up to B, at most {} seeds", mostSeeds));
    }
    std::vector<std::uint32_t> out;
    for (std::uint32_t seed = first; seed - first <= last - first; ++seed) {
        out.push_back(seed);
        if (seed == last) {
            break;
        }
    }
    return out;
}

LotteryPlan planOf(const LotteryArguments& a)
{
    LotteryPlan plan;
    if (a.quick) {
        plan.referenceSpp = 2048;
    }
    if (a.referenceSpp > 0) {
        plan.referenceSpp = a.referenceSpp + a.referenceSpp % 2;
    }
    if (!a.size.empty()) {
        MeasurePlan size;
        setSize(size, a.size);
        plan.width = size.width;
        plan.height = size.height;
    }
    plan.referenceFolder = a.references;
    plan.imageFolder = a.images;
    plan.version = a.version;
    return plan;
}

int writeScenes(const LotteryArguments& a, const std::vector<std::uint32_t>& seeds)
{
    for (const std::uint32_t seed : seeds) {
        lotteryScene(seed, a.version, a.scenes);
    }
    return 0;
}

int measureAll(const LotteryArguments& a)
{
    const std::vector<std::uint32_t> seeds = seedsOf(a.seeds.empty() ? a.quick ? "1:10" : "1:200" : a.seeds);
    if (!a.scenes.empty()) {
        return writeScenes(a, seeds);
    }
    const LotteryPlan plan = planOf(a);
    if (!a.json.empty()) {
        image::checkWritable(a.json);
    }
    if (!a.images.empty()) {
        std::filesystem::create_directories(a.images);
    }
    const device::Device device = device::Device::open(a.device);
    std::vector<LotteryResult> results = resumeLottery(a.json, plan, device.info());
    for (const std::uint32_t seed : seeds) {
        if (std::ranges::find(results, seed, &LotteryResult::seed) != results.end()) {
            continue;
        }
        results.push_back(measureSeed(seed, device, plan));
        const Verdict v = verdictOf(results.back(), plan.compared);
        progress("lottery",
            fmt::format("seed {}: {:.2f} of mc's error, {:.1f} times the samples saved, slope {:.2f}, {:.1f} s", seed,
                v.againstPlain.value, v.savedSamples, v.slope, results.back().seconds));
        if (!a.json.empty()) {
            writeJson(a.json, lotteryResults(results, plan, device.info()));
        }
    }
    std::erase_if(results, [&](const LotteryResult& r) { return std::ranges::find(seeds, r.seed) == seeds.end(); });
    fmt::print("{}", lotteryTable(results, plan.compared));
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser("Measures filtered against plain images of random scenes.", "lottery");
    LotteryArguments a;
    parser.add_option("--seeds", a.seeds, "scenes, A:B or one (1:200)");
    parser
        .add_option("--lottery-version", a.version,
            "1: as seeds were frozen first; 2: with meshes that emit in a quarter of the scenes; 3: under skies (1)")
        ->check(CLI::Range(1, 3));
    parser.add_flag("--quick", a.quick, "seeds 1:10, references of 2048 samples: to see that it works, not to report");
    parser.add_option(
        "--json", a.json, "results, rewritten after each scene; a call that was interrupted goes on from there");
    parser.add_option("--device", a.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--reference-dir", a.references, "where references are kept (beside this program)");
    parser.add_option("--reference-spp", a.referenceSpp, "samples of the references (4096)")
        ->check(CLI::Range(2, 1 << 20));
    parser.add_option("--size", a.size, "WIDTHxHEIGHT of the images (128x96)");
    parser.add_option("--images", a.images, "a folder for pictures: reference, mc and aaf of each scene");
    parser.add_option("--write-scenes", a.scenes, "only write the scenes' files into that folder");
    return runProgram(parser, argc, argv, [&] { return measureAll(a); });
}
