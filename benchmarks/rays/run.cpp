#include "benchmarks/rays/run.h"

#include "benchmarks/common/synthetic_mesh.h"
#include "host/error.h"

#include <cmath>

namespace wedge::benchmark {
namespace {

/// The set of primary rays with what they hit.
struct PrimaryHits {
    RaySet set;
    std::vector<Receiver> receivers;
};

PrimaryHits primaryHits(const scene::Scene& scene, WedgeTracer& tracer, const BuiltScene& built, const RayPlan& plan)
{
    PrimaryHits out { primaryRays(scene, plan.width, plan.height), {} };
    WedgeRays rays(tracer, out.set);
    rays.trace(built.hierarchy(), false);
    out.receivers = receiversOf(scene, out.set, rays.hits(), plan.width);
    return out;
}

std::vector<RaySet> allSets(const scene::Scene& scene, PrimaryHits primary, const RayPlan& plan)
{
    std::vector<RaySet> out;
    const auto& receivers = primary.receivers;
    if (!scene.areaLights.empty())
        out.push_back(areaShadowRays(scene, receivers, plan.shadowSamples));
    out.push_back(ambientRays(scene, receivers, plan.ambientSamples));
    out.push_back(diffuseRays(receivers));
    out.insert(out.begin(), std::move(primary.set));
    std::erase_if(out, [](const RaySet& set) { return set.live == 0; });
    return out;
}

std::vector<BuildResult> buildsOf(const BuiltScene& built, double triangles)
{
    std::vector<BuildResult> out;
    for (const auto& h : built.hierarchies())
        out.push_back({ h->mode.empty() ? "wedge" : "wedge " + h->mode, h->bvh().statistics.buildSeconds,
            static_cast<double>(h->bvh().statistics.bytes) / triangles });
    for (const auto& scene : built.embree())
        out.push_back({ "embree " + scene->build().name, scene->buildSeconds(),
            static_cast<double>(scene->bytes()) / triangles });
    return out;
}

void tell(const std::string& scene, const ClassResult& result)
{
    const auto median = [&](const std::string& column) { return summarize(result.megarays(column)).median; };
    progress(
        fmt::format("{} {}: {} rays, {:.1f} Mrays/s, Embree single {:.1f}, packets of the high-quality build {:.1f}; "
                    "{} hits differ, {} of them unexplained",
            scene, result.name, result.rays, median(result.chosen()), median("embree single"),
            median("embree packets high"), result.difference.disagreements.size(), result.difference.unexplained()));
}

} // namespace

RaySceneResult measureRayScene(const RayScene& source, WedgeTracer& tracer, Workers& workers, const RayPlan& plan)
{
    const scene::Scene scene = source.load();
    RaySceneResult out { source.name, source.origin, scene.geometry.indices.size() / 3, {}, {}, {}, {} };
    if (out.triangles == 0)
        throw Error("scene", source.name, "name one that has triangles");
    const BuiltScene built(tracer, { scene.geometry.positions, scene.geometry.indices }, workers.threads(), true);
    out.builds = buildsOf(built, static_cast<double>(out.triangles));
    for (const RaySet& set : allSets(scene, primaryHits(scene, tracer, built, plan), plan)) {
        out.classes.push_back(measureClass(tracer, built, set, workers, plan));
        tell(out.name, out.classes.back());
    }
    out.noFrame = plan.frame ? frameProblem(scene) : "not asked for";
    if (out.noFrame.empty())
        out.frame = measureFrame(scene, tracer, built, workers, plan);
    return out;
}

std::vector<std::size_t> growthSizes(int steps)
{
    std::vector<std::size_t> out;
    for (int i = 0; i < steps; ++i)
        out.push_back(static_cast<std::size_t>(std::llround(std::pow(10.0, 3 + 0.5 * i))));
    return out;
}

GrowthPoint measureGrowth(std::size_t triangles, WedgeTracer& tracer, Workers& workers, const RayPlan& plan)
{
    const scene::Scene scene = syntheticScene(triangles);
    const BuiltScene built(tracer, { scene.geometry.positions, scene.geometry.indices }, workers.threads(), false);
    const PrimaryHits primary = primaryHits(scene, tracer, built, plan);
    GrowthPoint out { triangles, {} };
    for (const RaySet& set : { primary.set, diffuseRays(primary.receivers) }) {
        out.classes.push_back(measureClass(tracer, built, set, workers, plan));
        tell(fmt::format("field of {}", triangles), out.classes.back());
    }
    return out;
}

} // namespace wedge::benchmark
