// sampleMirrors alone: what mirrors and glass show, against paths followed on the host.
#include "bvh/host_traverse.h"
#include "tests/glass_support.h"
#include "tests/pass_bench.h"

#include <cmath>
#include <numbers>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 33, height = 21;
constexpr double refraction = 1.5;
const glm::vec3 above(0.1f, 0.2f, 0.3f), below(3, 2, 1), mirrorColour(0.9f, 0.5f, 0.7f);
const glm::dvec3 lamp(0.4, 1.7, 0.8), intensity(4, 3, 2);

scene::Material emitting(glm::vec3 radiance)
{
    scene::Material m;
    m.diffuse = glm::vec3(0);
    m.emission = radiance;
    return m;
}

/// Mirrors across from each other, a floor, and boxes: lit by a lamp, or all black, and one emits. Several lights would
/// be chosen at random.
scene::Scene mirrorRoom(bool lit)
{
    SceneBuilder b;
    if (!lit)
        b.scene.materials[0].diffuse = glm::vec3(0);
    const std::uint32_t shiny = addMaterial(b, mirror(mirrorColour));
    b.quad({ 0, 0, 0 }, { 0, 0, 4 }, { 4, 0, 0 });
    b.newObject();
    b.quad({ 0, 1, -1 }, { 0.9f, 0, 0 }, { 0, 0.9f, 0 }, shiny);
    b.newObject();
    b.quad({ 0, 1, 3.5f }, { 2, 0, 0 }, { 0, -0.9f, 0.2f }, shiny); // behind the camera
    b.newObject();
    b.box({ -0.9f, 0, 0.2f }, { -0.5f, 0.6f, 0.6f }, lit ? 0 : addMaterial(b, emitting({ 0.5f, 2, 4 })));
    b.newObject();
    b.box({ 0.5f, 0, 0.1f }, { 0.8f, 0.7f, 0.4f }, lit ? 0 : addMaterial(b, emitting(below)));
    if (lit)
        b.scene.pointLights.push_back({ glm::vec3(lamp), glm::vec3(intensity) });
    b.scene.background = above;
    b.camera({ 0.3f, 0.9f, 3 }, { 0, 0.7f, -1 });
    return b.scene;
}

/// A pane of glass over something that emits.
scene::Scene glassPond()
{
    SceneBuilder b;
    b.quad({ 0, 0, 0 }, { 0, 0, 9 }, { 9, 0, 0 }, addMaterial(b, glass(static_cast<float>(refraction))));
    b.newObject();
    b.quad({ 0, -1, 0 }, { 0, 0, 30 }, { 30, 0, 0 }, addMaterial(b, emitting(below)));
    b.scene.background = above;
    b.camera({ 0, 0.8f, 3 }, { 0, 0.2f, 0 });
    return b.scene;
}

/// sampleMirrors of a frame, of the receivers that its camera sees.
PassBench mirrorBench(DeclaredFrame& frame, std::uint32_t samples, const Planes<std::uint32_t>& taken)
{
    PassBench primary(frame, "primary");
    primary.run();
    PassBench bench(frame, "sampleMirrors");
    for (const char* name : { "position", "normal", "origin" })
        bench.plane(name, primary.read<float>(name));
    for (const char* name : { "geometric", "objectId", "gloss" })
        bench.plane(name, primary.read<std::uint32_t>(name));
    bench.plane("taken", taken);
    bench.value("lastSample", samples);
    return bench;
}

/// The ray through a pixel's centre.
glm::dvec3 directionOf(const shared::FrameParams& p, int x, int y)
{
    return toGlm(p.forward) + (x + 0.5 - 0.5 * width) * toGlm(p.right) + (y + 0.5 - 0.5 * height) * toGlm(p.down);
}

struct Path {
    glm::dvec3 radiance { 0 };
    unsigned mirrors = 0; ///< that it has met
    bool lit = false; ///< it ends where the lamp is to be looked for
    bool emits = false; ///< or it shines itself
    bool close = false; ///< something is so near that rounding decides
};

/// What is seen along a ray of the room with mirrors.
Path follow(const scene::Scene& scene, const bvh::Bvh& hierarchy, glm::dvec3 from, glm::dvec3 direction)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const scene::Geometry& g = scene.geometry;
    glm::dvec3 weight(1);
    Path path;
    for (;;) {
        const shared::Hit hit = bvh::closestHit(hierarchy, { toVec3(from), 1e-4f, toVec3(direction), infinity });
        if (hit.triangle == WEDGE_NO_TRIANGLE) {
            path.radiance += weight * glm::dvec3(scene.background);
            return path;
        }
        // Along edges of quads and boxes; both triangles' hypotenuse is none.
        path.close = path.close || std::min({ hit.u, hit.v, 1 - hit.u - hit.v }) < 2e-3f;
        const auto corner = [&](std::uint32_t k) {
            const std::size_t v = 3 * std::size_t { g.indices[3 * hit.triangle + k] };
            return glm::dvec3(g.positions[v], g.positions[v + 1], g.positions[v + 2]);
        };
        glm::dvec3 n = glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
        n *= glm::dot(n, direction) > 0 ? -1.0 : 1.0;
        const scene::Material& m = scene.materials[g.materialIds[hit.triangle]];
        const glm::dvec3 at = from + static_cast<double>(hit.t) * direction;
        if (m.specularModel == scene::SpecularModel::Mirror) {
            weight *= glm::dvec3(m.specular);
            direction = glm::normalize(direction - 2 * glm::dot(direction, n) * n);
            from = at;
            ++path.mirrors;
            continue;
        }
        path.emits = m.emission != glm::vec3(0);
        path.radiance += weight * glm::dvec3(m.emission);
        const glm::dvec3 to = lamp - at;
        const double cosine = glm::dot(n, glm::normalize(to));
        path.close = path.close || std::fabs(cosine) < 1e-3;
        path.lit = cosine > 0 && m.diffuse != glm::vec3(0);
        if (path.lit && !bvh::anyHit(hierarchy, { toVec3(at + 1e-4 * n), 0, toVec3(to), 1 }))
            path.radiance += weight * glm::dvec3(m.diffuse) / std::numbers::pi * intensity * cosine / glm::dot(to, to);
        return path;
    }
}

