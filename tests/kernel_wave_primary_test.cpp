// wave_primary.cl alone: rays through pixels' squares, the lens and the shutter, told from what they found; and that it
// is what the host finds along them.
#include "bvh/host_traverse.h"
#include "tests/lens_support.h"
#include "tests/pass_bench.h"

#include "kernels/shared/camera.h"

#include <cmath>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 20, height = 14, samples = 16;
constexpr std::size_t receivers = width * height * samples - 5; // not all lanes of the last packet
const glm::dvec3 lightRadiance(3, 2, 1), motion(0.3, -0.2, 0.1);

/// The small scene with a light that the camera sees, in part behind other things.
scene::Scene litScene()
{
    scene::Scene scene = smallScene();
    scene::AreaLight light = scene.areaLights[0];
    light.profile = scene::LightProfile::Uniform;
    light.centre = { 0.6f, 0.8f, -0.9f };
    light.halfU = { 0.6f, 0, 0 };
    light.halfV = { 0, 0.3f, -0.2f };
    light.radiance = glm::vec3(lightRadiance);
    light.twoSided = false;
    light.visible = true;
    scene.areaLights.push_back(light);
    return scene;
}

render::Settings antialiased()
{
    render::Settings settings = sized(render::monteCarlo(samples), width, height);
    settings.antialias = true;
    return settings;
}

/// The wave that has them all.
shared::WaveParams traceable(const PassBench& bench)
{
    auto wave = bench.own<shared::WaveParams>("wave", true);
    wave.receivers = static_cast<std::uint32_t>(receivers);
    wave.lastSample = samples;
    return wave;
}

/// What the kernel finds of `samples` receivers of each pixel.
class Traced {
public:
    Traced(DeclaredFrame& frame, std::size_t nth, const std::function<void(PassBench&)>& change = {})
        : bench(frame, "wavePrimary", "primary rays", nth)
        , camera(bench.own<shared::CameraParams>("camera"))
        , of(bench.own<shared::FrameParams>("frame", true))
        , size(bench.elements("position"))
    {
        REQUIRE(size > receivers);
        std::vector<std::uint32_t> pixelOf(bench.elements("pixelOf")), sampleOf(bench.elements("sampleOf"));
        for (std::uint32_t i = 0; i < receivers; ++i) {
            pixelOf[i] = x(i) | y(i) << 16;
            sampleOf[i] = i % (2 * samples) / 2;
        }
        bench.plane("pixelOf", pixelOf);
        bench.plane("sampleOf", sampleOf);
        bench.plane("wanted", Planes<std::uint32_t>(bench.layout, 1, samples));
        for (const char* name : { "rays", "pathRays" })
            bench.plane(name, std::vector<std::uint32_t>(bench.elements(name), 7u));
        bench.value("wave", traceable(bench));
        bench.value("frame", of);
        bench.items((receivers + WEDGE_TILE_PIXELS - 1) / WEDGE_TILE_PIXELS);
        bench.plane("depth", std::vector<float>(bench.elements("depth"), 7.0f));
        if (change)
            change(bench);
        bench.run();
        for (const char* name : { "position", "normal", "origin", "diffuse", "specular", "emission", "motion", "time",
                 "depth", "pixelSize" })
            numbers.emplace(name, bench.read<float>(name));
        for (const char* name : { "objectId", "view", "geometric", "rays", "pathRays" })
            counts.emplace(name, bench.read<std::uint32_t>(name));
    }
    /// Of two pixels beside each other in turn.
    static std::uint32_t x(std::size_t i) { return static_cast<std::uint32_t>(pixel(i) % width); }
    static std::uint32_t y(std::size_t i) { return static_cast<std::uint32_t>(pixel(i) / width); }
    static std::size_t pixel(std::size_t i) { return 2 * (i / (2 * samples)) + i % 2; }
    static std::size_t receiverOf(std::size_t pixel, std::size_t sample)
    {
        return pixel / 2 * 2 * samples + 2 * sample + pixel % 2;
    }

    double number(const char* name, std::size_t i) const { return numbers.at(name)[i]; }
    glm::dvec3 vector(const char* name, std::size_t i) const
    {
        const std::vector<float>& v = numbers.at(name);
        return { v[i], v[size + i], v[2 * size + i] };
    }
    glm::dvec3 direction(const char* name, std::size_t i) const
    {
        return toGlm(shared::unpackDirection(counts.at(name)[i]));
    }
    std::uint32_t object(std::size_t i) const { return counts.at("objectId")[i]; }
    /// Where the camera sees a point, pixels from the image's corner.
    glm::dvec2 imageOf(glm::dvec3 point) const
    {
        const glm::dvec3 d = point - toGlm(camera.eye), right = toGlm(camera.right), down = toGlm(camera.down);
        const double z = glm::dot(d, toGlm(camera.forward));
        return { glm::dot(d, right) / (glm::dot(right, right) * z) + 0.5 * width,
            glm::dot(d, down) / (glm::dot(down, down) * z) + 0.5 * height };
    }
    /// That point, from the corner of the receiver's pixel.
    glm::dvec2 inPixel(std::size_t i, glm::dvec3 point) const { return imageOf(point) - glm::dvec2(x(i), y(i)); }

