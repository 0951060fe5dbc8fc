// seen_lights.cl alone: where in the image lights may be, and what pixels receive from them, against points on lights
// and lens, and areas of polygons, in double.
#include "bvh/host_traverse.h"
#include "tests/pass_bench.h"
#include "tests/render_oracles.h"

#include "kernels/shared/camera.h"

#include <cmath>
#include <numbers>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 40, height = 28;
constexpr float unknown = 0, ofPixel = 1, ofLens = 2; ///< how a share is known, seen_lights.cl
constexpr auto uniformProfile = scene::LightProfile::Uniform, gaussian = scene::LightProfile::Gaussian;

/// A camera that lights are seen by: of a lens of that radius, or a pinhole, 4 metres before z = 0, with the plane in
/// focus at `focus`. antialias: through all of the pixels, else through their centres.
struct Seeing {
    float aperture, focus;
    bool antialias;
};

render::Settings settingsOf(const Seeing& seeing)
{
    render::Settings settings = sized(render::axisAligned(16), width, height);
    settings.antialias = seeing.antialias;
    return settings;
}

/// Before a black wall.
SceneBuilder before(const Seeing& seeing)
{
    SceneBuilder b;
    b.newObject();
    b.quad({ 0, 0, -1 }, { 9, 0, 0 }, { 0, 9, 0 });
    b.camera({ 0, 0, 4 }, { 0, 0, 0 });
    b.scene.camera.apertureRadius = seeing.aperture;
    b.scene.camera.focusDistance = seeing.focus;
    return b;
}

scene::AreaLight& seenLight(SceneBuilder& b, glm::vec3 centre, float size, scene::LightProfile profile = uniformProfile)
{
    scene::AreaLight& light =
        b.light(centre, size * glm::vec3(0.8f, 0.3f, 0.1f), size * glm::vec3(-0.2f, 0.7f, -0.2f), profile, 100);
    light.visible = true;
    return light;
}

/// Where in the image, in pixels from its corner, a point of the lens sees a point: through the plane in focus. lens:
/// in radii.
glm::dvec2 imageOf(const shared::CameraParams& c, glm::dvec3 point, glm::dvec2 lens)
{
    const glm::dvec3 eye = toGlm(c.eye), right = toGlm(c.right), down = toGlm(c.down), forward = toGlm(c.forward);
    const double radius = c.apertureRadius;
    const glm::dvec3 from = eye + radius * (lens.x * glm::normalize(right) + lens.y * glm::normalize(down));
    const glm::dvec3 d = point - from;
    const glm::dvec3 focused = from + c.focusDistance / glm::dot(d, forward) * d - eye;
    const double z = glm::dot(focused, forward);
    return { glm::dot(focused, right) / (glm::dot(right, right) * z) + 0.5 * width,
        glm::dot(focused, down) / (glm::dot(down, down) * z) + 0.5 * height };
}

/// A light's six numbers.
struct FoundWindow {
    double x0, y0, x1, y1, way, confusion;
};
FoundWindow windowOf(const std::vector<float>& windows, std::size_t light)
{
    const float* w = windows.data() + 6 * light;
    return { w[0], w[1], w[2], w[3], w[4], w[5] };
}

std::vector<float> windowsOf(DeclaredFrame& frame)
{
    PassBench bench(frame, "windowsOfLights");
    bench.run();
    return bench.read<float>("windows");
}

} // namespace

