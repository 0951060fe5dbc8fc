// chosenLights of shadow_lights.cl alone: the lights that bring a pixel most, and what is hidden of them, against the
// host in double, and against shadowLights where all are chosen.
#include "bvh/host_traverse.h"
#include "tests/shadow_lights_support.h"

#include <algorithm>
#include <limits>

using namespace wedge;
using namespace wedge::test;
using namespace wedge::test::shadows;

namespace {

render::Settings choosing(int chosen)
{
    render::Settings s = settings(render::Shadows::Ratio);
    s.environment.shadows.chosen = chosen;
    return s;
}

/// Of a light at a pixel.
struct Gain {
    double gain = 0;
    glm::dvec3 matt { 0 }, lobe { 0 };
    bool occluded = false;
};

/// Of all light, of which a part is known, and how much of that is seen: the rest is hidden by as much, times
/// twice the part.
glm::dvec3 leftOf(const glm::dvec3& all, const glm::dvec3& part, const glm::dvec3& seen)
{
    const glm::dvec3 hidden = (part - seen) / glm::max(part, glm::dvec3(1e-30));
    const glm::dvec3 known = glm::min(2.0 * part / glm::max(all, glm::dvec3(1e-30)), glm::dvec3(1));
    return seen + (1.0 - known * hidden) * (all - part);
}

} // namespace

TEST_CASE("chosenLights: rays go to the lights that bring most, and say what is hidden of the others")
{
    onEveryDevice([](const device::Device& device) {
        constexpr std::size_t most = 3;
        DeclaredFrame frame(device, under(scene::SpecularModel::Phong, 40), choosing(most));
        const std::vector<render::MapLight> lights = render::mapLights(*frame.scene().picture(), count);
        Traced traced(frame, lights, "chosenLights");
        const PassBench& bench = traced.pass;
        traced.all();
        const auto matt = bench.pixels<float>("mattSums"), lobes = bench.pixels<float>("lobeSums");
        const auto origin = bench.pixels<float>("origin"), normal = bench.pixels<float>("normal");
        const auto position = bench.pixels<float>("position"), diffuse = bench.pixels<float>("diffuse");
        const auto specular = bench.pixels<float>("specular");
        const auto object = bench.pixels<std::uint32_t>("objectId"), gloss = bench.pixels<std::uint32_t>("gloss");
        const auto rays = bench.pixels<std::uint32_t>("rays"), taken = bench.pixels<std::uint32_t>("taken");
        const glm::dvec3 eye = toGlm(bench.own<shared::FrameParams>("frame").eye);
        const scene::Geometry& g = frame.scene().geometry;
        const bvh::Bvh hierarchy = bvh::build({ g.positions, g.indices });
        const auto vectorAt = [](const Planes<float>& planes, int x, int y, std::size_t first) {
            return glm::dvec3(planes.at(x, y, first), planes.at(x, y, first + 1), planes.at(x, y, first + 2));
        };
        const auto bright = [](const glm::dvec3& c) { return glm::dot(c, glm::dvec3(0.2126, 0.7152, 0.0722)); };
        const auto near = [](const glm::dvec3& a, const glm::dvec3& b) {
            return glm::length(a - b) <= 1e-5 + 3e-4 * glm::length(b);
        };
        unsigned hidden = 0, differ = 0, left = 0, seen = 0;
        everyPixel(frame.layout, [&](int x, int y) {
            if (object.at(x, y) == 0) {
                REQUIRE(taken.at(x, y) == 0);
                return;
            }
            REQUIRE(taken.at(x, y) == count);
            const glm::dvec3 at = origin.vector(x, y), n = normal.vector(x, y);
            const glm::dvec3 view = glm::normalize(eye - position.vector(x, y));
            const shared::Gloss own = shared::unpackGloss(gloss.at(x, y));
            std::vector<Gain> all;
            glm::dvec3 mattSum(0), lobeSum(0);
            for (const render::MapLight& light : lights) {
                const glm::dvec3 l = light.towards, e = light.irradiance;
                const double cosine = glm::dot(n, l);
                if (cosine <= 0)
                    continue;
                Gain gain;
                gain.matt = cosine / std::numbers::pi * e;
                gain.lobe = cosine * lobe(own, n, view, l) * e;
                const double wide = cosine * lobe(widened(own), n, view, l) * bright(e);
                gain.gain = bright(diffuse.vector(x, y)) * bright(gain.matt)
                    + bright(specular.vector(x, y)) * (bright(gain.lobe) + 0.02 * wide);
                gain.occluded =
                    bvh::anyHit(hierarchy, { toVec3(at), 0, toVec3(l), std::numeric_limits<float>::infinity() });
                mattSum += gain.matt;
                lobeSum += gain.lobe;
                all.push_back(gain);
            }
            std::ranges::sort(all, std::greater {}, &Gain::gain);
            REQUIRE(rays.at(x, y) == std::min(most, all.size()));
            glm::dvec3 mattPart(0), lobePart(0), mattSeen(0), lobeSeen(0);
            for (std::size_t k = 0; k < std::min(most, all.size()); ++k) {
                hidden += all[k].occluded ? 1 : 0;
                mattPart += all[k].matt;
                lobePart += all[k].lobe;
                mattSeen += all[k].occluded ? glm::dvec3(0) : all[k].matt;
                lobeSeen += all[k].occluded ? glm::dvec3(0) : all[k].lobe;
            }
            left += all.size() > most ? 1 : 0;
            const glm::dvec3 mattLeft = leftOf(mattSum, mattPart, mattSeen),
                             lobeLeft = leftOf(lobeSum, lobePart, lobeSeen);
            REQUIRE(near(vectorAt(matt, x, y, 3), mattSum));
            REQUIRE(near(vectorAt(lobes, x, y, 3), lobeSum));
            const bool same = near(vectorAt(matt, x, y, 0), mattLeft) && near(vectorAt(lobes, x, y, 0), lobeLeft);
            differ += same ? 0 : 1;
            ++seen;
        });
        CHECK(seen > 800);
        CHECK(hidden > 100);
        CHECK(left > 500); // pixels with lights that have no ray
        CHECK(differ <= 12); // rays through edges, and lights that bring as much
    });
}

