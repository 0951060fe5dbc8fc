// Sinks: the kernels that sample, with a sink of this test's own beside the renderer's and in their place, over pixels
// and over receivers of a wave.
#include "host/graph/interface.h"
#include "host/render/kernel_types.h"
#include "host/render/sinks.h"
#include "kernels/shared/path.h"
#include "tests/stored_samples_support.h"
#include "tests/trace_support.h"

#include <set>
#include <stdexcept>

using namespace wedge;
using namespace wedge::test;
namespace sinks = wedge::render::sinks;

namespace {

constexpr std::uint32_t room = 40; ///< stored samples of a receiver
constexpr std::uint32_t sumPlanes = 4, storedPlanes = 3 + sumPlanes;

/// Each sample by itself, tests/kernels/sinks/stored.h.
graph::Sink stored()
{
    return { .file = "sinks/stored.h",
        .name = "Stored",
        .begin = { "storedCounts" },
        .take = { "room", "stored" },
        .finish = { "storedCounts" } };
}

/// The same of points on lights alone.
graph::Sink storedPoints()
{
    graph::Sink out = stored();
    out.file = "sinks/stored_points.h";
    return out;
}

/// Points that are sampled, and which samples each is to take.
struct Points {
    shared::FrameParams frame;
    std::vector<float> position, normal, origin, specular;
    std::vector<std::uint32_t> geometric, objectId, gloss, pixelOf, view;
    std::vector<std::uint32_t> first, wanted;

    std::size_t size() const { return frame.planeSize; }
    shared::Vec3 at(const std::vector<float>& planes, std::size_t i) const
    {
        return shared::vec3(planes[i], planes[size() + i], planes[2 * size() + i]);
    }
};

/// All pixels, each with the same samples.
Points pixelPoints(const TracedScene& traced, std::uint32_t wanted)
{
    const auto floats = [&](const char* name) { return traced.found.read<float>(name); };
    const auto counts = [&](const char* name) { return traced.found.read<std::uint32_t>(name); };
    const std::vector<std::uint32_t> none(traced.layout.size), all(traced.layout.size, wanted);
    return { traced.params, floats("position"), floats("normal"), floats("origin"), floats("specular"),
        counts("geometric"), counts("objectId"), counts("gloss"), none, none, none, all };
}

/// Receivers of a wave in lists of that size, any number to a pixel, each with samples of its own or none.
Points wavePoints(const Points& pixels, const render::PlaneLayout& layout, std::size_t size)
{
    constexpr std::uint32_t count = 777;
    REQUIRE(size > count);
    std::mt19937 random(3);
    Points out { pixels.frame, std::vector<float>(3 * size), std::vector<float>(3 * size), std::vector<float>(3 * size),
        std::vector<float>(3 * size), std::vector<std::uint32_t>(size), std::vector<std::uint32_t>(size),
        std::vector<std::uint32_t>(size), std::vector<std::uint32_t>(size), std::vector<std::uint32_t>(size),
        std::vector<std::uint32_t>(size), std::vector<std::uint32_t>(size) };
    out.frame.receivers = count;
    out.frame.planeSize = static_cast<std::uint32_t>(size);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t x = static_cast<std::uint32_t>(random()) % layout.width;
        const std::uint32_t y = static_cast<std::uint32_t>(random()) % layout.height;
        const std::size_t pixel = shared::pixelIndex(x, y, layout.stride);
        for (std::size_t k = 0; k < 3; ++k) {
            out.position[k * size + i] = pixels.position[k * pixels.size() + pixel];
            out.normal[k * size + i] = pixels.normal[k * pixels.size() + pixel];
            out.origin[k * size + i] = pixels.origin[k * pixels.size() + pixel];
            out.specular[k * size + i] = pixels.specular[k * pixels.size() + pixel];
        }
        out.geometric[i] = pixels.geometric[pixel];
        out.objectId[i] = pixels.objectId[pixel];
        out.gloss[i] = pixels.gloss[pixel];
        out.pixelOf[i] = x | y << 16;
        out.view[i] =
            shared::packDirection(shared::vecNormalize(shared::vecSub(pixels.frame.eye, out.at(out.position, i))));
        out.first[i] = static_cast<std::uint32_t>(random()) % 5;
        out.wanted[i] = out.first[i] + static_cast<std::uint32_t>(random()) % 13;
    }
    return out;
}

/// What a run leaves behind; of sinks that there are not, nothing.
struct Result {
    std::vector<float> sums, stored;
    std::vector<std::uint32_t> counts, taken;
};

