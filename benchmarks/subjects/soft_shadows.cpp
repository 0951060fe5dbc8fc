// soft_shadows: chapter 3 of the thesis, measured on its scenes; docs/benchmarks.md.
#include "benchmarks/harness/scene_result.h"
#include "benchmarks/harness/thesis_table.h"
#include "data/generator/lottery/lottery.h"
#include "kernels/shared/wedge.h"

#include <fmt/format.h>

namespace {

using namespace wedge;
using namespace wedge::benchmark;
using render::Filtering;
using render::Sampler;
using render::Shading;

/// The whole image, and of the thesis' shading at the light's centre or of the true integral.
class SoftShadows : public Subject {
public:
    explicit SoftShadows(int referenceSpp)
        : referenceSpp_(referenceSpp)
    {
    }

    std::string program() const override { return "soft_shadows"; }
    Integrand integrandOf(const render::Settings& settings) const override
    {
        // Light that is known exactly where nothing is in the way needs no samples: less noise than plain Monte Carlo
        // has. The thesis' shading is compared at larger errors, so that half the samples do.
        const bool apart = settings.shading == Shading::Separate;
        Integrand out { apart ? "shading apart" : "true integral",
            render::monteCarlo(apart ? referenceSpp_ / 2 : referenceSpp_) };
        out.settings.shading = apart ? Shading::Separate : Shading::Ratio;
        return out;
    }
    double sppOf(const render::FrameStatistics& frame) const override { return frame.sppMean; }
    double raysOf(const render::FrameStatistics& frame) const override { return static_cast<double>(frame.shadowRays); }
    float muOf(const render::Settings& settings) const override { return settings.mu; }
    std::string describe(const render::Settings& s) const override
    {
        if (s.method != render::Method::MonteCarlo) {
            return describeVariant(s, s.mu, s.sampling == render::Sampling::Adaptive);
        }
        constexpr const char* shadings[] = { "separate", "inside", "ratio" };
        return fmt::format("unfiltered {} {}", s.sampler == Sampler::Sobol ? "sobol" : "stratified",
            shadings[static_cast<int>(s.shading)]);
    }

private:
    int referenceSpp_;
};

// The budget at which the default setting is judged, and the published one's mu (Table 3.1).
constexpr int usualSpp = 28;
constexpr float usualMu = 2.0f;

// Section 3.5.3: six times fewer samples on Grids. Fig. 3.9: Tentacles at 23 samples equals 200 unfiltered ones.
const Paper gridsRow = thesisRow("Grids", 200, 14.2, 6.56, 13.8, 20.4, 3.70, 1.31, 5.01, 25.4, 39, 49, 6.0);
const Paper benchRow = thesisRow("Bench", 309e3, 28.0, 50.9, 374, 425, 3.51, 1.27, 4.78, 430, 2.3, 2.3);
const Paper tentaclesRow =
    thesisRow("Tentacles", 145e3, 26.3, 49.0, 239, 288, 3.50, 1.29, 4.79, 293, 3.4, 3.5, 200.0 / 23.0);
const Paper spheresRow = thesisRow("Spheres", 72e3, 33.8, 56.9, 285, 342, 3.70, 1.29, 4.99, 347, 2.9, 2.9);

/// Names of files below WEDGE_DATA.
constexpr const char* gridsMesh = "aaf2012_grids/grids.obj";
constexpr const char* spheresMesh = "aaf2012_spheres/spheres.obj";

/// A scene with the chapter's row and goals.
BenchmarkScene shadowScene(SceneSource source, Paper paper, Numbers goals, bool curves)
{
    return { std::move(source), { { .paper = std::move(paper) } }, std::move(goals), curves, false, {} };
}

SceneSource authors(const std::string& name, const std::string& mesh)
{
    return externalScene(name, "the authors' mesh, from WEDGE_DATA", mesh);
}

std::vector<BenchmarkScene> scenes()
{
    const Numbers gridsGoals { { "samples_saved", 15 }, { "samples_saved_published", 6 }, { "overhead*", 0.20 } };
    const Numbers spheresGoals { { "samples_saved", 5 }, { "overhead*", 0.03 } };
    const Numbers others { { "samples_saved", 4 }, { "overhead*", 0.03 } };
    return {
        shadowScene(generatedScene("grids", generator::makeGrids), gridsRow, gridsGoals, true),
        shadowScene(generatedScene("bench", generator::makeBench), benchRow, others, true),
        shadowScene(generatedScene("tentacles", generator::makeTentacles), tentaclesRow, others, true),
        shadowScene(generatedScene("spheres", generator::makeSpheres), spheresRow, spheresGoals, true),
        // What the chapter has not: lobes; open ground whose lights dip below horizons, under sharp highlights; clutter
        // under four lights. No goals: the lottery has those.
        shadowScene(generatedScene("cornell_glossy", generator::makeCornellGlossy), {}, {}, false),
        shadowScene(generatedScene("lottery_97", [] { return generator::makeLottery(97); }), {}, {}, false),
        shadowScene(generatedScene("lottery_122", [] { return generator::makeLottery(122); }), {}, {}, false),
        shadowScene(authors("aaf2012_grids_cut2", gridsMesh), gridsRow, gridsGoals, true),
        shadowScene(authors("aaf2012_spheres_cut2", spheresMesh), spheresRow, spheresGoals, false),
        // As their authors light them. No goal for the samples: light cut at 1 sigma is nearly uniform.
        shadowScene(authors("aaf2012_grids", gridsMesh), gridsRow, { { "overhead*", 0.20 } }, false),
        shadowScene(authors("aaf2012_spheres", spheresMesh), spheresRow, { { "overhead*", 0.03 } }, false),
    };
}

/// What the filtered methods are made of.
Change shaded(Shading shading)
{
    return [shading](render::Settings& settings) {
        settings.shading = shading;
        settings.lightSampling = render::LightSampling::Lights;
    };
}

std::vector<TimingColumn> columns()
{
    return withFrameColumns({
        ofPasses("primary", { "primary rays" }),
        ofPasses("first_pass", { "first pass" }),
        ofPasses("second_pass", { "second pass" }),
        tracing(),
        ofPasses("widths", { "widths" }),
        ofPasses("counts", { "counts" }),
        ofPasses("first_pass_filter", { "filter of first pass" }),
        widthsAndCounts(),
    });
}

} // namespace

