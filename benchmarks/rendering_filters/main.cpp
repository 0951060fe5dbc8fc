// rendering_filters: filters of samples and of images against plain means of path-traced light, and an environment's
// light by lights and shadows, and hard shadows in a style; docs/benchmarks.md.
#include "benchmarks/common/program.h"
#include "benchmarks/rendering_filters/call.h"
#include "benchmarks/rendering_filters/filter_lab.h"
#include "benchmarks/rendering_filters/results.h"
#include "benchmarks/rendering_filters/shadow_lights.h"
#include "benchmarks/rendering_filters/stylized.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace wedge;
using namespace wedge::benchmark;

/// Of filters of samples and of images.
struct Call : CommonCall {
    FilterPlan plan;
    std::vector<std::string> variants;
    std::string python = "python3";
};

/// One of data/scenes/filters.
SceneSource filterScene(const std::string& name, const std::string& origin)
{
    SceneSource out = shippedScene("filters/" + name, origin);
    out.name = name;
    return out;
}

std::vector<SceneSource> knownScenes()
{
    return { shippedScene("mirrors", "mirrors and glass in a box"),
        shippedScene("materials", "kinds of material under four lights"),
        filterScene("room_small_lamp", "mirror, glass and gloss under a small bright lamp"),
        filterScene("two_lamps", "a large yellow lamp, a small strong blue one, mirrors"),
        shippedScene("cornell", "matt, no outliers"), filterScene("grid_floor", "matt, tiles, no outliers") };
}

std::vector<FilterVariant> variantsOf(const Call& call, std::vector<std::string>& skipped)
{
    if (call.variants.empty()) {
        return allVariants(call.plan.antialias, skipped);
    }
    std::vector<FilterVariant> out { variantOf(plainMean) };
    for (const std::string& text : call.variants) {
        if (text != plainMean) {
            out.push_back(variantOf(text));
        }
    }
    return out;
}

FilterPlan planOf(const Call& call)
{
    FilterPlan plan = call.plan;
    applyCommonOptions(call, plan);
    std::erase(plan.filteredSpp, 0);
    return plan;
}

Json skeleton(const FilterPlan& plan, const std::vector<FilterVariant>& variants,
    const std::vector<std::string>& skipped, const device::DeviceInfo& device)
{
    Json all = resultSkeleton("rendering_filters", device);
    all["plan"] = { { "width", plan.width }, { "height", plan.height }, { "bounces", plan.bounces },
        { "antialias", plan.antialias }, { "spp", plan.spp }, { "aaf_spp", plan.filteredSpp }, { "seeds", plan.seeds },
        { "reference_spp", plan.referenceSpp } };
    all["variants"] = Json::array();
    for (const FilterVariant& variant : variants) {
        all["variants"].push_back(variant.text);
    }
    all["skipped"] = skipped;
    all["denoiser"] = plan.denoiser != nullptr ? Json("Open Image Denoise") : Json();
    all["scenes"] = Json::array();
    return all;
}

int run(const Call& call)
{
    FilterPlan plan = planOf(call);
    std::vector<std::string> skipped, missing;
    const std::vector<FilterVariant> variants = variantsOf(call, skipped);
    if (!skipped.empty()) {
        fmt::print("skipped, since such frames have no such filters: {}\n", fmt::join(skipped, " "));
    }
    const std::vector<SceneSource> sources = chooseScenes(knownScenes(), call.scenes, missing);
    const OpenImageDenoise denoiser(call.python);
    if (denoiser.available()) {
        plan.denoiser = &denoiser;
    } else {
        fmt::print("skipped denoising: {} has no pyoidn; install it (pip install pyoidn), or name one that has it by "
                   "--python\n",
            call.python);
    }
    const device::Device device = device::Device::open(call.device);
    Json all = skeleton(plan, variants, skipped, device.info());
    for (const SceneSource& source : sources) {
        FilterLab lab(source, device, plan);
        const FilteredScene scene { source.name, source.origin, lab.beauty().reference().noise,
            lab.indirect().reference().noise, lab.beauty().exposure(), lab.measureAll(variants) };
        addClaims(all, claimsOf(scene));
        all["scenes"].push_back(dataOf(scene));
        tellScene(call, all, tableOf(scene));
    }
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App parser("Measures filters of samples and of images against plain means, or what a subcommand says.",
        "rendering_filters");
    Call call;
    addCommonOptions(parser, call, call.plan);
    addReferenceOptions(parser, call.plan);
    parser
        .add_option("--variant", call.variants,
            "a filter as --add-filter of wedge render takes it; again for more (all in the table)")
        ->expected(1)
        ->take_all();
    parser.add_option("--spp", call.plan.spp, "samples a pixel of method mc (8,64,256,1024)")
        ->delimiter(',')
        ->check(CLI::Range(1, 1 << 20));
    parser.add_option("--aaf-spp", call.plan.filteredSpp, "samples a pixel of method aaf (16,64); 0: none")
        ->delimiter(',')
        ->check(CLI::Range(0, 1 << 20));
    parser.add_option("--bounces", call.plan.bounces, "of indirect light (3)")
        ->check(CLI::Range(1, render::mostBounces));
    parser.add_flag("--antialias", call.plan.antialias, "samples lie all over their pixels");
    parser.add_option("--python", call.python, "an interpreter that has pyoidn, for denoised images (python3)");
    ShadowCall shadows;
    CLI::App& shadowLights = addShadowLights(parser, shadows);
    StylizedCall styles;
    CLI::App& stylized = addStylized(parser, styles);
    for (CLI::Option* option : parser.get_options([](const CLI::Option* o) { return o->get_name() != "--help"; })) {
        shadowLights.excludes(option); // they have their own
        stylized.excludes(option);
    }
    return runProgram(parser, argc, argv, [&] {
        return shadowLights.parsed() ? runShadowLights(shadows) : stylized.parsed() ? runStylized(styles) : run(call);
    });
}
