// Whole frames whose filters of lights follow gradients, and the scores that these are made of.
#include "effects/area_lights/soft_shadows.h"
#include "host/render/direct_lights.h"
#include "tests/slats_scene.h"

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 96, height = 72;

} // namespace

TEST_CASE("with as many samples, filters that follow gradients are ahead, of lights with and without edges")
{
    onEveryDevice([](const device::Device& device) {
        for (const auto profile : { scene::LightProfile::Gaussian, scene::LightProfile::Uniform }) {
            CAPTURE(static_cast<int>(profile));
            const scene::Scene scene = slats(profile);
            render::Renderer renderer(scene, device, renderOptions());
            render::Settings truth = sized(render::monteCarlo(8192), width, height);
            truth.seed = 99;
            const std::vector<float> reference = renderPixels(renderer, truth);
            for (const int spp : { 16, 64 }) {
                render::Settings s = sized(render::axisAligned(spp), width, height);
                const double sheared = errorOf(renderer, s, reference);
                s.sheared = false;
                const double plain = errorOf(renderer, s, reference);
                MESSAGE("RMSE of ", spp, " samples: ", sheared, ", without gradients ", plain);
                CHECK(sheared < (spp == 16 ? 0.9 : 1.0) * plain);
            }
        }
    });
}

TEST_CASE("gradients are not taken where nothing is there to take them of")
{
    render::Settings s = render::axisAligned(28);
    CHECK(render::isSheared(s));
    s.filtering = render::Filtering::Fixed;
    CHECK_FALSE(render::isSheared(s));
    s = render::axisAligned(28);
    s.shading = render::Shading::Inside;
    CHECK_FALSE(render::isSheared(s));
    CHECK_FALSE(render::isSheared(render::asPublished()));
    CHECK_FALSE(render::isSheared(render::monteCarlo(28)));
}

TEST_CASE("counts from the spectrum are what mu says, however wide filters are")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = slats(scene::LightProfile::Gaussian);
        render::Renderer renderer(scene, device, renderOptions());
        const auto samples = [&](render::Settings s) {
            s.counts = render::Counts::Spectrum;
            return renderer.render(sized(s, width, height)).shadowRays;
        };
        render::Settings plain = render::axisAligned(28);
        plain.sheared = false;
        const auto expected = samples(plain);
        CHECK(expected > 10ULL * width * height); // more than the first pass
        CHECK(samples(render::axisAligned(28)) == expected);
        CHECK(samples(render::multipleAxisAligned(render::Maaf::TwoSlope)) == expected);
    });
}

TEST_CASE("a score has the first moment 1 over its light, and goes by coordinates of axes at any angle")
{
    const auto near = [](double a, double b) { return std::fabs(a - b) < 2e-3; };
    for (const float cut : { 1.0f, 2.0f, 3.0f, 6.0f })
        for (const auto profile : { WEDGE_PROFILE_GAUSSIAN, WEDGE_PROFILE_UNIFORM }) {
            CAPTURE(cut);
            CAPTURE(profile);
            shared::AreaLight light {};
            light.profile = profile;
            light.cut = cut;
            light.halfU = shared::vec3(0.4f, 0, 0.1f);
            light.halfV = shared::vec3(0.2f, 0, 0.3f);
            light.centre = shared::vec3(1, 2, 3);
            const render::ProfileScore found = render::scoreOf(light);
            double mass = 0, moment = 0;
            for (int i = 0; i < 20000; ++i) {
                const float a = (static_cast<float>(i) + 0.5f) / 10000.0f - 1.0f;
                const double l = shared::lightProfile(a, 0, profile, cut);
                mass += l;
                moment += l * a * shared::scoreOf(found.score, a);
            }
            CHECK(near(moment / mass, 1.0));
            CHECK(near(shared::vecDot(found.score.alongU, light.halfU), 1.0));
            CHECK(near(shared::vecDot(found.score.alongU, light.halfV), 0.0));
            CHECK(near(shared::vecDot(found.score.alongV, light.halfU), 0.0));
            CHECK(near(shared::vecDot(found.score.alongV, light.halfV), 1.0));
            // Within the light a Gaussian's score is that of one that is not cut.
            if (profile == WEDGE_PROFILE_GAUSSIAN)
                CHECK(near(shared::scoreOf(found.score, 0.1f) / (0.1 * cut * cut), 1.0));
            CHECK(found.edge >= 0.0f);
            CHECK(found.edge <= 1.0f);
            CHECK((profile == WEDGE_PROFILE_UNIFORM ? found.edge == 1.0f : found.edge < 0.75f));
        }
}

TEST_CASE("filters narrow where a light's deviation blurs shadows over many pixels")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = slats(scene::LightProfile::Gaussian);
        render::Renderer renderer(scene, device, renderOptions());
        const auto widthsOf = [&](render::Settings s) {
            s.sampling = render::Sampling::Uniform; // so that counts change nothing
            s.widening = 0;
            renderer.render(s, {}, true);
            return test::widthsOf(renderer, termsOf(renderer).front());
        };
        render::Settings s = sized(render::axisAligned(28), width, height);
        s.wideBlur = 1e9f;
        const std::vector<float> wide = widthsOf(s);
        s.wideBlur = 4;
        const std::vector<float> narrow = widthsOf(s),
                                 size = renderer.frame().planes("pixelSize").downloadAll(renderer.queue());
        const shared::AreaLight light = render::directLights(scene).own.front().onDevice();
        const double mu = s.mu * (1 + 0.5 * render::scoreOf(light).edge) / s.shearedWidth;
        int narrowed = 0, same = 0;
        for (std::size_t i = 0; i < wide.size(); ++i) {
            if (!(wide[i] > 0))
                continue;
            const double blur = wide[i] * s.k * mu / size[i];
            REQUIRE(narrow[i] / wide[i] == doctest::Approx(std::min(1.0, std::pow(4 / blur, 0.4))).epsilon(1e-3));
            ++(blur > 4 ? narrowed : same);
        }
        CHECK(narrowed > 100);
        CHECK(same > 100);
    });
}