/// Share that glass reflects of unpolarized light (Fresnel), for the cosine of its direction.
double reflectedShare(double cosine)
{
    const double inside = std::asin(std::sqrt(1 - cosine * cosine) / refraction), outside = std::acos(cosine);
    const double sum = outside + inside, difference = outside - inside;
    const auto squared = [](double v) { return v * v; };
    return 0.5 * squared(std::sin(difference) / std::sin(sum)) + 0.5 * squared(std::tan(difference) / std::tan(sum));
}

bool nearTo(glm::dvec3 found, glm::dvec3 expected, double relative)
{
    return glm::length(found - expected) <= relative * (glm::length(expected) + 1e-3);
}

} // namespace

TEST_CASE("sampleMirrors: sums of what is seen from mirror to mirror, of the samples that pixels do not have yet")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool lit : { true, false }) {
            CAPTURE(lit);
            DeclaredFrame frame(device, mirrorRoom(lit), sized(render::monteCarlo(4), width, height));
            const std::uint32_t last = 5;
            std::mt19937 random(1);
            Planes<std::uint32_t> taken(frame.layout, 1, 0u);
            everyPixel(frame.layout, [&](int x, int y) { taken.at(x, y) = static_cast<std::uint32_t>(random() % 7); });
            PassBench bench = mirrorBench(frame, last, taken);
            bench.plane("sums", someNumbers(random, 3 * frame.layout.size));
            const auto p = bench.own<shared::FrameParams>("frame");
            const auto before = bench.pixels<float>("sums");
            const auto object = bench.pixels<std::uint32_t>("objectId");
            bench.run();
            const auto sums = bench.pixels<float>("sums");
            const auto takenNow = bench.pixels<std::uint32_t>("taken"), rays = bench.pixels<std::uint32_t>("rays");
            const auto pathRays = bench.pixels<std::uint32_t>("pathRays");
            const scene::Geometry& g = frame.scene().geometry;
            const bvh::Bvh hierarchy = bvh::build({ g.positions, g.indices });
            unsigned mirrors = 0, several = 0, close = 0, shining = 0;
            everyPixel(frame.layout, [&](int x, int y) {
                const std::uint32_t has = taken.at(x, y), n = has < last ? last - has : 0;
                if (object.at(x, y) != 2 || n == 0) { // the mirror that the camera sees
                    REQUIRE(sums.vector(x, y) == before.vector(x, y));
                    REQUIRE(takenNow.at(x, y) == has);
                    REQUIRE(rays.at(x, y) == 0);
                    return;
                }
                REQUIRE(takenNow.at(x, y) == last);
                const Path path = follow(frame.scene(), hierarchy, toGlm(p.eye), directionOf(p, x, y));
                if (path.close) {
                    ++close;
                    return;
                }
                REQUIRE(nearTo(sums.vector(x, y) - before.vector(x, y), static_cast<double>(n) * path.radiance, 1e-4));
                // One from each mirror, and one to the lamp.
                if (lit) {
                    REQUIRE(pathRays.at(x, y) == n * path.mirrors);
                    REQUIRE(rays.at(x, y) == n * (path.mirrors + (path.lit ? 1 : 0)));
                }
                ++mirrors;
                several += path.mirrors > 1 ? 1 : 0;
                shining += path.lit || path.emits ? 1 : 0;
            });
            CAPTURE(close);
            CHECK(mirrors > 80);
            CHECK(several > 20);
            CHECK(shining > 10);
            CHECK(close < 30);
        }
    });
}

TEST_CASE("sampleMirrors: glass reflects its share of samples, and lets the others through")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, glassPond(), sized(render::monteCarlo(4), width, height));
        constexpr std::uint32_t samples = 64;
        PassBench bench = mirrorBench(frame, samples, Planes<std::uint32_t>(frame.layout, 1, 0u));
        const auto p = bench.own<shared::FrameParams>("frame");
        const auto object = bench.pixels<std::uint32_t>("objectId");
        bench.run();
        const auto sums = bench.pixels<float>("sums");
        double off = 0;
        unsigned pixels = 0;
        everyPixel(frame.layout, [&](int x, int y) {
            if (object.at(x, y) != 1)
                return;
            // Behind the surface radiance is index^2 times as much.
            const glm::dvec3 sum = sums.vector(x, y), through = glm::dvec3(below) / (refraction * refraction);
            const glm::dvec3 reflected(above);
            const double count = (samples * through.x - sum.x) / (through.x - reflected.x);
            REQUIRE(std::fabs(count - std::round(count)) < 1e-3); // samples are whole
            REQUIRE(nearTo(sum, count * reflected + (samples - count) * through, 1e-4));
            const double share = reflectedShare(-glm::normalize(directionOf(p, x, y)).y);
            REQUIRE(std::fabs(count - samples * share) < 4); // of a sequence
            off += count - samples * share;
            ++pixels;
        });
        CHECK(pixels > 300);
        CHECK(std::fabs(off / pixels) < 0.1);
    });
}
