#include "benchmarks/lottery/results.h"

#include "benchmarks/common/fingerprint.h"
#include "benchmarks/lottery/verdict.h"
#include "host/error.h"
#include "host/render/metadata.h"
#include "kernels/embedded_kernels.hpp"

#include <filesystem>
#include <fstream>

namespace wedge::benchmark {
namespace {

/// Of all kernels, and of what the default setting is.
std::string methodFingerprint()
{
    Fingerprint f;
    for (const EmbeddedKernel& kernel : embeddedKernels()) {
        f.add(kernel.text);
    }
    for (const auto& [key, value] : render::describe(render::axisAligned())) {
        f.add(key);
        f.add(value);
    }
    return f.text();
}

Json dataOf(const SquaredError& e)
{
    return { { "mse", number(e.mean) }, { "mse_trimmed", number(e.trimmed) }, { "deviation", number(e.deviation) },
        { "reference_deviation", number(e.referenceDeviation) }, { "bias", number(e.bias) },
        { "bias_deviation", number(e.biasDeviation) } };
}

SquaredError errorOf(const Json& j)
{
    return { j.at("mse"), j.at("mse_trimmed"), j.at("deviation"), j.value("reference_deviation", 0.0), j.at("bias"),
        j.at("bias_deviation") };
}

Json dataOf(const std::vector<LotteryPoint>& points)
{
    Json out = Json::array();
    for (const LotteryPoint& p : points) {
        out.push_back({ { "spp", p.spp }, { "error", dataOf(p.error) }, { "device_ms", number(p.deviceMilliseconds) },
            { "wall_ms", number(p.wallMilliseconds) } });
    }
    return out;
}

std::vector<LotteryPoint> pointsOf(const Json& list)
{
    std::vector<LotteryPoint> out;
    for (const Json& j : list) {
        out.push_back({ j.at("spp"), errorOf(j.at("error")), j.at("device_ms"), j.at("wall_ms") });
    }
    return out;
}

Json dataOf(const LotteryResult& r, int compared)
{
    const Verdict v = verdictOf(r, compared);
    return { { "seed", r.seed }, { "hard_cases", generator::hardCases(r.traits) }, { "bounces", r.traits.bounces },
        { "lights", r.traits.lights }, { "antialias", r.traits.antialias }, { "lens", r.traits.lens },
        { "motion", r.traits.motion }, { "triangles", r.triangles }, { "seconds", number(r.seconds) },
        { "reference_noise", number(r.referenceNoise) }, { "against_mc", number(v.againstPlain.value) },
        { "against_fixed_blur", number(v.againstBlur.value) },
        { "against_mc_in_equal_time", number(v.againstEqualTime.value) }, { "saved_samples", number(v.savedSamples) },
        { "saved_samples_trimmed", number(v.savedTrimmed) }, { "saved_time", number(v.savedTime) },
        { "saved_wall_time", number(v.savedWallTime) }, { "slope", number(v.slope) },
        { "slope_deviation", number(v.slopeDeviation) }, { "mc_slope", number(v.plainSlope) },
        { "bias", number(v.bias) }, { "mc", dataOf(r.plain) }, { "aaf", dataOf(r.filtered) },
        { "fixed_blur", dataOf(r.fixedBlur) }, { "fixed_blur_name", r.fixedBlurName } };
}

LotteryResult resultOf(const Json& j, int version)
{
    LotteryResult r;
    r.seed = j.at("seed");
    r.traits = generator::lotteryTraits(r.seed, version);
    r.triangles = j.at("triangles");
    r.seconds = j.at("seconds");
    r.referenceNoise = j.at("reference_noise");
    r.plain = pointsOf(j.at("mc"));
    r.filtered = pointsOf(j.at("aaf"));
    r.fixedBlur = errorOf(j.at("fixed_blur"));
    r.fixedBlurName = j.at("fixed_blur_name");
    return r;
}

Json dataOf(const LotteryPlan& plan)
{
    Json out { { "width", plan.width }, { "height", plan.height }, { "budgets", plan.budgets },
        { "compared", plan.compared }, { "pooled_up_to", plan.pooledUpTo }, { "seeds", plan.seeds },
        { "reference_spp", plan.referenceSpp }, { "kernels", methodFingerprint() } };
    if (plan.version != 1) { // files from before there was another do not say it
        out["version"] = plan.version;
    }
    return out;
}

} // namespace

Json lotteryResults(
    const std::vector<LotteryResult>& results, const LotteryPlan& plan, const device::DeviceInfo& device)
{
    Json out = resultSkeleton("lottery", device);
    addClaims(out, lotteryClaims(results, plan.compared));
    out["plan"] = dataOf(plan);
    out["scenes"] = Json::array();
    for (const LotteryResult& r : results) {
        out["scenes"].push_back(dataOf(r, plan.compared));
    }
    return out;
}

std::vector<LotteryResult> resumeLottery(
    const std::string& path, const LotteryPlan& plan, const device::DeviceInfo& device)
{
    std::ifstream file(path);
    if (path.empty() || !file) {
        return {};
    }
    std::vector<LotteryResult> out;
    try {
        const Json found = Json::parse(file);
        const Json now = lotteryResults({}, plan, device);
        for (const char* key : { "benchmark", "wedge", "device", "plan" }) {
            if (found.at(key) != now.at(key)) {
                throw Error("results " + path, std::string("are of another ") + key, "name another file, or delete it");
            }
        }
        for (const Json& scene : found.at("scenes")) {
            out.push_back(resultOf(scene, plan.version));
        }
    } catch (const Json::exception&) {
        throw Error("results " + path, "were not written by this program", "name another file");
    }
    return out;
}

} // namespace wedge::benchmark