TEST_CASE("windowsOfLights: the least rectangles that all rays to lights go through, and radii of confusion")
{
    onEveryDevice([](const device::Device& device) {
        for (const Seeing& seeing : { Seeing { 0, 4, true }, { 0.1f, 3, true }, { 0.2f, 6, false } }) {
            CAPTURE(seeing.aperture);
            std::mt19937 random(1);
            SceneBuilder b = before(seeing);
            const auto number = [&](double most) { return static_cast<float>(uniform(random, -most, most)); };
            for (int k = 0; k < 40; ++k)
                seenLight(b, { number(3), number(2), number(2) }, static_cast<float>(uniform(random, 0.01, 0.8)));
            DeclaredFrame frame(device, b.scene, settingsOf(seeing));
            const auto camera = PassBench(frame, "windowsOfLights").own<shared::CameraParams>("camera");
            const std::vector<float> windows = windowsOf(frame);
            int seen = 0, beyond = 0;
            for (std::size_t i = 0; i < b.scene.areaLights.size(); ++i) {
                CAPTURE(i);
                glm::dvec2 low(INFINITY), high(-INFINITY);
                double confusion = 0;
                bool inView = false;
                for (int k = 0; k < 36 * 25; ++k) {
                    const glm::dvec3 point = pointOf(b.scene.areaLights[i], k % 5 / 2.0 - 1, k / 5 % 5 / 2.0 - 1);
                    const double angle = 2 * std::numbers::pi * std::floor(k / 25.0) / 36;
                    const glm::dvec2 at = imageOf(camera, point, { std::cos(angle), std::sin(angle) });
                    low = glm::min(low, at);
                    high = glm::max(high, at);
                    confusion = std::max(confusion, glm::distance(at, imageOf(camera, point, glm::dvec2(0))));
                    inView = inView || (at.x > 0 && at.y > 0 && at.x < width && at.y < height);
                }
                const FoundWindow found = windowOf(windows, i);
                REQUIRE(std::fabs(found.confusion - confusion) < 1e-3 + 1e-4 * confusion);
                if (std::isinf(found.x0)) {
                    REQUIRE(found.x0 > 0);
                    REQUIRE(!inView);
                    ++beyond;
                    continue;
                }
                REQUIRE(std::fabs(found.x0 - low.x) < 0.01 + 0.01 * confusion);
                REQUIRE(std::fabs(found.y0 - low.y) < 0.01 + 0.01 * confusion);
                REQUIRE(std::fabs(found.x1 - high.x) < 0.01 + 0.01 * confusion);
                REQUIRE(std::fabs(found.y1 - high.y) < 0.01 + 0.01 * confusion);
                ++seen;
            }
            CHECK(seen > 10);
            CHECK(beyond > 3);
        }
    });
}

TEST_CASE("windowsOfLights: which lights are nowhere in the image, and which may be anywhere")
{
    onEveryDevice([](const device::Device& device) {
        const Seeing seeing { 0.1f, 3, true };
        SceneBuilder b = before(seeing);
        seenLight(b, { 0, 0, 0 }, 0.2f).visible = false;
        seenLight(b, { 0, 0, 6 }, 0.2f); // behind
        seenLight(b, { 40, 0, 0 }, 0.2f); // beside
        seenLight(b, { -40, 0, 0 }, 0.2f);
        seenLight(b, { 0, 40, 0 }, 0.2f);
        seenLight(b, { 0, -40, 0 }, 0.2f);
        scene::AreaLight& through = seenLight(b, { 0, 0.5f, 4 }, 0.2f); // beside the lens, before and behind it
        through.halfU = { 0, 0, 1 };
        through.halfV = { 0.5f, 0, 0 };
        DeclaredFrame frame(device, b.scene, settingsOf(seeing));
        const std::vector<float> windows = windowsOf(frame);
        for (std::size_t i = 0; i < 6; ++i)
            CHECK(windowOf(windows, i).x0 == INFINITY);
        const FoundWindow anywhere = windowOf(windows, 6);
        CHECK(anywhere.x0 == -INFINITY);
        CHECK(anywhere.y0 == -INFINITY);
        CHECK(anywhere.x1 == INFINITY);
        CHECK(anywhere.y1 == INFINITY);
        CHECK(anywhere.way == unknown);
    });
}

