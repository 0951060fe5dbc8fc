// area_light.cl alone: slopes of the first pass, visibility of both, against closed forms and the same samples on the
// host.
#include "tests/trace_support.h"

#include <algorithm>
#include <optional>

using namespace wedge;
using namespace wedge::test;

namespace {

shared::SampleParams sampling(std::uint32_t shading, std::uint32_t sampler, std::uint32_t light = 0)
{
    return { shading, sampler, light, WEDGE_FIRST_PASS_RAYS, WEDGE_LIGHTS_SAMPLED, 0, {} };
}

/// A floor below a light at y = 4, plates at the heights given: [x0, x1] each.
struct Plate {
    float y, x0, x1;
};
scene::Scene floorAndPlates(
    const std::vector<Plate>& plates, scene::LightProfile profile = scene::LightProfile::Gaussian)
{
    SceneBuilder b;
    b.quad({ 0, 0, 0 }, { 0, 0, 20 }, { 20, 0, 0 });
    for (const Plate& p : plates) {
        b.newObject();
        b.quad({ 0.5f * (p.x0 + p.x1), p.y, 0 }, { 0, 0, 20 }, { 0.5f * (p.x1 - p.x0), 0, 0 });
    }
    b.light({ 0, 4, 0 }, { 0.5f, 0, 0 }, { 0, 0, 0.5f }, profile, 10);
    b.camera({ 0, 0.9f, 0 }, { 0, 0, 0 }, { 0, 0, -1 }, 90);
    return b.scene;
}

/// What the first `count` samples of a pixel come to, with the host's traversal.
struct HostSum {
    double weights = 0, visible = 0;
    std::uint32_t rays = 0;
};

class HostSamples {
public:
    explicit HostSamples(const TracedScene& traced)
        : traced_(traced)
        , position_(traced.floats("position"))
        , normal_(traced.floats("normal"))
        , origin_(traced.floats("origin"))
    {
    }

    HostSum operator()(const shared::SampleParams& p, int x, int y, std::uint32_t wanted) const
    {
        const shared::FrameParams& f = traced_.params;
        const shared::AreaLight& light = traced_.light(p.light);
        const std::uint32_t order = shared::hashCombine(f.seed, p.light);
        const std::uint32_t seed =
            shared::hashCombine(order, static_cast<std::uint32_t>(y) * f.width + static_cast<std::uint32_t>(x));
        HostSum sum;
        shared::LightPart part =
            shared::partAboveHorizon(light, toVec3(position_.vector(x, y)), toVec3(normal_.vector(x, y)));
        part.cut = p.shading == WEDGE_SHADING_SEPARATE ? 0 : part.cut;
        if (part.cut == 0) {
            part.first = 0;
            part.range = 1;
        }
        for (std::uint32_t k = 0; k < wanted; ++k) {
            shared::Vec2 u = shared::sobolOwen(k, seed);
            if (p.sampler == WEDGE_SAMPLER_STRATIFIED)
                u = k < p.firstPass
                    ? shared::stratified(k, p.firstPass, order, seed)
                    : shared::stratified(k - p.firstPass, wanted - p.firstPass, order, shared::hashUint(seed));
            const shared::PartSample sample = shared::samplePart(light, part, u);
            const shared::Vec3 point = shared::lightPoint(light.centre, light.halfU, light.halfV, sample.a, sample.b);
            const float g = sample.mass
                * shared::geometryTerm(toVec3(normal_.vector(x, y)),
                    shared::vecSub(point, toVec3(position_.vector(x, y))), light.normal, light.twoSided);
            if (!(g > 0))
                continue;
            const double weight = p.shading == WEDGE_SHADING_SEPARATE ? 1.0 : g;
            const shared::Vec3 origin = toVec3(origin_.vector(x, y));
            ++sum.rays;
            sum.weights += weight;
            sum.visible +=
                bvh::anyHit(traced_.hierarchy(), { origin, 0, shared::vecSub(point, origin), WEDGE_SHADOW_RAY_END })
                ? 0.0
                : weight;
        }
        return sum;
    }

private:
    const TracedScene& traced_;
    Planes<float> position_, normal_, origin_;
};

/// A light's samples in an analysed frame, pass by pass.
class LightRun {
public:
    explicit LightRun(TracedScene& traced)
        : traced_(traced)
    {
    }
    /// p.firstPass samples of each pixel, the first of their light.
    void firstPass(const shared::SampleParams& p)
    {
        Samples pass = of("first pass", p);
        pass.upTo(p.firstPass, p.firstPass);
        latest_.emplace(pass);
    }
    void secondPass(const shared::SampleParams& p, std::uint32_t wanted, std::uint32_t last)
    {
        Samples pass = of("second pass", p);
        pass.take(*latest_);
        pass.upTo(last, wanted);
        latest_.emplace(pass);
    }
    /// Of the latest pass.
    Planes<float> floats(const std::string& name) const { return latest_->pixels<float>(name); }
    Planes<std::uint32_t> counts(const std::string& name) const { return latest_->pixels<std::uint32_t>(name); }
    /// What its samples are filtered as.
    Planes<float> means(const shared::SampleParams& p) const
    {
        PassBench pass(traced_, "lightMeans");
        pass.take(*latest_);
        pass.value("params", p);
        pass.run();
        return pass.pixels<float>("value");
    }

private:
    Samples of(const char* pass, const shared::SampleParams& p) const
    {
        Samples out(traced_, "sampleShadows", pass);
        out.value("params", p);
        out.value("light", traced_.light(p.light));
        return out;
    }

