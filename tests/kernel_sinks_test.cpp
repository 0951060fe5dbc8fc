// Sinks: the kernels that sample, with a sink of this test's own beside the renderer's and in their place, over pixels
// and over receivers of a wave.
#include "host/graph/execution.h"
#include "kernels/shared/path.h"
#include "tests/trace_support.h"

#include <regex>
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

scene::Scene glossyScene()
{
    scene::Scene scene = smallScene();
    scene.materials[0].specular = glm::vec3(0.3f);
    scene.materials[0].exponent = 20;
    return scene;
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
Points pixelPoints(TracedScene& traced, std::uint32_t wanted)
{
    KernelBench& b = traced.bench;
    const SurfaceBuffers& f = traced.frame;
    const std::size_t size = traced.layout.size;
    return { traced.params, b.read(f.position), b.read(f.normal), b.read(f.origin), b.read(f.specular),
        b.read(f.geometric), b.read(f.objectId), b.read(f.gloss), std::vector<std::uint32_t>(size),
        std::vector<std::uint32_t>(size), std::vector<std::uint32_t>(size), std::vector<std::uint32_t>(size, wanted) };
}

/// Receivers of a wave, any number to a pixel, each with samples of its own or none.
Points wavePoints(const Points& pixels, const render::PlaneLayout& layout)
{
    constexpr std::uint32_t count = 777, size = count + 5;
    std::mt19937 random(3);
    Points out { pixels.frame, std::vector<float>(3 * size), std::vector<float>(3 * size), std::vector<float>(3 * size),
        std::vector<float>(3 * size), std::vector<std::uint32_t>(size), std::vector<std::uint32_t>(size),
        std::vector<std::uint32_t>(size), std::vector<std::uint32_t>(size), std::vector<std::uint32_t>(size),
        std::vector<std::uint32_t>(size), std::vector<std::uint32_t>(size) };
    out.frame.receivers = count;
    out.frame.planeSize = size;
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

struct Listed { };

/// What a run leaves behind; of sinks that there are not, zeros.
struct Result {
    std::vector<float> sums, stored;
    std::vector<std::uint32_t> counts, taken;
};

/// Kernels that sample, run by graphs that declare what becomes of the samples.
class Sampler {
public:
    explicit Sampler(TracedScene& traced)
        : traced_(traced)
        , library_(traced.bench.device, { { { "WEDGE_SPECULAR", "1" } }, false, WEDGE_TEST_KERNELS })
        , kernels_(library_)
        , memory_(traced.bench.device)
    {
    }

    /// Points on a light, in two launches.
    Result lights(const Points& points, const shared::SampleParams& params, const shared::AreaLight& light,
        const std::vector<graph::Sink>& becoming)
    {
        return run({ "light/area_light.cl", "sampleShadows", becoming },
            { graph::value("frame", points.frame), graph::value("params", params), graph::value("light", light) }, {},
            false, points);
    }
    Result paths(const Points& points, const shared::PathParams& params, const std::vector<graph::Sink>& becoming)
    {
        const render::DeviceScene& s = traced_.onDevice;
        std::vector<graph::Argument> surfaces;
        std::apply([&](const auto&... buffer) { (surfaces.push_back(graph::outside("", "", buffer.cl())), ...); },
            surfaceArguments(s));
        surfaces.push_back(graph::outside("", "", s.areaLights.cl()));
        surfaces.push_back(graph::outside("", "", s.deltaLights.cl()));
        surfaces.push_back(graph::outside("", "", s.emitters.cl()));
        surfaces.push_back(graph::outside("", "", s.emitterPicks.cl()));
        surfaces.push_back(graph::outside("", "", s.environment.cl()));
        surfaces.push_back(graph::outside("", "", s.environmentTable.cl()));
        return run({ "paths/indirect.cl", "samplePaths", becoming },
            { graph::value("frame", points.frame), graph::value("params", params) }, surfaces, true, points);
    }

private:
    Result run(const graph::KernelName& kernel, const std::vector<graph::Argument>& params,
        const std::vector<graph::Argument>& surfaces, bool ofPaths, const Points& points)
    {
        KernelBench& b = traced_.bench;
        const std::size_t size = points.size();
        graph::Graph graph(1, 1, 1);
        auto taken = graph.list<Listed>("taken", graph::counts, size);
        auto rays = graph.list<Listed>("rays", graph::counts, size);
        auto pathRays = graph.list<Listed>("path rays", graph::counts, size);
        auto counts = graph.list<Listed>("counts", graph::counts, size);
        auto sums = graph.list<Listed>("sums", graph::floats, sumPlanes * size);
        auto samples = graph.list<Listed>("samples", graph::floats, room * storedPlanes * size);
        for (graph::Handle<Listed>* list : { &rays, &pathRays, &counts, &sums, &samples })
            fill(graph, *list, {});
        fill(graph, taken, points.first);
        const auto outside = [&](const auto& values) { return graph::outside("", "", b.buffer(values).cl()); };
        // Of waves, and of pixels that do not look at them.
        const auto ofWave = [&](const char* name, const graph::Format& format, const auto& values) {
            return graph::reads(name, graph.imported<Listed>(name, format, b.buffer(values).cl(), size));
        };
        std::vector<graph::Argument> own = params;
        own.push_back(graph::outside("", "", traced_.onDevice.nodes.cl()));
        own.push_back(graph::outside("", "", traced_.onDevice.blocks.cl()));
        own.insert(own.end(), surfaces.begin(), surfaces.end());
        own.insert(own.end(),
            { outside(points.position), outside(points.normal), outside(points.origin), outside(points.geometric),
                outside(points.objectId), outside(points.gloss) });
        if (ofPaths)
            own.push_back(outside(points.specular));
        own.push_back(outside(points.wanted));
        nameAs(kernel, own);
        own.insert(own.end(),
            { ofWave("pixelOf", graph::counts, points.pixelOf), ofWave("view", graph::counts, points.view),
                ofWave("time", graph::floats, std::vector<float>(size, 0.0f)) });
        if (ofPaths)
            own.push_back(graph::absent("environmentSamples"));
        for (const std::uint32_t last : { 6u, 1000u }) {
            std::vector<graph::Argument> all = own;
            all.insert(all.end(),
                { graph::value("lastSample", last), graph::updates("taken", taken), graph::updates("rays", rays) });
            if (ofPaths)
                all.push_back(graph::updates("pathRays", pathRays));
            for (const graph::Sink& sink : kernel.sinks) {
                if (sink.name == "Sums")
                    all.push_back(graph::updates("sums", sums));
                else
                    all.insert(all.end(),
                        { graph::value("room", room), graph::updates("stored", samples),
                            graph::updates("storedCounts", counts) });
            }
            const std::size_t tiles = points.frame.receivers == 0
                ? points.frame.tileCount
                : (points.frame.receivers + WEDGE_TILE_PIXELS - 1) / WEDGE_TILE_PIXELS;
            graph.add({ .name = "samples",
                .kernel = kernel,
                .arguments = all,
                .domain = graph::Domain::Tiles,
                .count = [tiles](const graph::Launch&) { return tiles; },
                .itemsOfTile = WEDGE_TILE_PIXELS / render::packetSize(render::Traversal::Wide) });
        }
        for (const graph::Handle<Listed>* list : { &taken, &sums, &samples, &counts })
            graph.want(*list, graph.image());
        const graph::Plan plan(graph, device::partAlignment, graph::slabRulesOf(b.device.info()));
        graph::Execution execution(plan, memory_, kernels_, b.queue);
        REQUIRE(execution.run());
        const auto floats = [&](const graph::Version& list) {
            return execution.output<float>(list).downloadAll(b.queue);
        };
        const auto numbers = [&](const graph::Version& list) {
            return execution.output<std::uint32_t>(list).downloadAll(b.queue);
        };
        return { floats(sums), floats(samples), numbers(counts), numbers(taken) };
    }

    /// Gives arguments the names and types that they have in the product's frames.
    void nameAs(const graph::KernelName& kernel, std::vector<graph::Argument>& arguments) const
    {
        const std::string text =
            productProgram(traced_.bench.device, kernel.file, kernel.name).generated.at("pass/" + kernel.name + ".h");
        static const std::regex parameter(
            "(?:const )?(__global const \\w+ \\*|__global \\w+ \\*|\\w+ )(?:restrict )?(\\w+)");
        const auto from = text.find("#define PARAMETERS ") + std::string("#define PARAMETERS ").size();
        const std::string list = text.substr(from, text.find('\n', from) - from);
        std::sregex_iterator next(list.begin(), list.end(), parameter);
        for (graph::Argument& argument : arguments) {
            REQUIRE(next != std::sregex_iterator());
            argument.name = (*next)[2];
            if (argument.type.starts_with("__global"))
                argument.type = (*next)[1];
            ++next;
        }
    }

    static void fill(graph::Graph& graph, graph::Version& list, const std::vector<std::uint32_t>& values)
    {
        const graph::Argument use = graph::writes("list", list);
        const graph::Version resource = list;
        graph.add({ .name = "fill",
            .arguments = { use },
            .domain = graph::Domain::Host,
            .step = [resource, values](graph::Run& run) {
                auto buffer = run.buffer<std::uint32_t>(resource);
                if (values.empty())
                    buffer.fill(run.queue(), 0u);
                else
                    buffer.upload(run.queue(), std::span<const std::uint32_t>(values));
            } });
    }

    TracedScene& traced_;
    device::ProgramLibrary library_;
    graph::Kernels kernels_;
    graph::Memory memory_;
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
        TracedScene traced(glossyScene(), device, 31, 23, { { "WEDGE_SPECULAR", "1" } });
        traced.primary();
        Sampler sampler(traced);
        const Points pixels = pixelPoints(traced, 12), wave = wavePoints(pixels, traced.layout);
        for (const Points* points : { &pixels, &wave })
            // Points alone, or with directions of both parts: the light is made so large that these are as dense.
            for (const std::uint32_t finding : { WEDGE_LIGHTS_SAMPLED, WEDGE_LIGHTS_BOTH }) {
                const shared::SampleParams params { WEDGE_SHADING_INSIDE, WEDGE_SAMPLER_SOBOL, 1, 0, finding, 0, {} };
                shared::AreaLight light = traced.onDevice.areaLightList[1];
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
        TracedScene traced(glossyScene(), device, 31, 23, { { "WEDGE_SPECULAR", "1" } });
        traced.primary();
        Sampler sampler(traced);
        const Points pixels = pixelPoints(traced, 12), wave = wavePoints(pixels, traced.layout);
        shared::PathParams params {};
        params.bounces = 2;
        params.areaLights = static_cast<std::uint32_t>(traced.onDevice.areaLightList.size());
        params.sceneDiameter = traced.onDevice.diameter;
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
        TracedScene traced(glossyScene(), device, 31, 23, { { "WEDGE_SPECULAR", "1" } });
        traced.primary();
        Sampler sampler(traced);
        const Points pixels = pixelPoints(traced, room);
        for (const std::uint32_t finding : { WEDGE_LIGHTS_SAMPLED, WEDGE_LIGHTS_BOTH }) {
            const shared::SampleParams params { WEDGE_SHADING_INSIDE, WEDGE_SAMPLER_SOBOL, 1, 0, finding, 0, {} };
            shared::AreaLight light = traced.onDevice.areaLightList[1];
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
        params.areaLights = static_cast<std::uint32_t>(traced.onDevice.areaLightList.size());
        params.sceneDiameter = traced.onDevice.diameter;
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

TEST_CASE("what sinks are handed are the pass's last arguments")
{
    CHECK_THROWS_WITH_AS(textOf({ sinks::sums(), sinks::means() }, { "sums" }),
        "pass \"samples\" hands sinks \"value\", which is not among its last arguments", std::logic_error);
    CHECK_THROWS_WITH_AS(textOf({ sinks::sums() }, { "sums", "taken" }),
        "pass \"samples\" hands sinks \"sums\", which is not among its last arguments", std::logic_error);
}