/// Kernels that sample, of frames whose pixels are the receivers and of frames in waves, with any sinks.
class Sampler {
public:
    explicit Sampler(const device::Device& device)
        : pixels(glossyScene(), device, 31, 23, settingsOf(false), withOwnSinks())
        , waves(device, glossyScene(), sized(settingsOf(true), 31, 23), false, withOwnSinks())
    {
    }
    Points ofWave(const Points& points)
    {
        return wavePoints(points, pixels.layout, PassBench(waves, "samplePaths").elements("position"));
    }

    /// Points on a light, in two launches.
    Result lights(const Points& points, const shared::SampleParams& params, const shared::AreaLight& light,
        const std::vector<graph::Sink>& becoming)
    {
        PassBench pass(frameOf(points), "sampleShadows");
        pass.value("params", params);
        pass.value("light", light);
        return run(pass, points, becoming);
    }
    Result paths(const Points& points, const shared::PathParams& params, const std::vector<graph::Sink>& becoming)
    {
        PassBench pass(frameOf(points), "samplePaths");
        pass.value("params", params);
        pass.plane("specular", points.specular);
        return run(pass, points, becoming);
    }

    /// Paths of pixels, as samples of a band that has the whole image.
    PassBench bandOfPaths(const Points& points, const shared::PathParams& params, float exposure, Space space)
    {
        PassBench pass(pixels, "samplePaths");
        pass.value("params", params);
        pass.plane("specular", points.specular);
        pass.sinks({ { .file = "sinks/band_samples.h",
                       .name = "BandSamples",
                       .begin = { "slots", "exposure", "ranges" },
                       .take = { "slots", "perPixel", "radiance", "colours" },
                       .finish = { "slots", "ranges" },
                       .defines = space == Space::Rgb ? device::Defines { { "WEDGE_RGB_SAMPLES", "1" } }
                                                      : device::Defines() } },
            { graph::value("slots", points.frame.planeSize), graph::value("perPixel", room) },
            { { "exposure", graph::floats, 1 }, { "ranges", graph::floats, 2 * points.size() },
                { "radiance", graph::floats, 3 * room * points.size() },
                { "colours", render::shortCounts, 3 * room * points.size() } });
        pass.plane("exposure", std::vector<float> { exposure });
        launch(pass, points);
        return pass;
    }

    TracedScene pixels;
    DeclaredFrame waves;

private:
    static render::Settings settingsOf(bool ofWaves)
    {
        render::Settings settings = render::monteCarlo(1);
        settings.bounces = 1;
        settings.antialias = ofWaves;
        return settings;
    }
    static render::Options withOwnSinks()
    {
        render::Options options;
        options.kernelDir = WEDGE_TEST_KERNELS;
        return options;
    }
    DeclaredFrame& frameOf(const Points& points) { return points.frame.receivers > 0 ? waves : pixels; }

    static Result run(PassBench& pass, const Points& points, const std::vector<graph::Sink>& becoming)
    {
        const std::size_t size = points.size();
        pass.sinks(becoming, { graph::value("room", room) },
            { { "stored", graph::floats, room * storedPlanes * size }, { "storedCounts", graph::counts, size },
                { "sums", graph::floats, sumPlanes * size } });
        launch(pass, points);
        const auto floats = [&](const char* name) {
            return pass.has(name) ? pass.read<float>(name) : std::vector<float>();
        };
        return { floats("sums"), floats("stored"),
            pass.has("storedCounts") ? pass.read<std::uint32_t>("storedCounts") : std::vector<std::uint32_t>(),
            pass.read<std::uint32_t>("taken") };
    }

    /// In two launches.
    static void launch(PassBench& pass, const Points& points)
    {
        pass.value("frame", points.frame);
        pass.plane("position", points.position);
        pass.plane("normal", points.normal);
        pass.plane("origin", points.origin);
        pass.plane("geometric", points.geometric);
        pass.plane("objectId", points.objectId);
        pass.plane("gloss", points.gloss);
        pass.plane("wanted", points.wanted);
        pass.plane("taken", points.first);
        if (points.frame.receivers > 0) {
            pass.plane("pixelOf", points.pixelOf);
            pass.plane("view", points.view);
            pass.items((points.frame.receivers + WEDGE_TILE_PIXELS - 1) / WEDGE_TILE_PIXELS);
        }
        for (const std::uint32_t last : { 6u, 1000u }) {
            pass.value("lastSample", last);
            pass.run();
        }
    }
};