    TracedScene& traced_;
    std::optional<Samples> latest_;
};

/// The means that frames have which are not analysed, of so many samples in slices.
Planes<float> plainMeans(TracedScene& plain, const shared::SampleParams& p, std::uint32_t wanted)
{
    Samples pass(plain, "sampleShadows");
    pass.value("params", p);
    pass.value("light", plain.light(p.light));
    for (const std::uint32_t last : { p.firstPass, wanted })
        pass.upTo(last, wanted);
    return pass.pixels<float>("value");
}

} // namespace

TEST_CASE("no surface and no occluder: no rays and no slopes")
{
    onEveryDevice([](const device::Device& device) {
        SceneBuilder b;
        b.light({ 0, 4, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, scene::LightProfile::Uniform, 1);
        TracedScene empty(b.scene, device, 5, 3);
        LightRun ofEmpty(empty);
        ofEmpty.firstPass(sampling(WEDGE_SHADING_RATIO, WEDGE_SAMPLER_SOBOL));
        const auto rays = ofEmpty.counts("rays"), taken = ofEmpty.counts("taken");
        empty.everyPixel([&](int x, int y) {
            REQUIRE(rays.at(x, y) == 0);
            REQUIRE(taken.at(x, y) == 0);
        });
        TracedScene open(floorAndPlates({}), device, 12, 9);
        const shared::SampleParams p = sampling(WEDGE_SHADING_SEPARATE, WEDGE_SAMPLER_SOBOL);
        LightRun run(open);
        run.firstPass(p);
        const auto slopes = run.floats("slopes"), value = run.means(p), sums = run.floats("sums");
        const auto openTaken = run.counts("taken");
        open.everyPixel([&](int x, int y) {
            REQUIRE(slopes.at(x, y) == 0.0f);
            REQUIRE(slopes.at(x, y, 1) == 0.0f);
            REQUIRE(value.at(x, y) == 1.0f);
            REQUIRE(sums.at(x, y) == 9.0f);
            REQUIRE(openTaken.at(x, y) == 9);
        });
    });
}

TEST_CASE("slopes are d1/d2 - 1 of the nearest occluder on each ray")
{
    onEveryDevice([](const device::Device& device) {
        const shared::SampleParams p = sampling(WEDGE_SHADING_RATIO, WEDGE_SAMPLER_STRATIFIED);
        // One plate over all: the same slope for each ray. With a second plate above it: still that of the lower one.
        for (const std::vector<Plate>& plates :
            { std::vector<Plate> { { 1, -20, 20 } }, { { 1, -20, 20 }, { 3, -20, 20 } } }) {
            TracedScene traced(floorAndPlates(plates), device, 24, 18);
            LightRun run(traced);
            run.firstPass(p);
            const auto slopes = run.floats("slopes"), value = run.means(p);
            traced.everyPixel([&](int x, int y) {
                REQUIRE(slopes.at(x, y) == doctest::Approx(1.0 / 3).epsilon(1e-4));
                REQUIRE(slopes.at(x, y, 1) == doctest::Approx(1.0 / 3).epsilon(1e-4));
                REQUIRE(value.at(x, y) == 0.0f);
            });
        }
        // Two plates side by side: least and largest slope where the rays part.
        scene::Scene edge = floorAndPlates({ { 1, -20, 0 }, { 2, 0, 20 } });
        edge.camera.verticalFov = 20;
        TracedScene traced(edge, device, 48, 9);
        LightRun run(traced);
        run.firstPass(p);
        const auto slopes = run.floats("slopes");
        unsigned both = 0;
        traced.everyPixel([&](int x, int y) {
            const double lo = slopes.at(x, y), hi = slopes.at(x, y, 1);
            REQUIRE((std::fabs(lo - 1.0 / 3) < 1e-4 || std::fabs(lo - 1) < 3e-4));
            REQUIRE((std::fabs(hi - 1.0 / 3) < 1e-4 || std::fabs(hi - 1) < 3e-4));
            REQUIRE(lo <= hi);
            both += hi - lo > 0.5 ? 1 : 0;
        });
        CHECK(both > 20);
    });
}

TEST_CASE("both passes see what the same samples see on the host, with each sampler and shading")
{
    onEveryDevice([](const device::Device& device) {
        TracedScene traced(smallScene(), device, 40, 30);
        TracedScene plain(smallScene(), device, 40, 30, render::monteCarlo(1));
        LightRun run(traced);
        const HostSamples host(traced);
        const auto id = traced.counts("objectId");
        for (const std::uint32_t light : { 0u, 1u })
            for (const std::uint32_t sampler : { WEDGE_SAMPLER_SOBOL, WEDGE_SAMPLER_STRATIFIED })
                for (const std::uint32_t shading :
                    { WEDGE_SHADING_SEPARATE, WEDGE_SHADING_INSIDE, WEDGE_SHADING_RATIO }) {
                    const shared::SampleParams p = sampling(shading, sampler, light);
                    run.firstPass(p);
                    // In slices, as the renderer does; the last asks for more than is wanted.
                    run.secondPass(p, 21, 14);
                    run.secondPass(p, 21, 500);
                    const auto sums = run.floats("sums"), value = run.means(p), same = plainMeans(plain, p, 21);
                    const auto taken = run.counts("taken"), rays = run.counts("rays");
                    unsigned differ = 0, partly = 0, shaded = 0;
                    traced.everyPixel([&](int x, int y) {
                        if (id.at(x, y) == 0)
                            return;
                        ++shaded;
                        const HostSum expected = host(p, x, y, 21);
                        REQUIRE(taken.at(x, y) == 21);
                        REQUIRE(rays.at(x, y) == expected.rays);
                        REQUIRE(sums.at(x, y) == doctest::Approx(expected.weights).epsilon(1e-4));
                        REQUIRE(same.at(x, y) == value.at(x, y));
                        partly += expected.rays < 21 && expected.rays > 0 ? 1 : 0;
                        // A logarithm of another library may move a sample across an edge.
                        if (std::fabs(sums.at(x, y, 1) - expected.visible) > 1e-4 * expected.weights) {
                            ++differ;
                            return;
                        }
                        // Divided by the whole number of samples taken, or by the weights of those above the horizon.
                        double mean = shading == WEDGE_SHADING_INSIDE ? expected.visible / 21 : 0;
                        if (shading != WEDGE_SHADING_INSIDE && expected.weights > 0)
                            mean = expected.visible / expected.weights;
                        REQUIRE(value.at(x, y) == doctest::Approx(mean).epsilon(1e-4));
                    });
                    CHECK(differ <= shaded / 200);
                    // As published, samples below the horizon are void; else there are none.
                    CHECK((partly > 0) == (shading == WEDGE_SHADING_SEPARATE));
                }
    });
}

TEST_CASE("slices of any length give the same bits, and pixels that want no more keep what they have")
{
    onEveryDevice([](const device::Device& device) {
        TracedScene traced(smallScene(), device, 33, 21);
        LightRun run(traced);
        const shared::SampleParams p = sampling(WEDGE_SHADING_RATIO, WEDGE_SAMPLER_SOBOL);
        std::vector<std::vector<float>> results;
        for (const std::vector<std::uint32_t>& slices :
            { std::vector<std::uint32_t> { 40 }, { 10, 11, 37, 40 }, { 9, 9, 40, 40 } }) {
            run.firstPass(p);
            for (const std::uint32_t last : slices)
                run.secondPass(p, 40, last);
            results.push_back(run.floats("sums").values);
        }
        CHECK(results[1] == results[0]);
        CHECK(results[2] == results[0]);
        run.firstPass(p);
        const std::vector<float> before = run.floats("sums").values;
        run.secondPass(p, 9, 400);
        CHECK(run.floats("sums").values == before);
    });
}

TEST_CASE("what the first part of the samples alone would be is kept beside the mean")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool glossy : { false, true }) {
            TracedScene traced(glossy ? glossyScene() : smallScene(), device, 33, 21);
            LightRun run(traced);
            const auto id = traced.counts("objectId");
            shared::SampleParams p = sampling(WEDGE_SHADING_RATIO, WEDGE_SAMPLER_SOBOL);
            const auto values = [&](std::uint32_t wanted) {
                p.firstPass = std::min(wanted, 9u);
                run.firstPass(p);
                p.firstPass = 9;
                run.secondPass(p, wanted, 23);
                run.secondPass(p, wanted, 1000);
                return std::pair(run.means(p), run.floats("parts"));
            };
            const std::size_t channels = glossy ? 2 : 1;
            for (const auto& counts : { std::pair(40u, 20u), { 70u, 35u }, { 18u, 9u }, { 12u, 4u }, { 9u, 4u } }) {
                const std::uint32_t wanted = counts.first, part = counts.second;
                CAPTURE(wanted);
                const auto [found, parts] = values(wanted);
                const Planes<float> expected = values(part).first;
                int differs = 0;
                for (int y = 0; y < 21; ++y)
                    for (int x = 0; x < 33; ++x)
                        for (std::size_t c = 0; id.at(x, y) != 0 && c < channels; ++c) {
                            const auto rounded = [](float v) { return shared::unpackShort(shared::packShort(v)); };
                            REQUIRE(parts.at(x, y, c) == rounded(expected.at(x, y, c)));
                            differs += rounded(found.at(x, y, c)) != parts.at(x, y, c) ? 1 : 0;
                        }
                CHECK(differs > 20);
            }
        }
    });
}