    PassBench bench;
    shared::CameraParams camera;
    shared::FrameParams of;
    std::size_t size;
    std::map<std::string, std::vector<float>> numbers;
    std::map<std::string, std::vector<std::uint32_t>> counts;
};

bool nearTo(double found, double expected, double relative)
{
    return std::fabs(found - expected) <= relative * std::fabs(expected);
}

bool inSquare(glm::dvec2 p, double off) { return p.x > -off && p.y > -off && p.x < 1 + off && p.y < 1 + off; }

/// Where a ray meets the scene's last light, in its direction's lengths, on the side that emits; infinite: nowhere.
double meetsLight(const scene::Scene& scene, glm::dvec3 from, glm::dvec3 direction)
{
    const scene::AreaLight& light = scene.areaLights.back();
    const glm::dvec3 u = light.halfU, v = light.halfV, n = glm::cross(u, v);
    const double t = glm::dot(glm::dvec3(light.centre) - from, n) / glm::dot(direction, n);
    const glm::dvec3 at = from + t * direction - glm::dvec3(light.centre);
    // u and v are across each other.
    const bool inside = std::fabs(glm::dot(at, u)) < glm::dot(u, u) && std::fabs(glm::dot(at, v)) < glm::dot(v, v);
    return t > 0 && inside && glm::dot(direction, n) < 0 ? t : INFINITY;
}

/// Root of the area that a pixel's square, with the image point in its middle, has on the plane of a surface.
double footprint(const shared::CameraParams& camera, glm::dvec3 at, glm::dvec3 normal)
{
    const glm::dvec3 eye = toGlm(camera.eye), d = (at - eye) / glm::dot(at - eye, toGlm(camera.forward));
    const auto onPlane = [&](double a, double b) {
        const glm::dvec3 ray = d + a * toGlm(camera.right) + b * toGlm(camera.down);
        return glm::dot(at - eye, normal) / glm::dot(ray, normal) * ray;
    };
    return std::sqrt(glm::length(glm::cross(onPlane(0.5, 0) - onPlane(-0.5, 0), onPlane(0, 0.5) - onPlane(0, -0.5))));
}

} // namespace