TEST_CASE("windowsOfLights: how shares are known, of uniform lights, small ones, the lens, and in focus")
{
    onEveryDevice([](const device::Device& device) {
        struct Case {
            Seeing seeing;
            float z, size;
            scene::LightProfile profile;
            float few, many; ///< where what is known to 1e-3 will do, and where it will not
        };
        for (const Case& c : { Case { { 0, 4, true }, 0, 0.5f, uniformProfile, ofPixel, ofPixel },
                 { { 0, 4, true }, 0, 0.5f, gaussian, unknown, unknown },
                 { { 0, 4, true }, 0, 0.03f, gaussian, ofPixel, unknown },
                 { { 0.1f, 4, true }, 0, 0.03f, uniformProfile, ofPixel, unknown }, // in focus
                 { { 0.1f, 1, true }, 0, 0.03f, uniformProfile, ofLens, unknown }, // a few pixels of confusion
                 { { 0.1f, 1, true }, 0, 0.5f, gaussian, unknown, unknown },
                 { { 0.1f, 4, false }, 0, 0.03f, uniformProfile, unknown, unknown },
                 { { 0.1f, 1, false }, 0, 0.03f, uniformProfile, ofLens, ofLens },
                 { { 0.9f, 0.5f, false }, 0, 0.03f, uniformProfile, unknown, unknown } }) { // too many
            CAPTURE(c.seeing.aperture);
            CAPTURE(c.seeing.focus);
            CAPTURE(c.size);
            CAPTURE(c.seeing.antialias);
            SceneBuilder b = before(c.seeing);
            seenLight(b, { 0, 0, c.z }, c.size, c.profile);
            DeclaredFrame frame(device, b.scene, settingsOf(c.seeing));
            for (const std::uint32_t approximate : { 1u, 0u }) {
                CAPTURE(approximate);
                PassBench bench(frame, "windowsOfLights");
                bench.value("approximate", approximate);
                bench.run();
                const FoundWindow found = windowOf(bench.read<float>("windows"), 0);
                CAPTURE(found.confusion);
                CHECK(found.way == (approximate != 0 ? c.few : c.many));
            }
        }
        // What half of the lens sees from behind is not known.
        const Seeing seeing { 0.1f, 4, true };
        for (const bool twoSided : { false, true }) {
            SceneBuilder b = before(seeing);
            scene::AreaLight& light = seenLight(b, { 0, 0, 0 }, 0.03f);
            light.halfU = { 0.0001f, 0, 0.03f };
            light.halfV = { 0, 0.03f, 0 };
            light.twoSided = twoSided;
            DeclaredFrame frame(device, b.scene, settingsOf(seeing));
            CHECK(windowOf(windowsOf(frame), 0).way == (twoSided ? ofPixel : unknown));
        }
    });
}

namespace {

/// A primary ray: from the pixel's centre, pixels, and through which point of the lens, radii.
struct Way {
    glm::dvec2 offset { 0 }, lens { 0 };
};

/// As many as 2^16, in strata of the pixel and of the lens.
std::vector<Way> waysOf(const Seeing& seeing)
{
    constexpr int strata = 256;
    std::mt19937 random(3);
    std::vector<glm::dvec2> square, disc;
    for (int i = 0; i < strata * strata; ++i) {
        const auto number = [&](int stratum) { return (stratum + uniform(random)) / strata; };
        square.emplace_back(number(i % strata) - 0.5, number(i / strata) - 0.5);
        const double radius = std::sqrt(number(i % strata)), angle = 2 * std::numbers::pi * number(i / strata);
        disc.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    std::ranges::shuffle(disc, random);
    std::vector<Way> out(square.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i].offset = seeing.antialias ? square[i] : glm::dvec2(0);
        out[i].lens = seeing.aperture > 0 ? disc[i] : glm::dvec2(0);
    }
    return out;
}

struct PixelRay {
    glm::dvec3 from, direction;
};
PixelRay rayOf(const shared::CameraParams& c, int x, int y, const Way& way)
{
    const glm::dvec3 right = toGlm(c.right), down = toGlm(c.down);
    const double radius = c.apertureRadius, focus = c.focusDistance;
    const glm::dvec3 off = radius * (way.lens.x * glm::normalize(right) + way.lens.y * glm::normalize(down));
    const glm::dvec3 through = toGlm(c.forward) + (x + 0.5 + way.offset.x - 0.5 * width) * right
        + (y + 0.5 + way.offset.y - 0.5 * height) * down;
    return { toGlm(c.eye) + off, focus * through - off };
}

/// How bright a ray meets a light, of 1 in its middle; t: where, in the ray's lengths, whatever it meets before.
double metProfile(const scene::AreaLight& light, const PixelRay& ray, double& t)
{
    const glm::dvec3 u = light.halfU, v = light.halfV, n = glm::cross(u, v);
    t = glm::dot(glm::dvec3(light.centre) - ray.from, n) / glm::dot(ray.direction, n);
    const glm::dvec3 at = ray.from + t * ray.direction - glm::dvec3(light.centre);
    const double a = glm::dot(glm::cross(at, v), n) / glm::dot(n, n),
                 b = glm::dot(glm::cross(u, at), n) / glm::dot(n, n);
    const bool meets = t > 0 && std::fabs(a) <= 1 && std::fabs(b) <= 1;
    t = meets ? t : INFINITY;
    return meets ? profileAt(light, a, b) : 0.0;
}

/// The mean of what ways see of a light, whatever is before it, and of those that meet it, the share before which there
/// is something.
struct SeenShare {
    double mean = 0, hidden = 0;
    bool same = true; ///< all are as bright
};
SeenShare shareOf(const scene::AreaLight& light, const shared::CameraParams& camera, const bvh::Bvh& hierarchy,
    const std::vector<Way>& ways, int x, int y)
{
    SeenShare out;
    double met = 0, hidden = 0, least = INFINITY, most = 0;
    for (std::size_t k = 0; k < ways.size(); ++k) {
        const PixelRay ray = rayOf(camera, x, y, ways[k]);
        double t;
        const double profile = metProfile(light, ray, t);
        out.mean += profile / static_cast<double>(ways.size());
        least = std::min(least, profile);
        most = std::max(most, profile);
        if (k % 61 == 0 && std::isfinite(t)) {
            ++met;
            hidden +=
                bvh::anyHit(hierarchy, { toVec3(ray.from), 0, toVec3(ray.direction), static_cast<float>(t) }) ? 1 : 0;
        }
    }
    out.hidden = met > 0 ? hidden / met : 0.0;
    out.same = least == most;
    return out;
}

} // namespace

