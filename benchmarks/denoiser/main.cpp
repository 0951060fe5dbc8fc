// denoiser: time to equal error against plain sampling with Open Image Denoise; docs/benchmarks.md.
#include "benchmarks/common/arguments.h"
#include "benchmarks/common/lab.h"
#include "benchmarks/common/program.h"
#include "benchmarks/denoiser/compare.h"
#include "host/image/atomic_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

struct Call {
    std::vector<std::string> scenes;
    std::string python = "python3", device, json, size, references = defaultReferenceFolder();
    int referenceSpp = 0;
    bool quick = false;
};

std::vector<SceneSource> knownScenes()
{
    return { generatedScene("bench", generator::makeBench), generatedScene("chess", generator::makeChess) };
}

DenoiserPlan planOf(const Call& call)
{
    DenoiserPlan plan;
    if (call.quick) {
        plan.quick = true;
        plan.width = 320;
        plan.height = 240;
        plan.referenceSpp = 512;
        plan.frames = plan.seeds = 1;
        plan.denoised = { 2, 8, 32, 64 };
    }
    plan.referenceFolder = call.references;
    plan.referenceSpp = call.referenceSpp > 0 ? call.referenceSpp / 2 * 2 : plan.referenceSpp;
    if (!call.size.empty()) {
        setSize(plan, call.size);
    }
    return plan;
}

int run(const Call& call)
{
    const DenoiserPlan plan = planOf(call);
    if (!call.json.empty()) {
        image::checkWritable(call.json);
    }
    std::vector<std::string> missing;
    const std::vector<SceneSource> sources = chooseScenes(knownScenes(), call.scenes, missing);
    const OpenImageDenoise oidn(call.python);
    const bool available = oidn.available();
    const device::Device device = device::Device::open(call.device);
    Json all = resultSkeleton("denoiser", device.info());
    all["plan"] = { { "quick", plan.quick }, { "width", plan.width }, { "height", plan.height },
        { "seeds", plan.seeds }, { "frames", plan.frames }, { "reference_spp", plan.referenceSpp },
        { "spp", plan.spp } };
    all["denoiser"] = available ? Json("Open Image Denoise") : Json();
    all["scenes"] = Json::array();
    if (!available) {
        fmt::print("skipped: {} has no pyoidn; install it (pip install pyoidn), or name one that has it by --python\n",
            call.python);
    }
    for (const SceneSource& source : available ? sources : std::vector<SceneSource> {}) {
        const DenoiserResult result = compareWithDenoiser(source, device, plan, oidn);
        addClaims(all, claimsOf(result));
        all["scenes"].push_back(dataOf(result));
        fmt::print("{}", tableOf(result));
        if (!call.json.empty()) {
            writeJson(call.json, all);
        }
    }
    if (!available && !call.json.empty()) {
        writeJson(call.json, all);
    }
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser("Measures the time to equal error against plain sampling with Open Image Denoise.", "denoiser");
    Call call;
    parser.add_flag("--quick", call.quick, "320x240, one seed, small references: a look");
    parser.add_option("--scene", call.scenes, "bench, chess or a scene file; again for more (both)")
        ->expected(1)
        ->take_all();
    parser.add_option("--python", call.python, "an interpreter that has pyoidn (python3)");
    parser.add_option("--size", call.size, "WxH (640x480)");
    parser.add_option("--reference-spp", call.referenceSpp, "samples of the references (4096, quick 512)")
        ->check(CLI::Range(2, 1 << 20));
    parser.add_option("--reference-dir", call.references, "where references are kept (beside this program)");
    parser.add_option("--device", call.device, "cpu, gpu, an index, or part of a name");
    parser.add_option("--json", call.json, "where the results go, rewritten after each scene");
    return runProgram(parser, argc, argv, [&] { return run(call); });
}
