// indirect.cl alone: the rays over a pixel's hemisphere, against the host's traversal and form factors in double.
#include "kernels/shared/bsdf.h"
#include "kernels/shared/path.h"
#include "tests/trace_support.h"

#include <algorithm>
#include <cstring>
#include <numbers>
#include <optional>

using namespace wedge;
using namespace wedge::test;

namespace {

/// "path", as kernels/paths/indirect.cl seeds its samples.
constexpr std::uint32_t pathSeed = 0x70617468u;
constexpr float infinity = std::numeric_limits<float>::infinity();

/// What samplePaths leaves behind.
struct PathResult {
    Planes<float> sums, value, parts, reflectors;
    Planes<std::uint32_t> taken, rays, pathRays;

    bool operator==(const PathResult& other) const
    {
        const auto same = [](const auto& a, const auto& b) {
            return std::memcmp(a.values.data(), b.values.data(), 4 * a.values.size()) == 0;
        };
        return same(sums, other.sums) && same(value, other.value) && same(parts, other.parts)
            && same(reflectors, other.reflectors) && same(taken, other.taken) && same(rays, other.rays)
            && same(pathRays, other.pathRays);
    }
};

/// samplePaths of a frame that keeps means, and of one that keeps what parts of samples are, any number of calls.
class PathRun {
public:
    PathRun(const scene::Scene& scene, const device::Device& device, int width, int height,
        const render::Options& options = renderOptions())
        : traced(scene, device, width, height, keeping(false), options)
        , ofParts_(scene, device, width, height, keeping(true), options)
    {
        clear();
        params.bounces = 1;
        params.sampler = WEDGE_SAMPLER_SOBOL;
        params.lightSampling = WEDGE_LIGHTS_BOTH;
        params.areaLights = static_cast<std::uint32_t>(traced.onDevice.areaLightList.size());
        params.deltaLights = traced.onDevice.deltaLightCount;
        params.sceneDiameter = traced.onDevice.diameter;
        params.ambientDistance = infinity;
    }

    /// Forgets all samples.
    void clear()
    {
        means_.emplace(traced, "samplePaths", "first paths");
        means_->plane("value", std::vector(3 * traced.layout.size, -7.0f));
        parts_.emplace(ofParts_, "samplePaths", "first paths");
    }

    /// Samples up to `last`, of `wanted` each pixel.
    void sample(std::uint32_t wanted, std::uint32_t last)
    {
        sample(std::vector<std::uint32_t>(traced.layout.size, wanted), last);
    }
    void sample(const std::vector<std::uint32_t>& wanted, std::uint32_t last)
    {
        for (auto* pass : { &means_, &parts_ }) {
            (*pass)->value("params", params);
            (*pass)->upTo(last, wanted);
        }
    }
    PathResult result() const
    {
        REQUIRE(parts_->read<float>("sums") == means_->read<float>("sums"));
        return { means_->pixels<float>("sums"), means_->pixels<float>("value"), parts_->pixels<float>("parts"),
            means_->pixels<float>("reflectors"), means_->pixels<std::uint32_t>("taken"),
            means_->pixels<std::uint32_t>("rays"), means_->pixels<std::uint32_t>("pathRays") };
    }

    TracedScene traced;
    shared::PathParams params {};

private:
    static render::Settings keeping(bool parts)
    {
        render::Settings settings = render::axisAligned(16);
        settings.bounces = 1;
        settings.fallback = parts;
        settings.widening = 0;
        return settings;
    }