TEST_CASE("seenLights: the share of the pixel, and of the lens, that a light covers, if nothing is before it")
{
    onEveryDevice([](const device::Device& device) {
        struct Case {
            Seeing seeing;
            float size;
            scene::LightProfile profile;
            double off; ///< of the light's radiance
            int edges; ///< pixels, at least
        };
        for (const Case& c :
            { Case { { 0, 4, true }, 1, uniformProfile, 1e-3, 40 }, { { 0, 4, true }, 0.05f, uniformProfile, 1e-3, 1 },
                { { 0, 4, true }, 0.1f, gaussian, 2e-3, 2 }, { { 0.1f, 1, false }, 1, uniformProfile, 1e-3, 100 },
                { { 0.1f, 1, false }, 0.05f, uniformProfile, 1e-3, 8 },
                { { 0.1f, 1, true }, 0.3f, uniformProfile, 6e-3, 8 },
                { { 0.03f, 1, true }, 0.3f, uniformProfile, 6e-3, 8 } }) { // of little confusion

            CAPTURE(c.seeing.aperture);
            CAPTURE(c.seeing.antialias);
            CAPTURE(c.size);
            SceneBuilder b = before(c.seeing);
            const scene::AreaLight light = seenLight(b, { 0.13f, 0.07f, 0 }, c.size, c.profile);
            // Before a corner of the large light.
            b.newObject();
            b.box({ 0.55f, 0.2f, 0.9f }, { 1.2f, 0.9f, 1 });
            DeclaredFrame frame(device, b.scene, settingsOf(c.seeing));
            PassBench bench(frame, "seenLights");
            const std::vector<float> windows = windowsOf(frame);
            const FoundWindow near = windowOf(windows, 0);
            bench.plane("windows", windows);
            bench.run();
            const auto known = bench.pixels<float>("known");
            const auto camera = bench.own<shared::CameraParams>("camera");
            const scene::Geometry& g = frame.scene().geometry;
            const bvh::Bvh hierarchy = bvh::build({ g.positions, g.indices });
            const std::vector<Way> ways = waysOf(c.seeing);
            int edges = 0, hidden = 0, even = 0;
            everyPixel(frame.layout, [&](int x, int y) {
                const glm::dvec3 found = known.vector(x, y) / 100.0;
                if (x + 2 < near.x0 || x - 1 > near.x1 || y + 2 < near.y0 || y - 1 > near.y1) {
                    REQUIRE(found.x == 0);
                    return;
                }
                const SeenShare share = shareOf(light, camera, hierarchy, ways, x, y);
                REQUIRE(found.x == found.y);
                REQUIRE(found.x == found.z);
                if (share.same) {
                    ++even;
                    // With a lens that is told by squares, which are larger.
                    REQUIRE((found.x < 1e-4 || (c.seeing.aperture > 0 && std::fabs(found.x - share.mean) < c.off)));
                } else if (share.hidden > 0.5) {
                    ++hidden;
                    REQUIRE(found.x == 0);
                } else if (share.hidden == 0 && share.mean > 2e-3) {
                    ++edges;
                    // Of a small share none of the tried rays may know.
                    REQUIRE(std::fabs(found.x - share.mean) < (found.x == 0 ? 0.1 : c.off));
                }
            });
            CHECK(edges >= c.edges);
            CHECK((c.size < 1 || even > 100));
            CHECK((c.size < 1 || hidden > 5));
        }
    });
}
