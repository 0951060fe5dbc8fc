// Whole frames of method maaf.
#include "effects/area_lights/maaf.h"
#include "tests/slats_scene.h"

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 64, height = 48;

render::Settings ofMaaf(render::Maaf maaf, int spp, int components = 5)
{
    render::Settings s = sized(render::multipleAxisAligned(maaf, spp), width, height);
    s.components = components;
    return s;
}

} // namespace

TEST_CASE("filters of both slopes err less than plain sampling, and less than one filter without gradients")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = slats(scene::LightProfile::Gaussian);
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings truth = sized(render::monteCarlo(8192), width, height);
        truth.seed = 99;
        const std::vector<float> reference = renderPixels(renderer, truth);
        for (const int spp : { 9, 28 }) {
            const auto of = [&](const render::Settings& s) { return errorOf(renderer, s, reference); };
            render::Settings one = sized(render::axisAligned(spp), width, height);
            const double aaf = of(one);
            one.sheared = false;
            const double without = of(one), plain = of(sized(render::monteCarlo(spp), width, height)),
                         both = of(ofMaaf(render::Maaf::TwoSlope, spp));
            MESSAGE(spp, " samples: ", both, ", aaf ", aaf, ", without gradients ", without, ", unfiltered ", plain);
            CHECK(both < (spp == 9 ? 0.8 : 0.5) * plain);
            // Nine tell slopes and widths of so small an image poorly.
            if (spp == 28) {
                CHECK(both < without);
                CHECK(both < 1.03 * aaf); // 0.985 with these seeds
            }
        }
    });
}

TEST_CASE("refitted, seven components differ from five by less than five from three")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = slats(scene::LightProfile::Gaussian);
        render::Renderer renderer(scene, device, renderOptions());
        std::vector<std::vector<float>> images;
        for (const int components : { 3, 5, 7 }) {
            render::Settings s = ofMaaf(render::Maaf::Refitted, 9, components);
            s.fallback = false;
            images.push_back(renderPixels(renderer, s));
        }
        render::Settings plain = sized(render::monteCarlo(9), width, height);
        const double far = rmse(images[0], images[1]), near = rmse(images[1], images[2]);
        MESSAGE("three and five differ by ", far, ", five and seven by ", near);
        CHECK(near < far);
        CHECK(near > 0);
        CHECK(rmse(images[1], renderPixels(renderer, plain)) > near);
    });
}

TEST_CASE("lights that are not Gaussian, and frames through a lens, are those of method aaf, bit by bit")
{
    onEveryDevice([](const device::Device& device) {
        for (const render::Maaf maaf : { render::Maaf::TwoSlope, render::Maaf::Printed }) {
            scene::Scene scene = slats(scene::LightProfile::Uniform);
            render::Renderer renderer(scene, device, renderOptions());
            const render::Settings aaf = sized(render::axisAligned(16), width, height);
            CHECK(renderPixels(renderer, ofMaaf(maaf, 16)) == renderPixels(renderer, aaf));
            scene = slats(scene::LightProfile::Gaussian);
            render::Renderer gaussian(scene, device, renderOptions());
            render::Settings several = ofMaaf(maaf, 16), one = aaf;
            CHECK(renderPixels(gaussian, several) != renderPixels(gaussian, one));
            several.antialias = one.antialias = true;
            CHECK(renderPixels(gaussian, several) == renderPixels(gaussian, one));
        }
    });
}

TEST_CASE("Gaussians that are cut until they are uniform in all but name are those of method aaf, bit by bit")
{
    onEveryDevice([](const device::Device& device) {
        for (const float cut : { 0.2f, 1.0f }) {
            scene::Scene scene = slats(scene::LightProfile::Gaussian);
            scene.areaLights.at(0).cut = cut;
            render::Renderer renderer(scene, device, renderOptions());
            const std::vector<float> aaf = renderPixels(renderer, sized(render::axisAligned(16), width, height));
            for (const render::Maaf maaf : { render::Maaf::TwoSlope, render::Maaf::Refitted })
                CHECK(renderPixels(renderer, ofMaaf(maaf, 16)) == aaf);
        }
    });
}