    TracedScene ofParts_;
    std::optional<Samples> means_, parts_;
};

/// A floor with a slanted plate and a sphere over it.
scene::Scene plateOverFloor()
{
    SceneBuilder b;
    b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
    b.newObject();
    b.quad({ 0.2f, 0.8f, 0 }, { 0.1f, 0.1f, 0.7f }, { 0.6f, -0.15f, 0 });
    b.newObject();
    b.sphere({ -0.9f, 0.4f, 0.3f }, 0.4f);
    b.camera({ 0, 2.2f, 2.8f }, { 0, 0.2f, 0 });
    return b.scene;
}

/// What the ambient component adds up for one pixel, by the host's traversal over the same directions.
struct HostAmbient {
    double hits = 0, inverse = 0;
    double below = 0; ///< directions below a horizon, which the surface itself occludes
    float nearest = 0, farthest = 0;
    std::uint32_t rays = 0;
};

HostAmbient hostAmbient(
    const PathRun& run, int x, int y, shared::Vec3 origin, shared::Vec3 n, shared::Vec3 geometric, std::uint32_t count)
{
    const shared::FrameParams& frame = run.traced.params;
    const std::uint32_t pixel = static_cast<std::uint32_t>(y) * frame.width + static_cast<std::uint32_t>(x);
    const std::uint32_t seed =
        shared::hashCombine(shared::hashCombine(frame.seed, pathSeed + WEDGE_COMPONENT_AMBIENT), pixel);
    HostAmbient out;
    for (std::uint32_t i = 0; i < count; ++i) {
        const shared::Vec3 l = shared::cosineDirection(n, shared::sobolOwen(i, seed));
        if (!(shared::vecDot(geometric, l) > 0) || !(shared::vecDot(n, l) > 0)) {
            out.below += 1;
            continue;
        }
        ++out.rays;
        const shared::Hit hit =
            bvh::closestHit(run.traced.hierarchy(), { origin, 0.0f, l, run.params.ambientDistance });
        if (hit.triangle == WEDGE_NO_TRIANGLE)
            continue;
        out.hits += 1;
        out.inverse += 1.0 / hit.t;
        out.nearest = out.nearest > 0 ? std::min(out.nearest, hit.t) : hit.t;
        out.farthest = std::max(out.farthest, hit.t);
    }
    return out;
}

} // namespace

TEST_CASE("ambient: hits and their distances are those of the host's traversal along the same directions")
{
    onEveryDevice([](const device::Device& device) {
        PathRun run(plateOverFloor(), device, 37, 27);
        run.params.component = WEDGE_COMPONENT_AMBIENT;
        for (const float distance : { infinity, 0.5f }) {
            run.params.ambientDistance = distance;
            run.clear();
            constexpr std::uint32_t count = 40;
            run.sample(count, count);
            const PathResult found = run.result();
            const auto id = run.traced.counts("objectId");
            const auto origin = run.traced.floats("origin"), normal = run.traced.floats("normal");
            const auto geometric = run.traced.counts("geometric");
            unsigned differ = 0, surfaces = 0, partly = 0, none = 0, below = 0;
            run.traced.everyPixel([&](int x, int y) {
                if (id.at(x, y) == 0) {
                    REQUIRE(found.taken.at(x, y) == 0);
                    REQUIRE(found.value.at(x, y) == -7.0f);
                    REQUIRE(found.reflectors.at(x, y) == 0.0f);
                    return;
                }
                ++surfaces;
                const HostAmbient host = hostAmbient(run, x, y, toVec3(origin.vector(x, y)),
                    toVec3(normal.vector(x, y)), shared::unpackDirection(geometric.at(x, y)), count);
                const double occluded = host.hits + host.below;
                below += host.below > 0 ? 1 : 0;
                partly += host.hits > 0 && host.hits < count ? 1 : 0;
                none += host.hits > 0 ? 0 : 1;
                REQUIRE(found.taken.at(x, y) == count);
                // Rays through an edge may go either way.
                if (found.sums.at(x, y) != static_cast<float>(occluded) || found.rays.at(x, y) != host.rays) {
                    ++differ;
                    return;
                }
                for (std::size_t plane = 1; plane < 4; ++plane)
                    REQUIRE(found.sums.at(x, y, plane) == doctest::Approx(occluded).epsilon(1e-5));
                REQUIRE(found.value.at(x, y) == doctest::Approx(occluded / count).epsilon(1e-6));
                REQUIRE(found.pathRays.at(x, y) == host.rays);
                REQUIRE(found.reflectors.at(x, y) == doctest::Approx(host.nearest).epsilon(1e-5));
                REQUIRE(found.reflectors.at(x, y, 1) == doctest::Approx(host.farthest).epsilon(1e-5));
                REQUIRE(std::fabs(found.reflectors.at(x, y, 2) - host.inverse) <= 1e-5 * host.inverse);
            });
            CHECK(differ <= 2);
            CHECK(surfaces > 800);
            CHECK(partly > 100);
            CHECK(none > 50);
            CHECK(below > 3);
        }
    });
}

