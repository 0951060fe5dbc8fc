// indirect: chapter 4 of the thesis, measured on its scenes; docs/benchmarks.md.
#include "kernels/shared/indirect.h"
#include "benchmarks/harness/scene_result.h"
#include "benchmarks/harness/thesis_table.h"

#include <fmt/format.h>

namespace {

using namespace wedge;
using namespace wedge::benchmark;
using render::Filtering;
using render::Sampler;

std::string integrandName(int bounces)
{
    return bounces == 0 ? "ambient occlusion" : fmt::format("{} bounce{}", bounces, bounces == 1 ? "" : "s");
}

/// Indirect light alone, of so many bounces, or ambient occlusion.
class IndirectLight : public Subject {
public:
    explicit IndirectLight(int referenceSpp)
        : referenceSpp_(referenceSpp)
    {
    }

    std::string program() const override { return "indirect"; }
    std::string layer() const override { return "indirect"; }
    Integrand integrandOf(const render::Settings& settings) const override
    {
        render::Settings reference = render::monteCarlo(referenceSpp_);
        reference.sampler = Sampler::Sobol;
        reference.bounces = settings.bounces;
        reference.integrator = settings.integrator;
        reference.indirect.ambientDistance = settings.indirect.ambientDistance;
        return { integrandName(settings.bounces), reference };
    }
    double sppOf(const render::FrameStatistics& frame) const override { return frame.indirectSpp; }
    double raysOf(const render::FrameStatistics& frame) const override
    {
        return static_cast<double>(frame.indirectRays);
    }
    float muOf(const render::Settings& settings) const override { return settings.indirect.mu; }
    std::string describe(const render::Settings& s) const override
    {
        const bool adaptive =
            s.sampling == render::Sampling::Adaptive && s.indirect.counts != render::IndirectCounts::Uniform;
        const std::string variant = s.method == render::Method::MonteCarlo
            ? fmt::format("unfiltered {}", s.sampler == Sampler::Sobol ? "sobol" : "stratified")
            : describeVariant(s, s.indirect.mu, adaptive);
        return s.bounces == 1 ? variant : fmt::format("{} {}", variant, integrandName(s.bounces));
    }

private:
    int referenceSpp_;
};

/// Paths of one bounce with errors, of more without.
Case paths(int bounces, Paper paper = {})
{
    Case out { .bounces = bounces, .paper = std::move(paper), .errors = bounces == 1 };
    if (bounces > 1) {
        out.suffix = fmt::format("_{}_bounces", bounces);
        out.label = fmt::format(", {} b.", bounces);
    }
    return out;
}

Case ambientOcclusion(float distance)
{
    return { .bounces = 0, .ambient = true, .ambientDistance = distance, .suffix = "_ambient", .label = ", ao" };
}

// With equal-error samples of stratified path tracing over the method's: Figs. 4.1, 4.6, 4.7, 4.11.
const Paper sponza = thesisRow("Sponza", 262e3, 63, 181, 580, 761, 10, 55, 65, 826, 1.21, 1.31, 324.0 / 63);
const Paper conference = thesisRow("Conference", 331e3, 60, 87, 274, 361, 9, 46, 55, 416, 2.40, 2.77, 440.0 / 60);
const Paper figure1 =
    thesisRow("Cornell box, 1 bounce", 145e3, 56, 70, 291, 361, 9, 63, 72, 433, 2.31, 2.77, 298.0 / 56);
const Paper figure2 = thesisRow("Cornell box, 2 bounces", 145e3, 56, 70, 802, 872, 10, 62, 72, 944, 1.06, 1.14);
const Paper figure3 = thesisRow("Cornell box, 3 bounces", 145e3, 56, 72, 1423, 1495, 10, 64, 74, 1569, 0.63, 0.67);
const Paper glossy1 =
    thesisRow("Glossy Cornell box, 1 bounce", 16.7e3, 59, 70, 248, 318, 12, 49, 61, 379, 2.64, 3.14, 361.0 / 59);
const Paper glossy2 = thesisRow("Glossy Cornell box, 2 bounces", 16.7e3, 59, 68, 622, 690, 10, 57, 67, 757, 1.32, 1.44);

std::vector<BenchmarkScene> scenes()
{
    // Half of what the thesis' overheads are of its frames, about.
    constexpr double cornellOverhead = 0.08;
    // A quarter of the box.
    constexpr float cornellAmbientDistance = 0.5f;
    return {
        { generatedScene("cornell_glossy", generator::makeCornellGlossy),
            { paths(1, glossy1), paths(2, glossy2), ambientOcclusion(cornellAmbientDistance) },
            { { "samples_saved", 5 }, { "overhead", cornellOverhead } }, false, true, {} },
        { generatedScene("cornell_figure", generator::makeCornellFigure),
            { paths(1, figure1), paths(2, figure2), paths(3, figure3) },
            { { "samples_saved", 5 }, { "overhead", cornellOverhead }, { "overhead_3_bounces", 0.025 } }, true, false,
            {} },
        { externalScene("aaf2013_cornell_bunny", "the authors' Cornell box with a bunny, from WEDGE_DATA",
              "aaf2013_cornell_bunny/cornell_bunny.obj"),
            { paths(1) }, { { "samples_saved", 9 }, { "overhead", cornellOverhead } }, false, false, {} },
        { externalScene("crytek_sponza", "Sponza, from WEDGE_DATA", "crytek_sponza/sponza.obj"), { paths(1, sponza) },
            { { "samples_saved", 5 }, { "overhead", 0.04 } }, false, false, {} },
        { externalScene("conference", "the conference room, from WEDGE_DATA", "conference/conference.obj"),
            { paths(1, conference) }, { { "samples_saved", 7 }, { "overhead", 0.065 } }, true, false, {} },
        // Fig. 4.12 shows ambient occlusion and has no figures. Under the open sky, then.
        { generatedScene("bench", generator::makeBench), { ambientOcclusion(0) }, {}, false, false, {} },
        { generatedScene("spheres", generator::makeSpheres), { ambientOcclusion(0) }, {}, false, false, {} },
    };
}

std::vector<TimingColumn> columns()
{
    return withFrameColumns({
        ofPasses("camera_and_direct", { "primary rays", "first pass", "second pass", "point lights" }),
        ofPasses("first_pass", { "first paths" }),
        ofPasses("second_pass", { "second paths" }),
        tracing(),
        ofPasses("widths", { "widths" }),
        ofPasses("counts", { "counts" }),
        ofPasses("first_pass_filter", { "pixels gathered", "filter of first pass" }),
        widthsAndCounts(),
        ofPasses("filter_indirect", { "filter of indirect" }),
    });
}

} // namespace

