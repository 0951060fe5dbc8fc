// shadowLights of shadow_lights.cl alone: what lights bring with shadows and without, against the host's traversal and
// sums in double.
#include "bvh/host_traverse.h"
#include "tests/shadow_lights_support.h"

#include <limits>

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

namespace {

void compare(const device::Device& device, const scene::Scene& scene)
{
    DeclaredFrame frame(device, scene, settings(render::Shadows::Ratio));
    const std::vector<render::MapLight> lights = render::mapLights(*frame.scene().picture(), count);
    Traced traced(frame, lights);
    const PassBench& bench = traced.pass;
    traced.upTo(count);
    const auto matt = bench.pixels<float>("mattSums"), lobes = bench.pixels<float>("lobeSums");
    const auto origin = bench.pixels<float>("origin"), normal = bench.pixels<float>("normal");
    const auto position = bench.pixels<float>("position");
    const auto object = bench.pixels<std::uint32_t>("objectId"), gloss = bench.pixels<std::uint32_t>("gloss");
    const auto rays = bench.pixels<std::uint32_t>("rays"), taken = bench.pixels<std::uint32_t>("taken");
    const glm::dvec3 eye = toGlm(bench.own<shared::FrameParams>("frame").eye);
    const scene::Geometry& g = frame.scene().geometry;
    const bvh::Bvh hierarchy = bvh::build({ g.positions, g.indices });
    unsigned lit = 0, hidden = 0, differ = 0, nothing = 0;
    const auto vectorAt = [](const Planes<float>& planes, int x, int y, std::size_t first) {
        return glm::dvec3(planes.at(x, y, first), planes.at(x, y, first + 1), planes.at(x, y, first + 2));
    };
    const auto near = [](const glm::dvec3& a, const glm::dvec3& b) {
        return glm::length(a - b) <= 1e-5 + 2e-4 * glm::length(b); // lobes end at 1e-7 of their peak
    };
    everyPixel(frame.layout, [&](int x, int y) {
        if (object.at(x, y) == 0) {
            ++nothing;
            REQUIRE(taken.at(x, y) == 0);
            REQUIRE(rays.at(x, y) == 0);
            return;
        }
        REQUIRE(taken.at(x, y) == count);
        const glm::dvec3 at = origin.vector(x, y), n = normal.vector(x, y);
        const glm::dvec3 view = glm::normalize(eye - position.vector(x, y));
        const shared::Gloss own = shared::unpackGloss(gloss.at(x, y));
        glm::dvec3 sums[6] = {};
        std::uint32_t traces = 0;
        for (const render::MapLight& light : lights) {
            const glm::dvec3 l = light.towards;
            const double cosine = glm::dot(n, l);
            if (cosine <= 0)
                continue;
            ++traces;
            const bool occluded =
                bvh::anyHit(hierarchy, { toVec3(at), 0, toVec3(l), std::numeric_limits<float>::infinity() });
            (occluded ? hidden : lit) += 1;
            const double weights[] = { 1 / std::numbers::pi, lobe(own, n, view, l), lobe(widened(own), n, view, l) };
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 all = cosine * weights[k] * glm::dvec3(light.irradiance);
                sums[2 * k] += occluded ? glm::dvec3(0) : all;
                sums[2 * k + 1] += all;
            }
        }
        REQUIRE(rays.at(x, y) == traces);
        REQUIRE(near(vectorAt(matt, x, y, 3), sums[1]));
        REQUIRE(near(vectorAt(lobes, x, y, 3), sums[3]));
        REQUIRE(near(vectorAt(lobes, x, y, 9), sums[5]));
        const bool same = near(vectorAt(matt, x, y, 0), sums[0]) && near(vectorAt(lobes, x, y, 0), sums[2])
            && near(vectorAt(lobes, x, y, 6), sums[4]);
        differ += same ? 0 : 1;
    });
    CHECK(lit > 3000);
    CHECK(hidden > 500);
    CHECK(nothing > 20);
    CHECK(differ <= 12); // rays through edges
}

} // namespace

TEST_CASE("shadowLights: what lights bring, and what of it their shadows leave")
{
    onEveryDevice([](const device::Device& device) {
        compare(device, under(scene::SpecularModel::Phong, 40));
        compare(device, under(scene::SpecularModel::BlinnPhong, 90));
        compare(device, under(scene::SpecularModel::Phong, 0.5f)); // wider than lights are apart
    });
}

TEST_CASE("shadowLights: microfacets reflect what the shared maths says")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, under(scene::SpecularModel::Ggx, 1), settings(render::Shadows::Ratio));
        const std::vector<render::MapLight> lights = render::mapLights(*frame.scene().picture(), count);
        Traced traced(frame, lights);
        traced.upTo(count);
        const PassBench& bench = traced.pass;
        const auto lobes = bench.pixels<float>("lobeSums"), normal = bench.pixels<float>("normal");
        const auto position = bench.pixels<float>("position");
        const auto object = bench.pixels<std::uint32_t>("objectId"), gloss = bench.pixels<std::uint32_t>("gloss");
        const glm::dvec3 eye = toGlm(bench.own<shared::FrameParams>("frame").eye);
        std::size_t seen = 0;
        everyPixel(frame.layout, [&](int x, int y) {
            if (object.at(x, y) == 0)
                return;
            const glm::dvec3 n = normal.vector(x, y), view = glm::normalize(eye - position.vector(x, y));
            const shared::Gloss own = shared::unpackMicrofacets(gloss.at(x, y));
            double sums[2] = {};
            for (const render::MapLight& light : lights)
                for (const bool wide : { false, true }) {
                    const glm::dvec3 l = light.towards;
                    const double cosine = std::max(glm::dot(n, l), 0.0);
                    if (cosine > 0)
                        sums[wide ? 1 : 0] += cosine * light.irradiance.y
                            * shared::lobeValue(
                                shared::lobeOf(wide ? widened(own) : own), toVec3(n), toVec3(view), toVec3(l));
                }
            REQUIRE(lobes.at(x, y, 4) == doctest::Approx(sums[0]).epsilon(1e-3));
            REQUIRE(lobes.at(x, y, 10) == doctest::Approx(sums[1]).epsilon(1e-3));
            ++seen;
        });
        CHECK(seen > 800);
    });
}

TEST_CASE("shadowLights: slices of lights have the bits of all at once")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, under(scene::SpecularModel::Phong, 40), settings(render::Shadows::Ratio));
        const std::vector<render::MapLight> lights = render::mapLights(*frame.scene().picture(), count);
        Traced once(frame, lights), twice(frame, lights);
        once.upTo(count);
        twice.upTo(5);
        twice.upTo(count);
        for (const char* name : { "mattSums", "lobeSums" })
            CHECK(sameBits(once.pass.read<float>(name), twice.pass.read<float>(name)));
        CHECK(once.pass.read<std::uint32_t>("rays") == twice.pass.read<std::uint32_t>("rays"));
    });
}
