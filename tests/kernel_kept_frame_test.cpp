// What the filter over time keeps of a frame: keepFrame and findVariation of temporal.cl, against docs/temporal.md in
// double.
#include "filters/temporal/temporal.h"
#include "tests/glass_support.h"
#include "tests/pass_bench.h"
#include "tests/product_programs.h"

#include <cmath>
#include <set>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 37, height = 21;

/// A frame that is filtered over time: of filtered light, and indirect light; else of Monte Carlo's. Of one with
/// mirrors pixels that reflect nothing diffusely are looked at.
struct Kind {
    bool filtered, antialias, mirrors;

    bool measures() const { return filtered && !antialias; } ///< pixels know their own noise
};
constexpr Kind kinds[] = { { true, false, false }, { true, true, false }, { false, true, true } };

render::Settings settingsOf(const Kind& kind)
{
    render::Settings settings = sized(kind.filtered ? render::axisAligned(16) : render::monteCarlo(1), width, height);
    settings.bounces = kind.filtered ? 1 : 0;
    settings.antialias = kind.antialias;
    settings.temporal = render::Temporal::On;
    settings.frame = 0;
    return settings;
}

scene::Scene sceneOf(const Kind& kind)
{
    SceneBuilder b;
    b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 }, kind.mirrors ? addMaterial(b, mirror()) : 0);
    b.camera({ 0, 2.0f, 2.8f }, { 0, 0.3f, 0 });
    return b.scene;
}

/// Calls test(kind, bench) with the filter's pass of that kernel in frames of all kinds.
template <class Test>
void inAllFrames(const std::string& kernel, const Test& test)
{
    onEveryDevice([&](const device::Device& device) {
        for (const Kind& kind : kinds) {
            CAPTURE(kind.filtered);
            CAPTURE(kind.antialias);
            render::Renderer renderer(sceneOf(kind), device, renderOptions());
            filters::TemporalFilter filter(device);
            render::HalfMemories none { render::SampleMemory(nullptr), render::SampleMemory(nullptr) };
            const auto frame = declareFrame(renderer, nullptr, settingsOf(kind), false, none, &filter);
            PassBench bench(renderer, frame->graph(), kernel);
            test(kind, bench);
        }
    });
}

bool nearShort(double found, double expected)
{
    return std::fabs(found - expected) <= std::fabs(expected) / 256 + 1e-6;
}

/// A colour of 47 bits.
bool nearColour(glm::dvec3 found, glm::dvec3 expected)
{
    const double largest = std::max({ expected.x, expected.y, expected.z });
    const glm::dvec3 off = glm::abs(found - expected);
    return std::max({ off.x, off.y, off.z }) <= largest / 4096;
}

/// Fills what keepFrame() reads with anything; every sixth pixel reflects nothing, and every fourth has no object.
void fillFrame(PassBench& bench, const Kind& kind)
{
    std::mt19937 random(1);
    const std::size_t size = bench.layout.size;
    std::vector<float> diffuse = someNumbers(random, 3 * size, 0, 0.6),
                       specular = someNumbers(random, 3 * size, 0, 0.3);
    for (std::size_t i = 0; i < diffuse.size(); ++i)
        diffuse[i] = specular[i] = i % size % 6 == 0 ? 0.0f : diffuse[i];
    bench.plane("diffuse", diffuse);
    bench.plane("specular", specular);
    bench.plane("position", someNumbers(random, 3 * size, -5, 5));
    Planes<float> normal(bench.layout, 3, 0.0f);
    everyPixel(bench.layout, [&](int x, int y) { normal.setVector(x, y, unitVector(random)); });
    bench.plane("normal", normal);
    bench.plane("objectId", someCounts(random, size, 4));
    for (const char* name : { "direct", "directNoisy" })
        bench.plane(name, someNumbers(random, 3 * size, 0, 9));
    for (const char* name : { "indirect", "indirectNoisy" })
        if (kind.filtered)
            bench.plane(name, someNumbers(random, 3 * size, 0, 9));
    for (const char* name : { "directDeviation", "indirectDeviation" })
        if (bench.has(name))
            bench.plane(name, someNumbers(random, size));
}