/// Checks that each sink gets the same samples, alone or beside another, and calls visit(i, direction, values) for each
/// stored one. sample(sinks): runs the kernel.
template <class Sample, class Visit>
void checkSinks(const Points& points, const Sample& sample, const Visit& visit)
{
    const Result sums = sample({ sinks::sums() }), apart = sample({ stored() }),
                 both = sample({ stored(), sinks::sums() });
    CHECK(both.sums == sums.sums);
    CHECK(both.stored == apart.stored);
    CHECK(both.counts == apart.counts);
    CHECK(both.taken == sums.taken);
    CHECK(both.taken == apart.taken);
    unsigned receivers = 0, different = 0;
    double total = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::uint32_t count = apart.counts[i];
        REQUIRE(count == apart.taken[i] - points.first[i]);
        if (count == 0)
            continue;
        ++receivers;
        double expected[sumPlanes] = {}, size[sumPlanes] = {};
        std::set<float> seen;
        for (std::uint32_t slot = 0; slot < count; ++slot) {
            const float* at = &apart.stored[std::size_t { slot } * storedPlanes * points.size() + i];
            float values[sumPlanes];
            for (std::size_t k = 0; k < sumPlanes; ++k) {
                values[k] = at[(3 + k) * points.size()];
                expected[k] += values[k];
                size[k] += std::fabs(values[k]);
            }
            visit(i, shared::vec3(at[0], at[points.size()], at[2 * points.size()]), values);
            seen.insert(at[0]);
        }
        different += seen.size() + 1 >= count ? 1 : 0;
        for (std::size_t k = 0; k < sumPlanes; ++k) {
            REQUIRE(std::fabs(sums.sums[k * points.size() + i] - expected[k]) <= 1e-6 * size[k]);
            total += size[k];
        }
    }
    CHECK(receivers > 300);
    CHECK(different > 0.9 * receivers);
    CHECK(total > 1);
}

/// Checks that samples of receivers that want `room` each are, to the bit, those of receivers that want fewer, any
/// number in each lane of a packet; and that these add up in their order. sample(points): runs the kernel.
template <class Sample>
void checkIndependence(const Points& pixels, const Sample& sample)
{
    const Result all = sample(pixels);
    std::mt19937 random(11);
    // Few different ones, all different ones, and a few that want far more than the others.
    for (const std::uint32_t kind : { 0u, 1u, 2u }) {
        Points some = pixels;
        for (std::uint32_t& wanted : some.wanted) {
            const std::uint32_t number = static_cast<std::uint32_t>(random());
            wanted = kind == 0 ? 9 + number % 3 : kind == 1 ? number % (room + 1) : number % 8 == 0 ? room : 7;
        }
        const Result result = sample(some);
        std::size_t receivers = 0, differ = 0;
        for (std::size_t i = 0; i < some.size(); ++i) {
            if (some.objectId[i] == 0)
                continue;
            ++receivers;
            REQUIRE(result.taken[i] == some.wanted[i]);
            REQUIRE(result.counts[i] == some.wanted[i]);
            float sums[sumPlanes] = {};
            for (std::size_t slot = 0; slot < some.wanted[i]; ++slot)
                for (std::size_t k = 0; k < storedPlanes; ++k) {
                    const std::size_t at = (slot * storedPlanes + k) * some.size() + i;
                    differ += result.stored[at] == all.stored[at] ? 0 : 1;
                    if (k >= 3)
                        sums[k - 3] += result.stored[at];
                }
            for (std::size_t k = 0; k < sumPlanes; ++k)
                differ += result.sums[k * some.size() + i] == sums[k] ? 0 : 1;
        }
        CHECK(receivers > 300);
        CHECK(differ == 0);
    }
}

} // namespace