TEST_CASE("with gloss the specular sums hold the lobe's weights of the same samples")
{
    onEveryDevice([](const device::Device& device) {
        TracedScene traced(glossyScene(), device, 30, 22);
        LightRun run(traced);
        const auto id = traced.counts("objectId");
        for (const std::uint32_t shading : { WEDGE_SHADING_SEPARATE, WEDGE_SHADING_INSIDE, WEDGE_SHADING_RATIO }) {
            const shared::SampleParams p = sampling(shading, WEDGE_SAMPLER_SOBOL);
            run.firstPass(p);
            const auto sums = run.floats("sums"), value = run.means(p);
            traced.everyPixel([&](int x, int y) {
                if (id.at(x, y) == 0)
                    return;
                REQUIRE(sums.at(x, y, 3) <= sums.at(x, y, 2));
                // Where every ray is free, or none, both terms agree on it.
                if (sums.at(x, y, 1) == sums.at(x, y))
                    REQUIRE(sums.at(x, y, 3) == sums.at(x, y, 2));
                if (sums.at(x, y, 1) == 0.0f)
                    REQUIRE(sums.at(x, y, 3) == 0.0f);
                if (shading == WEDGE_SHADING_SEPARATE)
                    REQUIRE(value.at(x, y, 1) == value.at(x, y));
            });
        }
    });
}