TEST_CASE("wavePrimary: rays through strata of the pixels' squares find what the host's do")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, litScene(), antialiased());
        const Traced traced(frame, 0);
        const scene::Geometry& g = frame.scene().geometry;
        const bvh::Bvh hierarchy = bvh::build({ g.positions, g.indices });
        const glm::dvec3 eye = toGlm(traced.camera.eye), forward = toGlm(traced.camera.forward);
        unsigned hits = 0, lit = 0, missed = 0, differ = 0;
        for (std::size_t i = 0; i < receivers; ++i) {
            const std::uint32_t object = traced.object(i);
            const glm::dvec3 position = traced.vector("position", i), back = traced.direction("view", i);
            REQUIRE(traced.counts.at("rays")[i] == 0);
            REQUIRE(traced.counts.at("pathRays")[i] == 0);
            REQUIRE(traced.number("time", i) == 0);
            REQUIRE(glm::dvec2(traced.vector("motion", i)) == glm::dvec2(0));
            // View directions are 1e-4 exact, which is less than 0.01 pixels.
            REQUIRE(inSquare(traced.inPixel(i, eye - back), 0.01));
            const glm::dvec3 d = object != 0 ? position - eye : -back;
            const shared::Hit hit =
                bvh::closestHit(hierarchy, { traced.camera.eye, 0, toVec3(d), std::numeric_limits<float>::infinity() });
            const double light = meetsLight(frame.scene(), eye, d);
            const std::uint32_t found =
                light < hit.t || hit.triangle == WEDGE_NO_TRIANGLE ? 0 : g.objectIds[hit.triangle];
            const bool atLight = object == 0 && std::isfinite(traced.number("depth", i));
            if (object != found || (object == 0 && std::isfinite(light) != atLight)) {
                ++differ; // through an edge
                continue;
            }
            const glm::dvec3 emission = traced.vector("emission", i);
            if (object == 0) {
                REQUIRE(glm::length(emission - (atLight ? lightRadiance : glm::dvec3(0.1, 0.2, 0.3))) < 1e-6);
                if (atLight)
                    REQUIRE(nearTo(traced.number("depth", i), light * glm::dot(d, forward), 1e-3));
                (atLight ? lit : missed) += 1;
                continue;
            }
            ++hits;
            REQUIRE(std::fabs(hit.t - 1) < 1e-4);
            REQUIRE(nearTo(traced.number("depth", i), glm::dot(d, forward), 1e-5));
            REQUIRE(emission == glm::dvec3(0));
            REQUIRE(glm::length(traced.vector("diffuse", i) - glm::dvec3(0.8, 0.7, 0.6)) < 1e-6);
            REQUIRE(traced.vector("specular", i) == glm::dvec3(0));
            REQUIRE(glm::length(back + glm::normalize(d)) < 2e-4);
            glm::dvec3 face = faceNormal(g, hit.triangle);
            face *= glm::dot(face, d) > 0 ? -1.0 : 1.0;
            const glm::dvec3 geometric = traced.direction("geometric", i), normal = traced.vector("normal", i);
            const bool smooth = object == 4;
            if (!smooth)
                REQUIRE(glm::length(geometric - face) < 2e-4);
            const glm::dvec3 expected = smooth ? glm::normalize(position - glm::dvec3(0, 0.35, 0.7)) : face;
            REQUIRE(glm::length(normal - expected) < (smooth ? 0.02 : 1e-5));
            const glm::dvec3 lifted = traced.vector("origin", i) - position;
            REQUIRE(glm::dot(lifted, geometric) > 0);
            REQUIRE(glm::length(lifted) < (smooth ? 0.02 : 1e-5));
            if (glm::dot(geometric, back) > 0.3)
                REQUIRE(nearTo(traced.number("pixelSize", i), footprint(traced.camera, position, geometric), 0.02));
        }
        CAPTURE(differ);
        CHECK(hits > 2500);
        CHECK(lit > 40);
        CHECK(missed > 40);
        CHECK(differ < 20);
        CHECK(traced.counts.at("rays")[receivers] == 7);
        CHECK(traced.number("depth", receivers) == 7);
    });
}

TEST_CASE("wavePrimary: samples of a pixel have strata, of the sequence, and of first passes and the rest")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, litScene(), antialiased());
        struct Strata {
            std::uint32_t sampler, firstPass;
            std::size_t from, to; ///< samples
            int across; ///< strata
        };
        for (const Strata& s : { Strata { WEDGE_SAMPLER_SOBOL, 0, 0, 16, 4 }, { WEDGE_SAMPLER_STRATIFIED, 0, 0, 16, 4 },
                 { WEDGE_SAMPLER_STRATIFIED, 4, 0, 4, 2 }, { WEDGE_SAMPLER_STRATIFIED, 7, 7, 16, 3 } }) {
            CAPTURE(s.sampler);
            CAPTURE(s.firstPass);
            const Traced traced(frame, 0, [&](PassBench& bench) {
                auto wave = traceable(bench);
                wave.sampler = s.sampler;
                wave.firstPass = s.firstPass;
                bench.value("wave", wave);
            });
            unsigned full = 0;
            for (std::size_t pixel = 0; pixel + 2 < width * height; ++pixel) {
                std::set<std::pair<int, int>> strata;
                bool all = true;
                for (std::size_t k = s.from; k < s.to; ++k) {
                    const std::size_t i = Traced::receiverOf(pixel, k);
                    all = all && traced.object(i) != 0;
                    const glm::dvec2 at =
                        static_cast<double>(s.across) * traced.inPixel(i, traced.vector("position", i));
                    strata.emplace(static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y)));
                }
                full += all ? 1 : 0;
                if (all)
                    REQUIRE(strata.size() + 1 >= s.to - s.from); // but for rounding
            }
            CHECK(full > 100);
        }
    });
}

