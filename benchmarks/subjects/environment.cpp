// environment: section 6.6 of the thesis, measured on scenes like those of Fig. 6.7; docs/benchmarks.md.
#include "benchmarks/common/smooth_region.h"
#include "benchmarks/harness/scene_result.h"
#include "benchmarks/harness/thesis_table.h"

#include <fmt/format.h>

namespace {

using namespace wedge;
using namespace wedge::benchmark;
using render::Sampler;

/// The whole image, of which smooth regions are told apart.
class EnvironmentLight : public Subject {
public:
    explicit EnvironmentLight(int referenceSpp)
        : referenceSpp_(referenceSpp)
    {
    }

    std::string program() const override { return "environment"; }
    Integrand integrandOf(const render::Settings& settings) const override
    {
        render::Settings reference = render::monteCarlo(referenceSpp_);
        reference.bounces = settings.bounces;
        return { "whole image", reference };
    }
    double sppOf(const render::FrameStatistics& frame) const override { return frame.sppMean; }
    double raysOf(const render::FrameStatistics& frame) const override
    {
        return static_cast<double>(frame.shadowRays + frame.indirectRays);
    }
    float muOf(const render::Settings& settings) const override { return settings.indirect.mu; }
    std::vector<bool> regionOf(const Reference& reference) const override { return smoothRegion(reference); }
    std::string describe(const render::Settings& s) const override
    {
        if (s.method != render::Method::MonteCarlo) {
            return describeVariant(s, s.indirect.mu, s.sampling == render::Sampling::Adaptive);
        }
        return fmt::format("unfiltered {}", s.sampler == Sampler::Sobol ? "sobol" : "stratified");
    }

private:
    int referenceSpp_;
};

// The method's budget in section 6.7.
constexpr int usualSpp = 16;

/// A scene of direct light. saved: goal of samples, none for 0.
BenchmarkScene environmentScene(SceneSource source, double saved)
{
    return { std::move(source), { {} }, saved > 0 ? Numbers { { "samples_saved", saved } } : Numbers {}, false, false,
        {} };
}

/// A dragon on a plane under a light probe.
BenchmarkScene dragon(const std::string& probe, const char* look, const char* meaning, const char* map, double saved)
{
    return environmentScene(externalScene(fmt::format("{}_{}", probe, look),
                                fmt::format("{} dragon on a plane under {}, from WEDGE_DATA", meaning, probe),
                                "models/dragon/dragon_aaf.obj", map),
        saved);
}

std::vector<BenchmarkScene> scenes()
{
    struct Probe {
        const char *name, *map;
        double saved; ///< goal of the diffuse object
    };
    std::vector<BenchmarkScene> out { environmentScene(
        shippedScene("sky", "spheres, matt and glossy, under data/scenes' sky"), 0) };
    for (const Probe& probe :
        { Probe { "uffizi", "hdr/uffizi.hdr", 10 }, Probe { "sunrise", "hdr/blouberg_sunrise_2_1k.hdr", 10 },
            Probe { "grace", "hdr/grace_latlong.exr", 5 }, Probe { "field", "hdr/field_sun.exr", 10 } }) {
        out.push_back(dragon(probe.name, "diffuse", "a matt", probe.map, probe.saved));
        out.push_back(dragon(probe.name, "glossy", "a glossy (Phong 64)", probe.map, 4));
    }
    return out;
}

std::vector<TimingColumn> columns()
{
    return withFrameColumns({
        ofPasses("primary", { "primary rays" }),
        ofPasses("first_pass", { "first paths" }),
        ofPasses("second_pass", { "second paths" }),
        tracing(),
        ofPasses("widths", { "widths" }),
        ofPasses("counts", { "counts" }),
        ofPasses("first_pass_filter", { "pixels gathered", "filter of first pass" }),
        widthsAndCounts(),
    });
}

} // namespace

int main(int argc, char** argv)
{
    return runBenchmark(argc, argv,
        {
            .program = "environment",
            .about = "Measures light from beyond the scene: errors, samples saved, overhead (sections 6.6 and 6.7).",
            .table = "the table of times",
            .quickMeans = "160x120 and fewer points, two minutes",
            .plan = { .width = 320,
                .height = 240,
                .timedWidth = 640,
                .timedHeight = 480,
                .frames = 5,
                .seeds = 4,
                .referenceSpp = 2048,
                .largestBaseline = 1024,
                .subtractNoise = true,
                .baselineSpp = { 16, 64, 256 },
                .powersOfFour = true },
            .quick = { .width = 160,
                .height = 120,
                .frames = 3,
                .seeds = 2,
                .referenceSpp = 512,
                .largestBaseline = 256,
                .subtractNoise = true,
                .baselineSpp = { 16, 64 },
                .powersOfFour = true },
            .planData =
                [](const MeasurePlan& plan) {
                    return Json { { "default_spp", usualSpp },
                        { "timed_width", plan.timedWidth > 0 ? plan.timedWidth : plan.width },
                        { "timed_height", plan.timedHeight > 0 ? plan.timedHeight : plan.height } };
                },
            .subject = [](const MeasurePlan& plan) -> std::shared_ptr<Subject> {
                return std::make_shared<EnvironmentLight>(plan.referenceSpp);
            },
            .scenes = scenes(),
            .fileScene = environmentScene({}, 0),
            .goals = { { "smooth_saved", 25 }, { "vs_fixed_blur", 1 }, { "overhead", 0.12 } },
            .usualSpp = usualSpp,
            .baselines = { { "sobol", "mc, Owen-scrambled Sobol: its default", Sampler::Sobol },
                { "stratified", "mc, jittered strata", Sampler::Stratified } },
            .blurWidth = 2.0f,
            .rival = Rival { "flt", "as published, with the bandwidth (6.19) of frequency analysis of light transport",
                [](render::Settings& s) { s.environment.widths = render::EnvironmentWidths::LightTransport; } },
            .region = "smooth",
            .columns = columns(),
            .times = thesisTable("primary", "primary"),
            .sceneData = [](const SceneResult&) { return Json::object(); },
            .settingData =
                [](const CaseSetting& setting) {
                    return Json { { "setting", settingName(setting.published) } };
                },
        });
}