TEST_CASE("samples in two calls, the second with counts of its own, are the samples taken at once")
{
    onEveryDevice([](const device::Device& device) {
        PathRun run(glossyScene(), device, 21, 14);
        run.params.bounces = 2;
        run.params.firstPass = 16;
        std::vector<std::uint32_t> counts(run.traced.layout.size);
        for (std::size_t i = 0; i < counts.size(); ++i)
            counts[i] = 16 + static_cast<std::uint32_t>(i) % 43;
        for (const std::uint32_t component :
            { WEDGE_COMPONENT_DIFFUSE, WEDGE_COMPONENT_GLOSSY, WEDGE_COMPONENT_AMBIENT })
            for (const std::uint32_t sampler : { WEDGE_SAMPLER_SOBOL, WEDGE_SAMPLER_STRATIFIED }) {
                CAPTURE(component);
                CAPTURE(sampler);
                run.params.component = component;
                run.params.sampler = sampler;
                run.clear();
                run.sample(counts, 1000);
                const PathResult whole = run.result();
                run.clear();
                run.sample(16, 16);
                run.sample(counts, 20);
                run.sample(counts, 1000);
                run.sample(3, 1000); // fewer than there are: none
                const PathResult parts = run.result();
                CHECK(parts == whole);
                CHECK(*std::ranges::max_element(parts.taken.values) == 58);
                CHECK(*std::ranges::max_element(parts.value.values) > 0.01f);
            }
    });
}

TEST_CASE("with a first pass, what the first part of the samples alone would be is kept beside the mean")
{
    onEveryDevice([](const device::Device& device) {
        PathRun run(smallScene(), device, 21, 14);
        run.params.firstPass = 16;
        const auto means = [&](std::uint32_t wanted) {
            run.clear();
            run.sample(std::min(wanted, 16u), 16);
            run.sample(wanted, 30);
            run.sample(wanted, 1000);
            return run.result();
        };
        for (const auto& counts : { std::pair(40u, 20u), { 90u, 45u }, { 33u, 16u }, { 25u, 8u }, { 16u, 8u } }) {
            const std::uint32_t wanted = counts.first, part = counts.second;
            CAPTURE(wanted);
            const PathResult found = means(wanted);
            run.params.firstPass = 0;
            const Planes<float> expected = means(part).value;
            run.params.firstPass = 16;
            int differs = 0;
            run.traced.everyPixel([&](int x, int y) {
                const bool surface = expected.at(x, y) != -7.0f;
                const shared::Vec3 kept = toVec3(found.parts.vector(x, y));
                const auto rounded = [&](const Planes<float>& of) {
                    return shared::unpackColour(shared::packColour(toVec3(of.vector(x, y))));
                };
                const shared::Vec3 whole = rounded(found.value);
                const shared::Vec3 same = surface ? rounded(expected) : shared::vec3(0, 0, 0);
                REQUIRE((kept.x == same.x && kept.y == same.y && kept.z == same.z));
                for (const bool differ : { whole.x != kept.x, whole.y != kept.y, whole.z != kept.z })
                    differs += surface && differ ? 1 : 0;
            });
            CHECK(differs > 200);
        }
    });
}