TEST_CASE("wavePrimary: what is known of lights takes the place of what rays find of them, also behind other things")
{
    onEveryDevice([](const device::Device& device) {
        // Known lights are for filtered frames, whose second pass is long enough.
        render::Settings settings = sized(render::axisAligned(2 * samples), width, height);
        settings.antialias = true;
        DeclaredFrame frame(device, litScene(), settings);
        const glm::dvec3 known(0.5, 0.25, 0.125);
        const auto even = [](int x) { return x % 2 == 0; };
        const Traced plain(frame, 1); // nothing is
        const Traced traced(frame, 1, [&](PassBench& bench) {
            REQUIRE(bench.has("known"));
            Planes<float> plane(bench.layout, 3, 0.0f);
            everyPixel(bench.layout, [&](int x, int y) {
                if (even(x))
                    plane.setVector(x, y, known);
            });
            bench.plane("known", plane);
        });
        const glm::dvec3 eye = toGlm(traced.camera.eye);
        unsigned lit = 0, hidden = 0, near = 0;
        for (std::size_t i = 0; i < receivers; ++i) {
            const glm::dvec3 d = -traced.direction("view", i), before = plain.vector("emission", i);
            const glm::dvec3 across = glm::dvec3(frame.scene().areaLights.back().halfU) * 0.01;
            const bool met = std::isfinite(meetsLight(frame.scene(), eye, d));
            // Directions are not exact.
            const bool edge = met != std::isfinite(meetsLight(frame.scene(), eye + across, d))
                || met != std::isfinite(meetsLight(frame.scene(), eye - across, d));
            if (edge || std::fabs(d.y) < 1e-9) {
                ++near;
                continue;
            }
            const bool changes = even(static_cast<int>(Traced::x(i)));
            const glm::dvec3 lights = met ? lightRadiance : glm::dvec3(0);
            const glm::dvec3 expected = changes ? before - lights + known : before;
            REQUIRE(glm::length(traced.vector("emission", i) - expected) < 1e-3);
            lit += met && traced.object(i) == 0 ? 1 : 0;
            hidden += met && traced.object(i) != 0 ? 1 : 0;
        }
        CHECK(lit > 40);
        CHECK(hidden > 10);
        CHECK(near < 100);
    });
}

TEST_CASE("wavePrimary: rays through the lens to the plane in focus, at times of the shutter, and how hits move")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene still = smallScene();
        still.camera.apertureRadius = 0.08f;
        still.camera.focusDistance = 2.5f;
        scene::Scene moving = still;
        displace(moving, motion);
        moving.shutterClose = 1;
        DeclaredFrame frame(device, moving, sized(render::monteCarlo(samples), width, height)); // through the centres
        const Traced traced(frame, 0);
        REQUIRE(traced.camera.pixelFilter == WEDGE_PIXEL_CENTRE);
        const bvh::Bvh hierarchy = bvh::build({ still.geometry.positions, still.geometry.indices });
        const glm::dvec3 eye = toGlm(traced.camera.eye), forward = toGlm(traced.camera.forward);
        const double pixel = traced.camera.pixelStep;
        unsigned hits = 0, differ = 0;
        double times = 0, spread = 0, radii = 0;
        glm::dvec3 middle(0);
        for (std::size_t i = 0; i < receivers; ++i) {
            const double time = traced.number("time", i);
            REQUIRE(time >= 0);
            REQUIRE(time <= 1);
            times += time / receivers;
            spread += (time - 0.5) * (time - 0.5) / receivers;
            if (traced.object(i) == 0)
                continue;
            const glm::dvec3 position = traced.vector("position", i), back = traced.direction("view", i);
            // From the surface back to the lens, and to what is in focus.
            const auto inPlane = [&](double z) {
                return position + (z - glm::dot(position - eye, forward)) / glm::dot(back, forward) * back;
            };
            const glm::dvec3 onLens = inPlane(0), focused = inPlane(2.5);
            REQUIRE(glm::length(onLens - eye) < 0.08 + 1e-3);
            REQUIRE(glm::length(traced.inPixel(i, focused) - 0.5) * pixel < 2e-4);
            ++hits;
            middle += onLens - eye;
            radii += glm::dot(onLens - eye, onLens - eye);
            // All that moves is where it was at time 0.
            const glm::dvec3 to = position - onLens;
            const shared::Hit hit = bvh::closestHit(
                hierarchy, { toVec3(onLens - time * motion), 0, toVec3(to), std::numeric_limits<float>::infinity() });
            differ += std::fabs(hit.t - 1) > 1e-3 ? 1 : 0;
            const glm::dvec2 moved =
                traced.imageOf(position + (1 - time) * motion) - traced.imageOf(position - time * motion);
            REQUIRE(glm::length(glm::dvec2(traced.vector("motion", i)) - moved) < 1e-3);
            REQUIRE(glm::length(moved) > 0.5);
        }
        CHECK(hits > 2500);
        CHECK(differ < hits / 100);
        CHECK(std::fabs(times - 0.5) < 0.02);
        CHECK(nearTo(spread, 1.0 / 12, 0.05));
        CHECK(glm::length(middle) / hits < 0.01);
        // Of an even disc half of the squared radius.
        CHECK(nearTo(radii / hits, 0.5 * 0.08 * 0.08, 0.05));
    });
}