/// A deviation where it is measured, else 0.
Planes<float> deviationOf(const PassBench& bench, const char* name)
{
    return bench.has(name) ? bench.pixels<float>(name) : Planes<float>(bench.layout, 1, 0.0f);
}

} // namespace

TEST_CASE("keepFrame: depths, normals, objects, and light over what reflects it")
{
    inAllFrames("keepFrame", [](const Kind& kind, PassBench& bench) {
        fillFrame(bench, kind);
        auto p = bench.own<shared::TemporalParams>("p");
        REQUIRE((p.mixed != 0) == kind.antialias);
        REQUIRE((p.measured != 0) == kind.measures());
        const auto of = [&](const char* name) { return bench.pixels<float>(name); };
        const auto position = of("position"), normal = of("normal"), diffuse = of("diffuse"), specular = of("specular");
        const auto objectId = bench.pixels<std::uint32_t>("objectId");
        const auto direct = of("direct"), noisyDirect = of("directNoisy");
        const Planes<float> nothing(bench.layout, 3, 0.0f);
        const auto indirect = kind.filtered ? of("indirect") : nothing;
        const auto noisyIndirect = kind.filtered ? of("indirectNoisy") : nothing;
        const auto deviationA = deviationOf(bench, "directDeviation");
        const auto deviationB = deviationOf(bench, "indirectDeviation");
        for (const std::uint32_t open : { 0u, 1u }) {
            CAPTURE(open);
            p.open = open; // nothing is divided by what reflects
            bench.value("p", p);
            bench.run();
            const auto depth = of("depth"), light = of("directLight"), noisy = of("noisy"), variation = of("variation");
            const auto lightB = kind.filtered ? of("indirectLight") : nothing;
            const auto facing = bench.pixels<std::uint32_t>("facing"), object = bench.pixels<std::uint32_t>("object");
            everyPixel(bench.layout, [&](int x, int y) {
                const std::uint32_t id = objectId.at(x, y);
                const glm::dvec3 reflectance = diffuse.vector(x, y) + specular.vector(x, y);
                const glm::dvec3 k = open != 0 ? glm::dvec3(1) : reflectance + 0.01;
                const double seen = id != 0 || kind.antialias ? 1 : 0;
                const glm::dvec3 at = position.vector(x, y) - toGlm(p.eye);
                REQUIRE(std::fabs(depth.at(x, y) - glm::dot(at, toGlm(p.forward))) < 1e-5);
                const shared::Vec3 packed = shared::unpackNormal(facing.at(x, y));
                REQUIRE(glm::length(toGlm(packed) - normal.vector(x, y)) < 2e-3);
                // What a mirror shows is never found again.
                const bool lost = kind.mirrors && open == 0 && reflectance == glm::dvec3(0);
                REQUIRE(object.at(x, y) == (lost ? 0 : id));
                REQUIRE(nearColour(light.vector(x, y), seen * direct.vector(x, y) / k));
                REQUIRE(nearColour(lightB.vector(x, y), seen * indirect.vector(x, y) / k));
                const glm::dvec3 all = noisyDirect.vector(x, y) + noisyIndirect.vector(x, y);
                REQUIRE(nearShort(noisy.at(x, y), seen * luminanceOf(all / k)));
                const double own = seen * (deviationA.at(x, y) + deviationB.at(x, y)) / luminanceOf(k);
                REQUIRE(nearShort(variation.at(x, y), own * own));
            });
        }
    });
}

namespace {

/// What three pixels in a row say: by what the middle one's noise and both others' move it off the slope between them,
/// its variance, where that is not measured; and how an eighth of a pixel's shift either way, or less, moves the light.
double roughness(double before, double own, double after, bool measured)
{
    const double off = own - 0.5 * (before + after), variance = off * off / 1.5;
    const double shift = 0.5 * (after - before) / 8;
    return (measured ? 0.0 : variance) + shift * shift / 6;
}

} // namespace