TEST_CASE("light of an emitting quad converges to its form factor times the emission, however it is found")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.scene.materials.emplace_back().emission = { 2, 1, 0.5f };
        b.quad({ 0, 0, 0 }, { 0, 0, 3 }, { 3, 0, 0 });
        b.newObject();
        b.quad({ 0.2f, 0.8f, -0.3f }, { 0.7f, 0, 0 }, { 0, 0, 0.5f }, 1);
        b.camera({ 0, 0.6f, 3.0f }, { 0, 0, 0 });
        struct Way {
            std::uint32_t ways;
            float directedWithin;
        };
        for (const Way& way : { Way { WEDGE_LIGHTS_BOTH, infinity }, Way { WEDGE_LIGHTS_BOTH, 1.2f },
                 Way { WEDGE_LIGHTS_SAMPLED, infinity }, Way { WEDGE_LIGHTS_MET, 0 } }) {
            const std::uint32_t ways = way.ways;
            const float within = way.directedWithin;
            CAPTURE(ways);
            CAPTURE(within);
            PathRun run(b.scene, device, 15, 11);
            run.params.emittersLow = shared::vec3(-0.5f, 0.8f, -0.8f);
            run.params.emittersHigh = shared::vec3(0.9f, 0.8f, 0.2f);
            run.params.directedWithin = within;
            run.params.component = WEDGE_COMPONENT_EMITTERS;
            run.params.lightSampling = ways;
            run.params.emitters = run.traced.onDevice.emitterCount;
            run.params.emitterShare = run.traced.onDevice.emitterShare;
            REQUIRE(run.params.emitters == 1); // one of two triangles
            REQUIRE(run.params.emitterShare == 1);
            constexpr std::uint32_t count = 4096;
            run.sample(count, count);
            const PathResult found = run.result();
            const auto id = run.traced.counts("objectId");
            const auto position = run.traced.floats("position");
            unsigned floor = 0, directed = 0;
            double sum = 0, expected = 0, worst = 0;
            run.traced.everyPixel([&](int x, int y) {
                if (id.at(x, y) != 1)
                    return;
                const glm::dvec3 at = position.vector(x, y);
                double factor = 0;
                constexpr int steps = 150;
                for (int i = 0; i < steps; ++i)
                    for (int k = 0; k < steps; ++k) {
                        const glm::dvec3 d = glm::dvec3(0.2 + 0.7 * (2 * (i + 0.5) / steps - 1), 0.8,
                                                 -0.3 + 0.5 * (2 * (k + 0.5) / steps - 1))
                            - at;
                        const double r2 = glm::dot(d, d);
                        factor += d.y * d.y / (std::numbers::pi * r2 * r2) * (4 * 0.7 * 0.5) / (steps * steps);
                    }
                ++floor;
                sum += found.value.at(x, y);
                expected += 2 * factor;
                worst = std::max(worst, std::fabs(found.value.at(x, y) - 2 * factor));
                REQUIRE(found.value.at(x, y, 1) == doctest::Approx(0.5 * found.value.at(x, y)).epsilon(1e-4));
                REQUIRE(found.value.at(x, y, 2) == doctest::Approx(0.25 * found.value.at(x, y)).epsilon(1e-4));
                const glm::dvec3 nearest = glm::clamp(at, glm::dvec3(-0.5, 0.8, -0.8), glm::dvec3(0.9, 0.8, 0.2));
                const bool near = glm::length(at - nearest) < within;
                const unsigned directions = ways == WEDGE_LIGHTS_MET || (ways == WEDGE_LIGHTS_BOTH && near) ? 1 : 0;
                REQUIRE(found.pathRays.at(x, y) == directions * count);
                REQUIRE(found.rays.at(x, y) == (directions + (ways == WEDGE_LIGHTS_MET ? 0 : 1)) * count);
                directed += directions;
            });
            CHECK(floor > 60);
            CHECK((within != 1.2f || (directed > 20 && directed < floor - 20)));
            CHECK(expected / floor > 0.05);
            // A reflected direction brings 0 or 2: independent ones would deviate by 0.03 in the worst case, those of
            // Sobol by far less; points vary smoothly.
            CHECK(worst < (ways == WEDGE_LIGHTS_SAMPLED ? 0.001 : 0.012));
            CHECK(std::fabs(sum - expected) / floor < 1e-3);
        }
    });
}

