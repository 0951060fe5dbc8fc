#include "benchmarks/rays/measure.h"

#include "bvh/host_traverse.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace wedge::benchmark {
namespace {

constexpr std::size_t countedRays = 20'000;

/// Rays for which two lists differ in any bit.
template <class T>
std::size_t mismatches(const RaySet& set, const std::vector<T>& a, const std::vector<T>& b)
{
    std::size_t out = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        out += isLive(set.rays[i]) && std::memcmp(&a[i], &b[i], sizeof(T)) != 0 ? 1 : 0;
    return out;
}

shared::Hit embreeNearest(const EmbreeScene& scene, Workers& workers, const bvh::Ray& ray)
{
    RaySet one { "one", false, false, std::vector<bvh::Ray>(packetRays, ray), 1 };
    EmbreeRays rays(one);
    rays.trace(scene, EmbreeWay::Single, workers);
    return rays.hits().front();
}

/// What the contenders find on one set, compared.
void compare(
    ClassResult& out, const BuiltScene& built, const RaySet& set, WedgeRays& ours, EmbreeRays& theirs, Workers& workers)
{
    const WedgeHierarchy& hierarchy = built.hierarchy();
    const auto against = [&](const std::string& build, bool packets) {
        ours.trace(hierarchy, packets);
        theirs.trace(built.embree(build), EmbreeWay::Single, workers);
        if (!set.anyHit)
            return compareHits(built.mesh(), set, ours.hits(), theirs.hits());
        return compareOccluded(
            built.mesh(), set, ours.occluded(), theirs.occluded(),
            [&](const bvh::Ray& ray) { return bvh::closestHit(hierarchy.bvh(), ray); },
            [&](const bvh::Ray& ray) { return embreeNearest(built.embree(build), workers, ray); });
    };
    out.difference = against("default", set.coherent);
    out.differenceFromRobust = against("robust", set.coherent);
    ours.trace(hierarchy, false);
    if (set.anyHit) {
        const auto single = ours.occluded();
        ours.trace(hierarchy, true);
        out.packetMismatches = mismatches(set, single, ours.occluded());
    } else {
        const auto single = ours.hits();
        ours.trace(hierarchy, true);
        out.packetMismatches = mismatches(set, single, ours.hits());
    }
}

} // namespace

BuiltScene::BuiltScene(WedgeTracer& tracer, const bvh::Mesh& mesh, unsigned threads, bool all)
    : mesh_(mesh)
    , embreeMesh_(mesh.positions, mesh.indices)
{
    hierarchies_.push_back(std::make_unique<WedgeHierarchy>(tracer, "", bvh::build(mesh)));
    if (all)
        hierarchies_.push_back(
            std::make_unique<WedgeHierarchy>(tracer, "quality", bvh::build(mesh, bvh::config(bvh::Mode::Quality))));
    std::vector<EmbreeBuild> builds = { { "default" }, { "high", 0, true } };
    if (all)
        builds.insert(builds.end(), { { "bvh8", 8 }, { "bvh4", 4 }, { "robust", 0, false, true } });
    for (const EmbreeBuild& build : builds)
        embree_.push_back(std::make_unique<EmbreeScene>(embreeMesh_, build, threads));
}

const EmbreeScene& BuiltScene::embree(const std::string& build) const
{
    const auto found = std::ranges::find_if(embree_, [&](const auto& scene) { return scene->build().name == build; });
    if (found == embree_.end())
        throw std::out_of_range("no such build: " + build);
    return **found;
}

std::vector<EmbreeColumn> BuiltScene::columns() const
{
    std::vector<EmbreeColumn> out;
    for (const auto& scene : embree_) {
        const EmbreeBuild& build = scene->build();
        const std::string suffix = build.name == "default" ? "" : " " + build.name;
        out.push_back({ "embree single" + suffix, scene.get(), EmbreeWay::Single });
        if (build.width == 0 && !build.robust) {
            out.push_back({ "embree packets" + suffix, scene.get(), EmbreeWay::Packets });
            if (embreeHasStreams)
                out.push_back({ "embree stream" + suffix, scene.get(), EmbreeWay::Stream });
        }
    }
    return out;
}

std::string wedgeColumn(bool packets, const std::string& mode)
{
    return std::string("wedge ") + (packets ? "packets" : "single") + (mode.empty() ? "" : " " + mode);
}

const Runs& ClassResult::column(const std::string& wanted) const
{
    const auto found = std::ranges::find(runs, wanted, &Runs::name);
    if (found == runs.end())
        throw std::out_of_range("no such column: " + wanted);
    return *found;
}

std::string ClassResult::chosen(const std::string& mode) const { return wedgeColumn(true, mode); }

std::string ClassResult::embreeBest() const
{
    const Runs* best = nullptr;
    for (const Runs& r : runs)
        if (!r.ours && !r.name.ends_with("robust")
            && (best == nullptr || summarize(r.seconds).median < summarize(best->seconds).median))
            best = &r;
    return best->name;
}

std::vector<double> ClassResult::megarays(const std::string& name_) const
{
    std::vector<double> out;
    for (const double seconds : column(name_).seconds)
        out.push_back(1e-6 * static_cast<double>(rays) / seconds);
    return out;
}

std::vector<double> ClassResult::ratios(const std::string& ours, const std::string& theirs) const
{
    const Runs &a = column(ours), &b = column(theirs);
    std::vector<double> out;
    for (std::size_t i = 0; i < a.seconds.size(); ++i)
        out.push_back(b.seconds[i] / a.seconds[i]);
    return out;
}

ClassResult measureClass(
    WedgeTracer& tracer, const BuiltScene& built, const RaySet& set, Workers& workers, const RayPlan& plan)
{
    ClassResult out;
    out.name = set.name;
    out.anyHit = set.anyHit;
    out.coherent = set.coherent;
    out.rays = set.live;
    WedgeRays ours(tracer, set);
    EmbreeRays theirs(set);
    std::vector<Contender> contenders;
    for (const auto& hierarchy : built.hierarchies())
        for (const bool packets : { false, true })
            contenders.push_back({ wedgeColumn(packets, hierarchy->mode), true,
                [&ours, tree = hierarchy.get(), packets] { ours.trace(*tree, packets); } });
    for (const EmbreeColumn& column : built.columns())
        contenders.push_back({ column.name, false, [&, column] { theirs.trace(*column.scene, column.way, workers); } });
    out.runs = timeInterleaved(contenders, plan.timing);
    out.counts = countTraversal(built.hierarchy().bvh(), set, countedRays);
    const auto hasRobust = [](const auto& scene) { return scene->build().robust; };
    if (std::ranges::any_of(built.embree(), hasRobust))
        compare(out, built, set, ours, theirs, workers);
    return out;
}

} // namespace wedge::benchmark