TEST_CASE("chosenLights: with all of them it is shadowLights, within rounding")
{
    onEveryDevice([](const device::Device& device) {
        for (const scene::SpecularModel model : { scene::SpecularModel::Phong, scene::SpecularModel::Ggx }) {
            DeclaredFrame some(device, under(model, 40), choosing(count)), plain(device, under(model, 40), choosing(0));
            const std::vector<render::MapLight> lights = render::mapLights(*some.scene().picture(), count);
            Traced chosen(some, lights, "chosenLights"), all(plain, lights);
            chosen.all();
            all.upTo(count);
            for (const char* name : { "mattSums", "lobeSums" }) {
                const std::vector<float> a = chosen.pass.read<float>(name), b = all.pass.read<float>(name);
                REQUIRE(a.size() == b.size());
                const float largest = *std::ranges::max_element(b);
                double most = 0;
                for (std::size_t i = 0; i < a.size(); ++i)
                    most = std::max(most, std::abs(double { a[i] } - b[i]));
                CHECK(largest > 0);
                CHECK(most <= 1e-5 * largest);
            }
        }
    });
}

TEST_CASE("chosenLights: pixels that have taken all stay as they are")
{
    onEveryDevice([](const device::Device& device) {
        DeclaredFrame frame(device, under(scene::SpecularModel::Phong, 40), choosing(2));
        Traced traced(frame, render::mapLights(*frame.scene().picture(), count), "chosenLights");
        std::vector<std::uint32_t> taken(frame.layout.size, count);
        for (std::size_t i = 0; i < taken.size(); i += 3)
            taken[i] = 0;
        std::mt19937 random(5);
        const std::vector<float> before = someNumbers(random, 6 * frame.layout.size);
        traced.pass.plane("taken", taken);
        traced.pass.plane("mattSums", before);
        traced.all();
        const std::vector<float> after = traced.pass.read<float>("mattSums");
        const std::vector<std::uint32_t> object = traced.pass.read<std::uint32_t>("objectId"),
                                         rays = traced.pass.read<std::uint32_t>("rays");
        std::size_t made = 0;
        for (std::size_t i = 0; i < taken.size(); ++i) {
            const bool open = taken[i] == 0 && object[i] != 0;
            REQUIRE((open || rays[i] == 0));
            for (std::size_t plane = 0; plane < 6 && !open; ++plane)
                REQUIRE(after[plane * taken.size() + i] == before[plane * taken.size() + i]);
            made += open && rays[i] > 0 ? 1 : 0;
        }
        CHECK(made > 200);
    });
}