TEST_CASE("findVariation: noise beside the pixel and the light's slope, of pixels of the same object")
{
    inAllFrames("findVariation", [](const Kind& kind, PassBench& bench) {
        std::mt19937 random(2);
        const std::size_t size = bench.layout.size;
        // Objects of several pixels, and of single ones.
        Planes<std::uint32_t> objects(bench.layout, 1, 0u);
        everyPixel(bench.layout, [&](int x, int y) {
            objects.at(x, y) = random() % 9 == 0 ? 100 + static_cast<std::uint32_t>(random() % 100)
                                                 : static_cast<std::uint32_t>(x / 7);
        });
        bench.plane("object", objects);
        bench.plane("noisy", someNumbers(random, size, 0, 8));
        bench.plane("variation", someNumbers(random, size, 0, 0.5));
        const auto noisy = bench.pixels<float>("noisy"), before = bench.pixels<float>("variation");
        const bool measures = bench.own<shared::TemporalParams>("p").measured != 0;
        REQUIRE(measures == kind.measures());
        bench.run();
        const auto variation = bench.pixels<float>("variation");
        unsigned alone = 0;
        everyPixel(bench.layout, [&](int x, int y) {
            const std::uint32_t id = objects.at(x, y);
            const bool measured = measures && id != 0;
            double sum = 0;
            int count = 0;
            for (const glm::ivec2 step : { glm::ivec2(1, 0), glm::ivec2(0, 1) }) {
                const glm::ivec2 a = glm::ivec2(x, y) - step, b = glm::ivec2(x, y) + step;
                if (a.x < 0 || a.y < 0 || b.x >= width || b.y >= height || objects.at(a.x, a.y) != id
                    || objects.at(b.x, b.y) != id)
                    continue;
                sum += roughness(noisy.at(a.x, a.y), noisy.at(x, y), noisy.at(b.x, b.y), measured);
                ++count;
            }
            alone += count == 0 ? 1 : 0;
            const double own = noisy.at(x, y);
            const double expected = measured ? sum : count > 0 ? sum / count : own * own;
            REQUIRE(nearShort(variation.at(x, y), before.at(x, y) + expected));
        });
        CHECK(alone > 50);
        CHECK(alone < 700);
        if (measures)
            return;
        // Noise alone, of all pixels of one object: in the mean it is its variance.
        bench.plane("object", Planes<std::uint32_t>(bench.layout, 1, 1u));
        bench.plane("noisy", someNumbers(random, size, 5, 5 + std::sqrt(12.0)));
        bench.plane("variation", Planes<float>(bench.layout, 1, 0.0f));
        bench.run();
        const auto found = bench.pixels<float>("variation");
        double mean = 0;
        for (int y = 1; y < height - 1; ++y)
            for (int x = 1; x < width - 1; ++x)
                mean += found.at(x, y) / ((width - 2.0) * (height - 2.0));
        CHECK(std::fabs(mean - 1) < 0.15); // three standard deviations
    });
}

TEST_CASE("a rehearsed sequence builds no program: neither in its first frame, nor in one that is kept alone")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool keptFirst : { false, true }) {
            CAPTURE(keptFirst);
            render::Renderer renderer(sceneOf(kinds[0]), device, renderOptions());
            render::Settings settings = settingsOf(kinds[0]);
            const auto filter = std::make_shared<filters::TemporalFilter>(device);
            renderer.filterFrames(filter);
            renderer.rehearse(settings);
            const std::set<device::ProgramSource> rehearsed = renderer.kernels().programs();
            for (std::uint32_t frame = 0; frame < 3; ++frame) {
                CAPTURE(frame);
                settings.frame = frame;
                filter->next(nullptr, !keptFirst || frame > 0);
                renderer.render(settings);
                CHECK((renderer.kernels().programs() == rehearsed));
            }
        }
    });
}