TEST_CASE("points on lights: a sink that stores each sample gets what the sums are made of")
{
    onEveryDevice([](const device::Device& device) {
        Sampler sampler(device);
        const Points pixels = pixelPoints(sampler.pixels, 12), wave = sampler.ofWave(pixels);
        for (const Points* points : { &pixels, &wave })
            // Points alone, or with directions of both parts: the light is made so large that these are as dense.
            for (const std::uint32_t finding : { WEDGE_LIGHTS_SAMPLED, WEDGE_LIGHTS_BOTH }) {
                const shared::SampleParams params { WEDGE_SHADING_INSIDE, WEDGE_SAMPLER_SOBOL, 1, 0, finding, 0, {} };
                shared::AreaLight light = sampler.pixels.light(1);
                const float scale = finding == WEDGE_LIGHTS_BOTH ? 20.0f : 1.0f;
                light.halfU = shared::vecScale(light.halfU, scale);
                light.halfV = shared::vecScale(light.halfV, scale);
                light.profileArea *= scale * scale;
                unsigned onLight = 0;
                checkSinks(
                    *points,
                    [&](const std::vector<graph::Sink>& becoming) {
                        return sampler.lights(*points, params, light, becoming);
                    },
                    [&](std::size_t i, shared::Vec3 ray, const float* values) {
                        REQUIRE(values[1] >= 0);
                        if (!(values[0] > 0))
                            return;
                        const shared::Vec3 at =
                            shared::vecSub(shared::vecAdd(points->at(points->origin, i), ray), light.centre);
                        REQUIRE(std::fabs(shared::vecDot(at, light.normal)) < 1e-5);
                        for (const shared::Vec3& half : { light.halfU, light.halfV })
                            REQUIRE(std::fabs(shared::vecDot(at, half)) <= 1.0001 * shared::vecDot(half, half));
                        // Of points alone either all arrives or nothing; directions add what they meet.
                        REQUIRE((values[1] == 0 || values[1] == values[0]
                            || (finding == WEDGE_LIGHTS_BOTH && std::isfinite(values[1]))));
                        ++onLight;
                    });
                CHECK(onLight > 1000);
                // Sinks that go by where points are get what these bring, without what directions met elsewhere.
                const Result all = sampler.lights(*points, params, light, { stored() }),
                             alone = sampler.lights(*points, params, light, { storedPoints() });
                REQUIRE(alone.counts == all.counts);
                std::size_t differ = 0, partly = 0, some = 0;
                for (std::size_t i = 0; i < points->size(); ++i)
                    for (std::size_t slot = 0; slot < all.counts[i]; ++slot)
                        for (const std::size_t part : { 0u, 2u }) {
                            const auto number = [&](const Result& of, std::size_t k) {
                                return of.stored[(slot * storedPlanes + 3 + part + k) * points->size() + i];
                            };
                            const float there = number(alone, 0), seen = number(alone, 1);
                            some += there > 0 ? 1 : 0;
                            partly += seen != 0 && seen != there ? 1 : 0;
                            differ += there != number(all, 0) || seen != number(all, 1) ? 1 : 0;
                        }
                CHECK(some > 1000);
                CHECK(partly == 0);
                CHECK((differ > 100) == (finding == WEDGE_LIGHTS_BOTH));
            }
    });
}

TEST_CASE("paths: a sink that stores each sample gets what the sums are made of")
{
    onEveryDevice([](const device::Device& device) {
        Sampler sampler(device);
        const Points pixels = pixelPoints(sampler.pixels, 12), wave = sampler.ofWave(pixels);
        shared::PathParams params {};
        params.bounces = 2;
        params.areaLights = static_cast<std::uint32_t>(sampler.pixels.onDevice.areaLightList.size());
        params.sceneDiameter = sampler.pixels.onDevice.diameter;
        params.ambientDistance = std::numeric_limits<float>::infinity();
        for (const Points* points : { &pixels, &wave })
            for (const std::uint32_t component : { WEDGE_COMPONENT_DIFFUSE, WEDGE_COMPONENT_GLOSSY }) {
                params.component = component;
                checkSinks(
                    *points,
                    [&](const std::vector<graph::Sink>& becoming) { return sampler.paths(*points, params, becoming); },
                    [&](std::size_t i, shared::Vec3 ray, const float* values) {
                        REQUIRE(shared::vecLength(ray) == doctest::Approx(1).epsilon(1e-5));
                        // Nothing comes from below the horizon.
                        if (values[3] > 0)
                            REQUIRE(shared::vecDot(points->at(points->normal, i), ray) > 0);
                    });
            }
    });
}

TEST_CASE("samples and sums of a receiver do not depend on what others of its packet want")
{
    onEveryDevice([](const device::Device& device) {
        Sampler sampler(device);
        const Points pixels = pixelPoints(sampler.pixels, room);
        for (const std::uint32_t finding : { WEDGE_LIGHTS_SAMPLED, WEDGE_LIGHTS_BOTH }) {
            const shared::SampleParams params { WEDGE_SHADING_INSIDE, WEDGE_SAMPLER_SOBOL, 1, 0, finding, 0, {} };
            shared::AreaLight light = sampler.pixels.light(1);
            const float scale = finding == WEDGE_LIGHTS_BOTH ? 20.0f : 1.0f;
            light.halfU = shared::vecScale(light.halfU, scale);
            light.halfV = shared::vecScale(light.halfV, scale);
            light.profileArea *= scale * scale;
            checkIndependence(pixels, [&](const Points& points) {
                return sampler.lights(points, params, light, { stored(), sinks::sums() });
            });
        }
        shared::PathParams params {};
        params.bounces = 2;
        params.areaLights = static_cast<std::uint32_t>(sampler.pixels.onDevice.areaLightList.size());
        params.sceneDiameter = sampler.pixels.onDevice.diameter;
        params.component = WEDGE_COMPONENT_DIFFUSE;
        checkIndependence(pixels, [&](const Points& points) {
            return sampler.paths(points, params, { stored(), sinks::sums() });
        });
    });
}

