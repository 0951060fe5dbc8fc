// Whole frames with indirect light or ambient occlusion: what must not change them, what must not be in them, and
// that more samples bring them nearer to the truth.
#include "tests/render_support.h"

#include <algorithm>
#include <functional>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 45, height = 37;

struct Named {
    std::string name;
    render::Settings settings;
};

std::vector<Named> methods(int bounces)
{
    std::vector<Named> out = { { "mc", render::monteCarlo(8) }, { "aaf", render::axisAligned(20) },
        { "published", render::asPublished() }, { "mc of strata", render::monteCarlo(8) } };
    out.back().settings.sampler = render::Sampler::Stratified;
    for (Named& m : out) {
        m.settings = sized(m.settings, width, height);
        m.settings.bounces = bounces;
        m.settings.indirect.maxSpp = 40;
    }
    return out;
}

render::Settings ambient(render::Settings settings)
{
    settings.integrator = render::Integrator::AmbientOcclusion;
    settings.bounces = 0;
    return settings;
}

image::Window all(const render::Settings& settings) { return { 0, 0, settings.width, settings.height }; }

/// What is indirect of the frame of these settings.
std::vector<float> indirectPixels(render::Renderer& renderer, const render::Settings& settings)
{
    renderer.render(settings, {}, true);
    return pixels(renderer, "indirect", all(settings));
}

/// Mean of (a - b)(a - c): for references b and c that err independently, the mean squared error of a alone.
double squaredError(const std::vector<float>& a, const std::vector<float>& b, const std::vector<float>& c)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += (static_cast<double>(a[i]) - b[i]) * (static_cast<double>(a[i]) - c[i]);
    return sum / static_cast<double>(a.size());
}

} // namespace

TEST_CASE("indirect light: repetition, the size of batches and another renderer change no bit; another seed does")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions()), other(scene, device, renderOptions());
        std::vector<Named> frames = methods(2);
        frames.push_back({ "ambient occlusion", ambient(frames[1].settings) });
        for (const Named& m : frames) {
            CAPTURE(m.name);
            renderer.queue().setTargetMilliseconds(100);
            const std::vector<float> first = renderPixels(renderer, m.settings);
            renderer.queue().setTargetMilliseconds(0.01);
            CHECK(sameBits(renderPixels(renderer, m.settings), first));
            CHECK(sameBits(renderPixels(other, m.settings), first));
            render::Settings seeded = m.settings;
            seeded.seed = 1;
            CHECK_FALSE(sameBits(renderPixels(renderer, seeded), first));
        }
    });
}

TEST_CASE("indirect light: any crop has the bits of the whole image")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        const image::Window crops[] = { { 0, 0, 1, 1 }, { width - 1, height - 1, width, height }, { 13, 7, 30, 21 },
            { 33, 0, 34, height }, { 0, 20, width, 21 } };
        std::vector<Named> frames = methods(2);
        frames.push_back({ "ambient occlusion", ambient(frames[1].settings) });
        for (const Named& m : frames) {
            CAPTURE(m.name);
            const std::vector<float> whole = renderPixels(renderer, m.settings);
            for (const image::Window& crop : crops) {
                // Another seed first, so that what is left over from the whole image does not help.
                render::Settings settings = m.settings;
                settings.seed = 77;
                renderer.render(settings);
                settings.seed = m.settings.seed;
                settings.crop = crop;
                renderer.render(settings);
                std::vector<float> expected;
                for (int y = crop.y0; y < crop.y1; ++y)
                    for (int x = crop.x0; x < crop.x1; ++x)
                        for (std::size_t c = 0; c < 3; ++c)
                            expected.push_back(whole[3
                                    * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width)
                                        + static_cast<std::size_t>(x))
                                + c]);
                CAPTURE(crop.x0);
                CAPTURE(crop.y0);
                CHECK(sameBits(pixels(renderer, "beauty", crop), expected));
            }
        }
    });
}

TEST_CASE("indirect light: both families of traversals give the same image within rounding")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Options options = renderOptions();
        options.traversal = render::Traversal::Wide;
        render::Renderer wide(scene, device, options);
        options.traversal = render::Traversal::Scalar;
        render::Renderer scalar(scene, device, options);
        std::vector<Named> frames = methods(3);
        frames.push_back({ "ambient occlusion", ambient(frames[1].settings) });
        for (const Named& m : frames) {
            CAPTURE(m.name);
            const std::vector<float> a = renderPixels(wide, m.settings), b = renderPixels(scalar, m.settings);
            double worst = 0;
            for (std::size_t i = 0; i < a.size(); ++i)
                worst = std::max(worst, std::fabs(static_cast<double>(a[i]) - b[i]) / (0.1 + std::fabs(b[i])));
            CHECK(worst < 1e-4);
        }
    });
}