TEST_CASE("lobes narrower than the light are sampled, too: the same mean of what arrives, with far less noise")
{
    onEveryDevice([](const device::Device& device) {
        TracedScene traced(glossyScene(2000), device, 30, 22);
        LightRun run(traced);
        const auto id = traced.counts("objectId");
        // Points on the light alone, whose mean is the integral, too.
        const auto means = [&](std::uint32_t shading, std::uint32_t count) {
            run.firstPass(sampling(shading, WEDGE_SAMPLER_SOBOL));
            run.secondPass(sampling(shading, WEDGE_SAMPLER_SOBOL), count, count);
            Planes<float> sums = run.floats("sums");
            for (float& v : sums.values)
                v /= static_cast<float>(count);
            return sums;
        };
        const Planes<float> truth = means(WEDGE_SHADING_RATIO, 16384);
        const auto errors = [&](const Planes<float>& found, std::size_t plane) {
            double squared = 0, sum = 0, of = 0;
            traced.everyPixel([&](int x, int y) {
                if (id.at(x, y) == 0)
                    return;
                squared += std::pow(found.at(x, y, plane) - truth.at(x, y, plane), 2);
                sum += found.at(x, y, plane);
                of += truth.at(x, y, plane);
            });
            return std::pair(std::sqrt(squared), sum / of);
        };
        const Planes<float> both = means(WEDGE_SHADING_RATIO, 64), points = means(WEDGE_SHADING_INSIDE, 64),
                            many = means(WEDGE_SHADING_INSIDE, 16384);
        for (const std::size_t plane : { 2u, 3u }) {
            CAPTURE(plane);
            MESSAGE("error of 64 samples " << errors(both, plane).first << ", of points alone "
                                           << errors(points, plane).first << "; means " << errors(both, plane).second
                                           << ", of many points " << errors(many, plane).second);
            CHECK(errors(both, plane).first < 0.3 * errors(points, plane).first);
            CHECK(std::fabs(errors(both, plane).second - 1) < 0.05);
            CHECK(std::fabs(errors(many, plane).second - 1) < 0.05);
        }
        // As published each point that sees the light counts one, and directions have no part in it.
        const Planes<float> separate = means(WEDGE_SHADING_SEPARATE, 64);
        traced.everyPixel([&](int x, int y) { REQUIRE(separate.at(x, y, 2) == separate.at(x, y)); });
        // The diffuse sums know nothing of it.
        CHECK(errors(both, 0).second == doctest::Approx(errors(points, 0).second).epsilon(1e-6));
    });
}