int main(int argc, char** argv)
{
    return runBenchmark(argc, argv,
        {
            .program = "soft_shadows",
            .about = "Measures soft shadows: times of Table 3.1, errors of Fig. 3.6c, samples saved.",
            .table = "Table 3.1",
            .quickMeans = "320x240 and fewer points, about two minutes",
            .plan = { .baselineSpp = { 9, 25, 64, 144 },
                .budgets = { 9, 16, 28, 64, 128 },
                .publishedMu = { 0.5f, 1, 2, 3, 4, 6, 8 },
                .largestBudget = 100,
                .mu = { 1, 2, 4, 6 } },
            .quick = { .width = 320,
                .height = 240,
                .frames = 3,
                .referenceSpp = 256,
                .largestBaseline = 225,
                .baselineSpp = { 9, 25, 64 },
                .budgets = { 9, 28 },
                .publishedMu = { 1, 2 },
                .largestBudget = 60,
                .mu = { 1, 2, 4 } },
            .planData =
                [](const MeasurePlan&) {
                    return Json { { "default_spp", usualSpp }, { "published_mu", usualMu } };
                },
            .references = 2,
            .subject = [](const MeasurePlan& plan) -> std::shared_ptr<Subject> {
                return std::make_shared<SoftShadows>(plan.referenceSpp);
            },
            .scenes = scenes(),
            .fileScene = shadowScene({}, {}, {}, true),
            .goals = { { "wall_gap*", 0.05 }, { "first_frame*", 1.1 }, { "mu_monotonic*", 1 } },
            .needsAreaLight = true,
            .usualSpp = usualSpp,
            .usualMu = usualMu,
            .baselines = { { "stratified", "unfiltered, stratified, shaded like the method", Sampler::Stratified, true,
                               false, shaded(Shading::Ratio) },
                { "sobol", "unfiltered, Owen-scrambled Sobol, shaded like the method", Sampler::Sobol, true, false,
                    shaded(Shading::Ratio) },
                { "plain_mc", "unfiltered, stratified, cosine and distance sampled too", Sampler::Stratified, true,
                    false, shaded(Shading::Inside) },
                { "stratified_separate", "unfiltered, stratified, shading apart from visibility", Sampler::Stratified,
                    false, true, shaded(Shading::Separate) } },
            .fixedWidth =
                FixedWidthRule { .firstWidth = 0.8f, .firstPass = WEDGE_FIRST_PASS_RAYS, .uniformCounts = false },
            .ablations = { { false, Filtering::None }, { false, Filtering::Fixed }, { false, Filtering::Adaptive },
                { true, Filtering::None }, { true, Filtering::Fixed }, { true, Filtering::Adaptive } },
            .columns = columns(),
            .times = thesisTable("primary", "primary"),
            .raysKey = "shadow_rays",
            .settingsByName = true,
            .sceneData =
                [](const SceneResult& result) {
                    return Json { { "paper", result.source.cases.front().paper.row } };
                },
            .settingData = [](const CaseSetting&) { return Json::object(); },
        });
}