TEST_CASE("indirect light: aaf without filter and with uniform counts is the plain image of the same samples")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings unfiltered = sized(render::axisAligned(20), width, height);
        unfiltered.filtering = render::Filtering::None;
        unfiltered.sampling = render::Sampling::Uniform;
        unfiltered.shading = render::Shading::Inside;
        render::Settings plain = sized(render::monteCarlo(20), width, height);
        unfiltered.bounces = plain.bounces = 2;
        CHECK(sameBits(indirectPixels(renderer, unfiltered), indirectPixels(renderer, plain)));
        CHECK(sameBits(renderPixels(renderer, ambient(unfiltered)), renderPixels(renderer, ambient(plain))));
        // Direct light finds lights by reflected directions only in plain frames.
        unfiltered.lightSampling = plain.lightSampling = render::LightSampling::Lights;
        CHECK(sameBits(renderPixels(renderer, unfiltered), renderPixels(renderer, plain)));
    });
}

TEST_CASE("indirect light: the error of the filtered image falls with the samples, and is below the plain one's")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = scene::loadScene(WEDGE_SOURCE_DATA "/scenes/cornell.toml");
        render::Renderer renderer(scene, device, renderOptions());
        const auto frame = [&](render::Settings settings, std::uint32_t seed) {
            settings.bounces = 2;
            settings.seed = seed;
            return indirectPixels(renderer, sized(settings, 64, 64));
        };
        const std::vector<float> reference = frame(render::monteCarlo(256), 11),
                                 second = frame(render::monteCarlo(256), 12);
        const auto error = [&](const render::Settings& settings) {
            return std::sqrt(std::max(0.0, squaredError(frame(settings, 3), reference, second)));
        };
        const double coarse = error(render::axisAligned(16)), middle = error(render::axisAligned(64)),
                     fine = error(render::axisAligned(256)), plain = error(render::monteCarlo(16));
        MESSAGE("RMS error of 16, 64, 256 filtered samples: " << coarse << ", " << middle << ", " << fine
                                                              << "; of 16 plain ones: " << plain);
        CHECK(middle < 0.8 * coarse);
        CHECK(fine < 0.8 * middle);
        CHECK(coarse < 0.5 * plain);
    });
}

TEST_CASE(
    "ambient occlusion shows how open surfaces are, on white, whatever their material and light; the rest is black")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = richScene();
        scene.materials[0].emission = { 3, 3, 3 };
        // A light that the camera could see, and would not see through.
        scene.areaLights[1].centre = { -0.3f, 0.9f, 1.2f };
        scene.areaLights[1].visible = true;
        render::Renderer renderer(scene, device, renderOptions());
        scene::Scene dark = richScene();
        dark.areaLights.clear();
        render::Renderer without(dark, device, renderOptions());
        for (const render::Settings& method : { render::monteCarlo(24), render::axisAligned(24) }) {
            const render::Settings settings = ambient(sized(method, width, height));
            renderer.render(settings, {}, true);
            const render::Frame& f = renderer.frame();
            const std::vector<float> beauty = pixels(renderer, "beauty", all(settings)),
                                     open = pixels(renderer, "indirect", all(settings));
            const std::vector<std::uint32_t> id = f.counts("objectId").downloadAll(renderer.queue());
            unsigned surfaces = 0, holes = 0, shaded = 0;
            double sum = 0;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    const std::size_t i = 3
                        * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
                    const bool surface = id[shared::pixelIndex(static_cast<std::uint32_t>(x),
                                             static_cast<std::uint32_t>(y), f.layout.stride)]
                        != 0;
                    (surface ? surfaces : holes) += 1;
                    shaded += surface && beauty[i] < 0.9f ? 1 : 0;
                    sum += beauty[i];
                    for (std::size_t c = 0; c < 3; ++c) {
                        REQUIRE(beauty[i + c] == (surface ? open[i] : 0.0f));
                        REQUIRE(beauty[i + c] >= 0.0f);
                        REQUIRE(beauty[i + c] <= 1.0f + 1e-6f);
                    }
                }
            CHECK(beauty == renderPixels(without, settings));
            CHECK(surfaces > 500);
            CHECK(holes > 50);
            CHECK(shaded > 100);
            CHECK(sum / surfaces > 0.6);
        }
    });
}