TEST_CASE("where a light has several filters")
{
    shared::AreaLight light {};
    light.profile = WEDGE_PROFILE_GAUSSIAN;
    light.halfU = shared::vec3(1, 0, 0);
    light.halfV = shared::vec3(0, 0, 1);
    light.cut = 2;
    render::Settings s = render::multipleAxisAligned(render::Maaf::Refitted);
    CHECK(render::methodName(s) == "maaf");
    CHECK(render::maafOf(s, light) == render::Maaf::Refitted);
    light.cut = 3; // components over such a profile are without bound
    CHECK_FALSE(render::maafOf(s, light));
    s.maaf = render::Maaf::TwoSlope;
    CHECK(render::maafOf(s, light) == render::Maaf::TwoSlope);
    light.cut = 1.4f; // nearly half of its slope is in steps
    CHECK_FALSE(render::maafOf(s, light));
    light.cut = 1.5f;
    CHECK(render::maafOf(s, light) == render::Maaf::TwoSlope);
    s.shading = render::Shading::Inside;
    CHECK_FALSE(render::maafOf(s, light));
    s = render::multipleAxisAligned(render::Maaf::TwoSlope);
    s.filtering = render::Filtering::Fixed;
    CHECK_FALSE(render::maafOf(s, light));
    CHECK_FALSE(render::maafOf(render::axisAligned(), light));
    CHECK(render::methodName(render::axisAligned()) == "aaf");
    s.components = 4;
    CHECK_THROWS(render::validate(s, false));
}

TEST_CASE("what filters of both slopes and components have of their own")
{
    const render::Settings s = render::multipleAxisAligned(render::Maaf::TwoSlope);
    const render::Narrowing one = render::narrowingOf(s, {}), both = render::narrowingOf(s, render::Maaf::TwoSlope),
                            components = render::narrowingOf(s, render::Maaf::Refitted);
    CHECK(one.wideBlur == s.wideBlur);
    CHECK(one.blurPower == s.wideBlurExponent);
    CHECK(one.countPower == s.countWidth);
    CHECK(both.wideBlur == 8); // docs/maaf.md
    CHECK(both.blurPower == 0.5f);
    CHECK(both.countPower == s.countWidth);
    CHECK(components.countPower == 0);
    CHECK(components.blurPower == 0);
    for (const auto& maaf : { std::optional<render::Maaf> {}, std::optional(render::Maaf::TwoSlope) }) {
        CHECK(render::slopeWindowOf(maaf).eroded);
        CHECK(render::slopeWindowOf(maaf).radius == 1);
    }
    CHECK_FALSE(render::slopeWindowOf(render::Maaf::Printed).eroded); // the paper's 5 x 5
    CHECK(render::slopeWindowOf(render::Maaf::Printed).radius == 2);
    CHECK(render::withComponents({}).normalCosine == doctest::Approx(std::cos(std::acos(-1.0) / 9)));
}

TEST_CASE("frames are filtered with these")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = slats(scene::LightProfile::Gaussian);
        // The ground's normals, of the first six vertices, turn from corner to corner.
        for (std::size_t i = 0; i < 18; i += 3) {
            const glm::vec3 at(scene.geometry.positions.at(i), 200, scene.geometry.positions.at(i + 2));
            const glm::vec3 normal = glm::normalize(at);
            for (int axis = 0; axis < 3; ++axis) {
                scene.geometry.normals.at(i + static_cast<std::size_t>(axis)) = normal[axis];
            }
        }
        render::Renderer renderer(scene, device, renderOptions());
        // Settings::wideBlur is of method aaf alone, countWidth of filters of both slopes, too.
        const auto changed = [&](render::Settings s, bool byCounts) {
            const std::vector<float> usual = renderPixels(renderer, s);
            (byCounts ? s.countWidth : s.wideBlur) = byCounts ? 2.0f : 0.1f;
            return renderPixels(renderer, s) != usual;
        };
        const render::Settings aaf = sized(render::axisAligned(16), width, height);
        for (const bool byCounts : { false, true }) {
            CHECK(changed(aaf, byCounts));
            CHECK(changed(ofMaaf(render::Maaf::TwoSlope, 16), byCounts) == byCounts);
        }
        // What normals other filters take is nothing to components; counts are analysed with those, though.
        render::Settings strict = ofMaaf(render::Maaf::Refitted, 16, 3);
        strict.sampling = render::Sampling::Uniform;
        const std::vector<float> usual = renderPixels(renderer, strict);
        strict.normalDegrees = 1e-3f;
        CHECK(renderPixels(renderer, strict) == usual);
        strict.maaf = render::Maaf::TwoSlope;
        const std::vector<float> ofStrict = renderPixels(renderer, strict);
        strict.normalDegrees = 10;
        CHECK(renderPixels(renderer, strict) != ofStrict);
    });
}