TEST_CASE("pixels whose rays hit nothing have value and reflectors 0, those without surface or samples nothing at all")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.quad({ 0, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0 });
        b.camera({ 0, 2, 3 }, { 0, 0, 0 });
        b.scene.background = { 5, 5, 5 };
        for (const std::uint32_t component : { WEDGE_COMPONENT_DIFFUSE, WEDGE_COMPONENT_AMBIENT }) {
            PathRun run(b.scene, device, 19, 13);
            run.params.component = component;
            std::vector<std::uint32_t> wanted(run.traced.layout.size, 24);
            run.traced.everyPixel([&](int x, int y) {
                if ((x + y) % 5 == 0)
                    wanted[shared::pixelIndex(
                        static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), run.traced.layout.stride)] = 0;
            });
            run.sample(wanted, 24);
            const PathResult found = run.result();
            const auto id = run.traced.counts("objectId");
            unsigned surfaces = 0, holes = 0;
            run.traced.everyPixel([&](int x, int y) {
                const bool surface = id.at(x, y) != 0 && (x + y) % 5 != 0;
                (surface ? surfaces : holes) += 1;
                REQUIRE(found.taken.at(x, y) == (surface ? 24u : 0u));
                for (std::size_t plane = 0; plane < 3; ++plane) {
                    REQUIRE(found.value.at(x, y, plane) == (surface ? 0.0f : -7.0f));
                    REQUIRE(found.reflectors.at(x, y, plane) == 0.0f);
                }
                REQUIRE(found.pathRays.at(x, y) == (surface ? 24u : 0u));
            });
            CHECK(surfaces > 30);
            CHECK(holes > 30);
        }
    });
}

TEST_CASE("both families of traversals give the same sums")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = glossyScene();
        scene.pointLights.push_back({ { 1, 3, 2 }, { 2, 2, 2 } });
        render::Options ofWide = renderOptions(), ofScalar = ofWide;
        ofWide.traversal = render::Traversal::Wide;
        ofScalar.traversal = render::Traversal::Scalar;
        PathRun wide(scene, device, 37, 23, ofWide), scalar(scene, device, 37, 23, ofScalar);
        for (const std::uint32_t component :
            { WEDGE_COMPONENT_DIFFUSE, WEDGE_COMPONENT_GLOSSY, WEDGE_COMPONENT_AMBIENT }) {
            for (PathRun* run : { &wide, &scalar }) {
                run->params.component = component;
                run->params.bounces = 3;
                run->clear();
                run->sample(20, 20);
            }
            const PathResult a = wide.result(), b = scalar.result();
            unsigned differ = 0, lit = 0;
            wide.traced.everyPixel([&](int x, int y) {
                lit += a.sums.at(x, y) > 0 ? 1 : 0;
                bool same = a.taken.at(x, y) == b.taken.at(x, y) && a.rays.at(x, y) == b.rays.at(x, y);
                for (std::size_t plane = 0; plane < 3; ++plane)
                    same = same && a.sums.at(x, y, plane) == doctest::Approx(b.sums.at(x, y, plane)).epsilon(1e-5)
                        && a.reflectors.at(x, y, plane) == doctest::Approx(b.reflectors.at(x, y, plane)).epsilon(1e-5);
                differ += same ? 0 : 1;
            });
            CAPTURE(component);
            CHECK(differ == 0);
            CHECK(lit > 200);
        }
    });
}