TEST_CASE("without lights all stays exactly 0, with any method and number of bounces")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = richScene();
        scene.areaLights.clear();
        scene.pointLights.clear();
        scene.directionalLights.clear();
        scene.background = glm::vec3(0);
        render::Renderer renderer(scene, device, renderOptions());
        for (const int bounces : { 1, 3 })
            for (const Named& m : methods(bounces)) {
                CAPTURE(m.name);
                CHECK(std::ranges::all_of(renderPixels(renderer, m.settings), [](float v) { return v == 0.0f; }));
            }
    });
}

TEST_CASE("paths through scenes that a renderer may stumble over bring back numbers, none negative")
{
    struct Nasty {
        std::string name;
        scene::Scene scene;
    };
    const auto change = [](const std::function<void(scene::Scene&)>& what) {
        scene::Scene scene = richScene();
        what(scene);
        return scene;
    };
    std::vector<Nasty> scenes;
    scenes.push_back({ "nothing at all", SceneBuilder().scene });
    SceneBuilder degenerate;
    degenerate.scene = richScene();
    degenerate.triangle({ 0, 1, 0 }, { 0, 1, 0 }, { 0, 1, 0 });
    degenerate.triangle({ -1, 1, 0 }, { 0, 1, 0 }, { 1, 1, 0 });
    degenerate.triangle({ -1, 1.2f, 0 }, { 1, 1.2f, 0 }, { 1, 1.2000001f, 0 });
    degenerate.triangle({ -1e6f, -1, -1e6f }, { 1e6f, -1, -1e6f }, { 0, -1, 1e6f });
    scenes.push_back({ "triangles without area, and an enormous one", degenerate.scene });
    for (const float size : { 1e-6f, 1e6f })
        scenes.push_back({ size < 1 ? "tiny" : "huge", change([&](scene::Scene& s) {
                              for (float& v : s.geometry.positions)
                                  v *= size;
                              for (scene::AreaLight& light : s.areaLights) {
                                  light.centre *= size;
                                  light.halfU *= size;
                                  light.halfV *= size;
                              }
                              s.pointLights[0].position *= size;
                              s.camera.eye *= size;
                              s.camera.lookAt *= size;
                          }) });
    scenes.push_back({ "light in the floor", change([](scene::Scene& s) {
                          s.areaLights[0].centre.y = 0;
                          s.areaLights[1].centre.y = 0;
                          s.areaLights[1].halfU = { 0, 0.5f, 0 };
                      }) });
    scenes.push_back({ "light at the camera, and a point light on the floor", change([](scene::Scene& s) {
                          s.areaLights[0].centre = s.camera.eye;
                          s.pointLights[0].position = { 0, 0, 0 };
                      }) });
    for (const scene::SpecularModel model : { scene::SpecularModel::Phong, scene::SpecularModel::BlinnPhong })
        scenes.push_back({ "gloss without and with a sharp lobe, and with nothing else", change([&](scene::Scene& s) {
                              s.materials.push_back(s.materials[0]);
                              for (scene::Material& m : s.materials) {
                                  m.specularModel = model;
                                  m.specular = glm::vec3(0.9f);
                              }
                              s.materials[0].exponent = 0;
                              s.materials[1].exponent = 1e4f;
                              s.materials[1].diffuse = glm::vec3(0);
                              for (std::size_t i = 0; i < s.geometry.materialIds.size(); i += 2)
                                  s.geometry.materialIds[i] = 1;
                          }) });
    onEveryDevice([&](const device::Device& device) {
        for (const Nasty& nasty : scenes) {
            CAPTURE(nasty.name);
            render::Renderer renderer(nasty.scene, device, renderOptions());
            for (const Named& m : methods(3))
                for (const render::Settings& settings :
                    { sized(m.settings, 21, 16), ambient(sized(m.settings, 1, 1)) }) {
                    CAPTURE(m.name);
                    renderer.render(settings, {}, true);
                    const std::vector<float> beauty = pixels(renderer, "beauty", all(settings));
                    CHECK(notFinite(beauty) == 0);
                    CHECK(std::ranges::all_of(beauty, [](float v) { return v >= 0; }));
                    CHECK(notFinite(pixels(renderer, "indirect", all(settings))) == 0);
                    CHECK(notFinite(pixels(renderer, "indirectNoisy", all(settings))) == 0);
                    for (const std::string& term : termsOf(renderer))
                        CHECK(notFinite(widthsOf(renderer, term)) == 0);
                }
        }
    });
}