namespace {

/// sinkText() of a pass with these planes.
std::string textOf(const std::vector<graph::Sink>& sinks, const std::vector<std::string>& planes)
{
    graph::Graph graph(1, 1, 1);
    graph::Pass pass { .name = "samples", .kernel = { "light/area_light.cl", "sampleShadows", sinks } };
    for (const std::string& name : planes) {
        auto plane = graph.plane<render::Sums>(name, graph::floats);
        pass.arguments.push_back(graph::updates(name, plane));
    }
    return graph::sinkText(graph, pass);
}

} // namespace

namespace {

/// Checks a pixel's stored colours to be its samples' in 16 bits, and their range to be exact.
void checkBand(const std::vector<float>& radiance, const std::vector<std::uint32_t>& colours,
    const std::vector<float>& ranges, std::size_t pixel, std::uint32_t count, double exposure, Space space)
{
    double low = 1e30, high = -1e30;
    for (std::size_t j = 0; j < count; ++j) {
        glm::dvec3 sample, found;
        for (int channel = 0; channel < 3; ++channel) {
            const std::size_t at = (3 * pixel + static_cast<std::size_t>(channel)) * room + j;
            sample[channel] = radiance[at];
            found[channel] = shared::unpackShort(colours[at]);
        }
        const glm::dvec3 expected = colourOracle(exposure * sample, space);
        CAPTURE(pixel);
        CAPTURE(j);
        for (int channel = 0; channel < 3; ++channel) {
            CAPTURE(channel);
            CAPTURE(expected[channel]);
            CAPTURE(found[channel]);
            REQUIRE(std::fabs(found[channel] - expected[channel]) <= std::fabs(expected[channel]) / 250 + 1e-4);
        }
        low = std::min(low, found.x);
        high = std::max(high, found.x);
    }
    REQUIRE(ranges[2 * pixel] == low);
    REQUIRE(ranges[2 * pixel + 1] == high);
}

} // namespace

TEST_CASE("paths: a band of samples has their colours as CIELAB or as RGB, by which white is as far from black")
{
    CHECK(glm::length(colourOracle({ 1, 1, 1 }, Space::Rgb)) == doctest::Approx(5));
    CHECK(glm::length(colourOracle({ 1, 1, 1 }, Space::Lab)) == doctest::Approx(5).epsilon(1e-4));
    onEveryDevice([](const device::Device& device) {
        Sampler sampler(device);
        const Points points = pixelPoints(sampler.pixels, 12);
        shared::PathParams params {};
        params.bounces = 2;
        params.areaLights = static_cast<std::uint32_t>(sampler.pixels.onDevice.areaLightList.size());
        params.sceneDiameter = sampler.pixels.onDevice.diameter;
        params.component = WEDGE_COMPONENT_DIFFUSE;
        for (const Space space : { Space::Lab, Space::Rgb })
            for (const float exposure : { 1.0f, 8.0f }) {
                const PassBench band = sampler.bandOfPaths(points, params, exposure, space);
                const auto radiance = band.read<float>("radiance"), ranges = band.read<float>("ranges");
                const auto colours = band.read<std::uint32_t>("colours"), taken = band.read<std::uint32_t>("taken");
                unsigned pixels = 0;
                for (std::size_t i = 0; i < points.size(); ++i) {
                    if (taken[i] > 0)
                        checkBand(radiance, colours, ranges, i, taken[i], exposure, space);
                    pixels += taken[i] > 0 ? 1 : 0;
                }
                CHECK(pixels > 300);
            }
    });
}

TEST_CASE("what sinks are handed are the pass's last arguments")
{
    CHECK_THROWS_WITH_AS(textOf({ sinks::sums(), sinks::means() }, { "sums" }),
        "pass \"samples\" hands sinks \"value\", which is not among its last arguments", std::logic_error);
    CHECK_THROWS_WITH_AS(textOf({ sinks::sums() }, { "sums", "taken" }),
        "pass \"samples\" hands sinks \"sums\", which is not among its last arguments", std::logic_error);
}