int main(int argc, char** argv)
{
    return runBenchmark(argc, argv,
        {
            .program = "indirect",
            .about = "Measures indirect light: times of Table 4.1, errors of Figs. 4.9 and 4.10, samples saved.",
            .table = "Table 4.1",
            .quickMeans = "320x240 and fewer points: a look",
            .plan = { .frames = 5,
                .seeds = 2,
                .referenceSpp = 1024,
                .largestBaseline = 400,
                .subtractNoise = true,
                .baselineSpp = { 16, 64, 144 },
                .budgets = { 16, 28, 64 },
                .publishedMu = { 0.5f, 0.9f, 2 },
                .largestBudget = 150,
                .biasSeeds = 4 },
            .quick = { .width = 320,
                .height = 240,
                .frames = 3,
                .seeds = 2,
                .referenceSpp = 256,
                .largestBaseline = 256,
                .subtractNoise = true,
                .baselineSpp = { 16, 64 },
                .budgets = { 16, 64 },
                .publishedMu = { 0.5f, 0.9f },
                .largestBudget = 150,
                .biasSeeds = 2 },
            .planData =
                [](const MeasurePlan& plan) {
                    return Json { { "bias_seeds", plan.biasSeeds } };
                },
            .subject = [](const MeasurePlan& plan) -> std::shared_ptr<Subject> {
                return std::make_shared<IndirectLight>(plan.referenceSpp);
            },
            .scenes = scenes(),
            .fileScene = { {}, { paths(1) }, {}, false, false, {} },
            .goals = { { "wall_gap*", 0.05 }, { "first_frame*", 1.1 } },
            .baselines = { { "stratified", "path tracing, stratified", Sampler::Stratified },
                { "sobol", "path tracing, Owen-scrambled Sobol", Sampler::Sobol } },
            .fixedWidth =
                FixedWidthRule { .firstWidth = 2.0f, .firstPass = WEDGE_INDIRECT_FIRST_RAYS, .uniformCounts = true },
            .ablations = { { false, Filtering::None, true }, { false, Filtering::Adaptive },
                { true, Filtering::Adaptive } },
            .columns = columns(),
            .times = thesisTable("cam+dir", "camera_and_direct"),
            .sceneData = [](const SceneResult&) { return Json::object(); },
            .settingData =
                [](const CaseSetting& setting) {
                    return Json { { "setting", settingName(setting.published) }, { "bounces", *setting.of.bounces },
                        { "paper", setting.of.paper.row } };
                },
        });
}
