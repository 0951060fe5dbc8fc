#include "benchmarks/bvh_build/measure.h"

#include "benchmarks/bvh_build/builders.h"
#include "benchmarks/bvh_build/memory_use.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <ctime>

namespace wedge::benchmark {
namespace {

double wallMs()
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Of all threads of the process.
double cpuMs() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Builds until a clock's tick does not show, and returns times of one build.
std::pair<double, double> timeBuild(Builder& builder, const bvh::Mesh& mesh)
{
    constexpr double enoughMs = 4;
    double wall = 0, cpu = 0;
    int builds = 0;
    do {
        builder.prepare(mesh);
        const double wallStart = wallMs(), cpuStart = cpuMs();
        builder.build();
        cpu += cpuMs() - cpuStart;
        wall += wallMs() - wallStart;
        builder.release();
        builds++;
    } while (wall < enoughMs);
    return { wall / builds, cpu / builds };
}

BuildSet measureSet(const bvh::Mesh& mesh, unsigned threads, const BuildPlan& plan)
{
    BuildSet set;
    set.threads = threads;
    const std::vector<NamedBuilder> builders = makeBuilders(threads);
    const double start = wallMs();
    for (const NamedBuilder& named : builders) {
        BuildTimes times { named.name, named.peer, {}, {}, 0, {} };
        named.builder->prepare(mesh);
        times.peakBytes = peakMemory([&] { named.builder->build(); });
        times.bytes = named.builder->bytes();
        if (times.peakBytes && *times.peakBytes < times.bytes) // it lay in memory that the process had left over
            times.peakBytes.reset();
        named.builder->release();
        set.builders.push_back(std::move(times));
    }
    for (int i = 0; i < plan.repeats && (i < 3 || wallMs() - start < 1e3 * plan.secondsEach); i++)
        for (std::size_t b = 0; b < builders.size(); b++) {
            const auto [wall, cpu] = timeBuild(*builders[b].builder, mesh);
            set.builders[b].wallMs.push_back(wall);
            set.builders[b].cpuMs.push_back(cpu);
        }
    return set;
}

} // namespace

const BuildTimes& BuildSet::operator[](const std::string& name) const
{
    const auto found = std::ranges::find(builders, name, &BuildTimes::name);
    assert(found != builders.end());
    return *found;
}

Summary BuildSet::ratio(const std::string& name, const std::string& by, bool cpuTime) const
{
    const auto& a = cpuTime ? (*this)[name].cpuMs : (*this)[name].wallMs;
    const auto& b = cpuTime ? (*this)[by].cpuMs : (*this)[by].wallMs;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < a.size(); i++)
        ratios.push_back(a[i] / b[i]);
    return summarize(ratios);
}

SceneBuilds measureBuilds(const std::string& name, const bvh::Mesh& mesh, const BuildPlan& plan)
{
    SceneBuilds out { name, mesh.indices.size() / 3, {} };
    for (const unsigned threads : plan.threads)
        out.sets.push_back(measureSet(mesh, threads, plan));
    return out;
}

} // namespace wedge::benchmark
