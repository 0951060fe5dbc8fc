// What must not change an image: repetition, batches, crops, the company of other lights.
#include "host/render/progressive.h"
#include "tests/render_support.h"

#include <algorithm>
#include <atomic>
#include <numeric>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 75, height = 53;

struct Named {
    std::string name;
    render::Settings settings;
};

std::vector<Named> methods()
{
    std::vector<Named> out = { { "mc", render::monteCarlo(13) }, { "aaf", render::axisAligned(16) },
        { "published", render::asPublished() }, { "maaf", render::multipleAxisAligned(render::Maaf::TwoSlope, 16) },
        { "three components", render::multipleAxisAligned(render::Maaf::Printed, 16) },
        { "five components", render::multipleAxisAligned(render::Maaf::Refitted, 16) } };
    out[4].settings.components = 3;
    for (Named& m : out)
        m.settings = sized(m.settings, width, height);
    return out;
}

std::size_t pixelAt(int x, int y) { return static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x); }

} // namespace

TEST_CASE("two runs, other frames in between, and another renderer give the same bits")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions()), other(scene, device, renderOptions());
        for (const Named& m : methods()) {
            CAPTURE(m.name);
            const std::vector<float> first = renderPixels(renderer, m.settings);
            render::Settings different = sized(render::axisAligned(40), 33, 90);
            different.seed = 4;
            renderer.render(different);
            CHECK(sameBits(renderPixels(renderer, m.settings), first));
            CHECK(sameBits(renderPixels(other, m.settings), first));
            render::Settings seeded = m.settings;
            seeded.seed = 1;
            CHECK_FALSE(sameBits(renderPixels(renderer, seeded), first));
        }
    });
}

TEST_CASE("a frame is declared and planned once, however often it is asked for, and has the same bits each time")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(richScene(), device, renderOptions());
        std::vector<Named> kinds = methods();
        kinds.push_back({ "antialiased", sized(render::axisAligned(16), width, height) });
        kinds.back().settings.antialias = true;
        std::size_t frames = 0;
        for (const Named& m : kinds) {
            CAPTURE(m.name);
            const std::uint64_t bytes = renderer.planUnbacked(m.settings).total();
            CHECK(renderer.plan(m.settings).total() == bytes);
            CHECK(renderer.framesCompiled() == ++frames);
            renderer.rehearse(m.settings);
            CHECK(!renderer.explain(m.settings).text.empty());
            const std::vector<float> first = renderPixels(renderer, m.settings);
            for (const double fraction :
                { 0.0, 0.3, 0.7 }) { // stopped there, it leaves nothing behind for the next one
                std::atomic<bool> cancelled { fraction == 0.0 };
                render::Control control;
                control.cancel = &cancelled;
                control.progress = [&](double done) { cancelled = cancelled || done > fraction; };
                renderer.render(m.settings, control);
                CHECK(sameBits(first, renderPixels(renderer, m.settings)));
            }
            CHECK(renderer.render(m.settings).memoryBytes == bytes);
            CHECK(renderer.framesCompiled() == frames);
            // Another crop is another frame.
            render::Settings part = m.settings;
            part.crop = { 8, 8, 40, 40 };
            renderer.render(part);
            renderer.render(part, {}, true);
            CHECK(renderer.framesCompiled() == (frames += 2));
        }
        // And so is every step of a progressive one.
        render::Settings steps = sized(render::axisAligned(64), width, height);
        steps.progressive = true;
        std::size_t shown = 0;
        renderer.renderProgressively(steps, {}, [&](const render::ProgressiveStep&) { ++shown; });
        CHECK(shown > 1);
        CHECK(renderer.framesCompiled() == frames + shown);
    });
}

TEST_CASE("a scene that is changed has what follows from it anew")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene before = richScene();
        scene::Scene after = before;
        after.areaLights.pop_back();
        after.camera.eye.x += 0.3f;
        const render::Settings settings = sized(render::axisAligned(16), width, height);
        render::Renderer changed(before, device, renderOptions()), fresh(after, device, renderOptions());
        renderPixels(changed, settings);
        const std::shared_ptr<const render::EnvironmentTable> beyond = changed.scene().lights().beyond;
        CHECK(changed.scene().directLights().own.size() == 2);
        changed.changeScene({ .lights = true }, [&](scene::Scene& scene) {
            scene.areaLights = after.areaLights;
            scene.camera = after.camera;
        });
        CHECK(changed.scene().directLights().own.size() == 1);
        CHECK(sameBits(renderPixels(changed, settings), renderPixels(fresh, settings)));
        CHECK(changed.scene().lights().beyond == beyond); // of what did not change
    });
}

TEST_CASE("the size of batches and a rehearsal change nothing")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions()), rehearsed(scene, device, renderOptions());
        for (const Named& m : methods()) {
            CAPTURE(m.name);
            renderer.queue().setTargetMilliseconds(100);
            const std::vector<float> expected = renderPixels(renderer, m.settings);
            renderer.queue().setTargetMilliseconds(0.01);
            CHECK(sameBits(renderPixels(renderer, m.settings), expected));
            rehearsed.rehearse(m.settings);
            CHECK(sameBits(renderPixels(rehearsed, m.settings), expected));
        }
    });
}

TEST_CASE("nothing shows of what lay in the memory before")
{
    // Planes that are not needed at the same time share memory: what a pass reads and nobody has written would be a
    // not-a-number here, and whatever was there before elsewhere.
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Options poisoned = renderOptions();
        poisoned.poison = true;
        render::Renderer renderer(scene, device, renderOptions()), other(scene, device, poisoned);
        std::vector<Named> frames = methods();
        for (const Named& m : methods()) {
            frames.push_back({ m.name + ", indirect", m.settings });
            frames.back().settings.bounces = 2;
            frames.push_back({ m.name + ", ambient occlusion", m.settings });
            frames.back().settings.integrator = render::Integrator::AmbientOcclusion;
        }
        frames.push_back({ "unfiltered", methods()[1].settings });
        frames.back().settings.filtering = render::Filtering::None;
        frames.back().settings.bounces = 1;
        frames.push_back({ "uniform counts", methods()[1].settings });
        frames.back().settings.sampling = render::Sampling::Uniform;
        for (const char* whole : { "mc, ambient occlusion", "aaf, indirect" }) {
            const auto found = std::ranges::find(frames, whole, &Named::name);
            REQUIRE(found != frames.end());
            Named cropped { found->name + ", crop", found->settings };
            cropped.settings.crop = { 21, 9, 50, 31 };
            frames.push_back(cropped);
        }
        for (const Named& frame : frames) {
            CAPTURE(frame.name);
            const image::Window window = render::outputWindow(frame.settings);
            const auto planes = [&](render::Renderer& by) {
                by.render(frame.settings, {}, true);
                std::vector<float> out;
                for (const char* plane : { "beauty", "direct", "directNoisy", "indirect", "indirectNoisy" }) {
                    const std::vector<float> shown = pixels(by, plane, window);
                    out.insert(out.end(), shown.begin(), shown.end());
                }
                return out;
            };
            CHECK(sameBits(planes(other), planes(renderer)));
        }
    });
}

TEST_CASE("a frame that is stopped anywhere has no pixel that is no number")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Options poisoned = renderOptions();
        poisoned.poison = true;
        render::Renderer renderer(scene, device, poisoned);
        for (const Named& m : methods()) {
            render::Settings settings = m.settings;
            settings.bounces = 1;
            int looks = 0;
            std::atomic<bool> cancel { false };
            const auto rendered = [&](int last) {
                cancel = last == 0;
                looks = 0;
                render::Control control;
                control.cancel = &cancel;
                control.progress = [&](double) { cancel = cancel || ++looks >= last; };
                return renderer.render(settings, control).complete;
            };
            CHECK(rendered(1 << 30));
            const auto shown = [&] { return pixels(renderer, "beauty", render::outputWindow(settings)); };
            const std::vector<float> finished = shown();
            const int all = looks;
            CHECK(all > 4);
            for (int last = 0; last < all; ++last) {
                CAPTURE(m.name);
                CAPTURE(last);
                const bool complete = rendered(last);
                const std::vector<float> image = shown();
                CHECK((!complete || image == finished));
                CHECK(std::ranges::all_of(image, [](float x) { return std::isfinite(x); }));
                // What was sampled is shown.
                const auto sum = [&](const char* tally) {
                    const auto each = renderer.frame().planes<std::uint64_t>(tally).downloadAll(renderer.queue());
                    return std::accumulate(each.begin(), each.end(), std::uint64_t { 0 });
                };
                CHECK((sum("raysTally") > 0) == (sum("samplesTally") > 0));
            }
            // Who asks when all has been sampled has the whole image. In batches whose number does not depend on time:
            renderer.queue().setTargetMilliseconds(1e9);
            rendered(1 << 30);
            const int fewest = looks;
            CHECK(rendered(fewest));
            CHECK(cancel);
            CHECK(shown() == finished);
            CHECK_FALSE(rendered(1));
            renderer.queue().setTargetMilliseconds(100);
        }
    });
}

TEST_CASE("any crop has the bits of the whole image")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        const image::Window crops[] = { { 0, 0, 1, 1 }, { width - 1, height - 1, width, height },
            { width - 1, 0, width, 1 }, { 13, 7, 42, 31 }, { 33, 0, 34, height }, { 0, 20, width, 21 },
            { 50, 40, 75, 53 } };
        for (const Named& m : methods()) {
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
                const std::vector<float> part = pixels(renderer, "beauty", crop);
                std::vector<float> expected;
                for (int y = crop.y0; y < crop.y1; ++y)
                    for (int x = crop.x0; x < crop.x1; ++x)
                        for (int c = 0; c < 3; ++c)
                            expected.push_back(whole[3 * pixelAt(x, y) + static_cast<std::size_t>(c)]);
                CAPTURE(crop.x0);
                CAPTURE(crop.y0);
                CHECK(sameBits(part, expected));
            }
        }
    });
}

TEST_CASE("a crop in the middle of a large image has its bits, and reads nothing that nobody made")
{
    // Far from all borders: what a pass reads beyond the window that it declares is a not-a-number here.
    onEveryDevice([](const device::Device& device) {
        constexpr int across = 230, down = 190;
        const image::Window crop { 110, 90, 131, 107 };
        scene::Scene scene = richScene(), lens = richScene();
        lens.camera.apertureRadius = 0.02f;
        lens.camera.focusDistance = 4.0f;
        render::Options poisoned = renderOptions();
        poisoned.poison = true;
        render::Settings aaf = sized(render::axisAligned(16), across, down);
        aaf.bounces = 1;
        render::Settings fixed = aaf, antialiased = aaf, slopes = aaf, components = aaf;
        slopes.maaf = render::Maaf::TwoSlope;
        components.maaf = render::Maaf::Printed;
        fixed.filtering = render::Filtering::Fixed;
        antialiased.antialias = true;
        struct Frame {
            const scene::Scene& scene;
            render::Settings settings;
            bool layers;
        };
        for (const Frame& frame : { Frame { scene, aaf, false }, Frame { scene, aaf, true },
                 Frame { scene, fixed, false }, Frame { scene, slopes, false }, Frame { scene, components, false },
                 Frame { scene, antialiased, false }, Frame { lens, aaf, false }, Frame { lens, aaf, true } }) {
            CAPTURE(frame.layers);
            CAPTURE(&frame.scene == &lens);
            render::Renderer whole(frame.scene, device, renderOptions()), part(frame.scene, device, poisoned);
            render::Settings settings = frame.settings;
            const auto shown = [&](render::Renderer& by) {
                by.render(settings, {}, frame.layers);
                std::vector<float> out = pixels(by, "beauty", crop);
                for (const char* layer : { "direct", "indirect" }) {
                    const std::vector<float> more = frame.layers ? pixels(by, layer, crop) : std::vector<float>();
                    out.insert(out.end(), more.begin(), more.end());
                }
                return out;
            };
            const std::vector<float> expected = shown(whole);
            settings.crop = crop;
            CHECK(sameBits(shown(part), expected));
        }
    });
}

TEST_CASE("two lights give the sum of each: every light is a term of its own")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene both = smallScene(), first = both, second = both;
        // The first dark and not gone: a light's place in the list is part of its random numbers.
        first.areaLights.resize(1);
        second.areaLights[0].radiance = glm::vec3(0);
        render::Renderer together(both, device, renderOptions()), one(first, device, renderOptions()),
            two(second, device, renderOptions());
        for (const Named& m : methods()) {
            CAPTURE(m.name);
            const image::Window all { 0, 0, width, height };
            const auto direct = [&](render::Renderer& r) {
                render::Settings settings = m.settings;
                settings.fallback = false; // which looks at the lights' sum
                r.render(settings, {}, true);
                return pixels(r, "direct", all);
            };
            const std::vector<float> sum = direct(together), a = direct(one), b = direct(two);
            unsigned wrong = 0;
            for (std::size_t i = 0; i < sum.size(); ++i)
                wrong += sum[i] == a[i] + b[i] ? 0 : 1;
            CHECK(wrong == 0);
            CHECK(rmse(a, b) > 0.03);
        }
    });
}

TEST_CASE("aaf without filter and with uniform counts is the plain image of the same samples")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings unfiltered = sized(render::axisAligned(20), width, height);
        unfiltered.filtering = render::Filtering::None;
        unfiltered.sampling = render::Sampling::Uniform;
        // By points on lights: reflected directions find them in plain frames only.
        render::Settings points = sized(render::monteCarlo(20), width, height);
        points.lightSampling = render::LightSampling::Lights;
        const std::vector<float> plain = renderPixels(renderer, points);
        render::Settings inside = unfiltered;
        inside.shading = render::Shading::Inside;
        CHECK(sameBits(renderPixels(renderer, inside), plain));
        // In the other ways of shading, filtered and unfiltered are one where nothing is filtered.
        for (const render::Shading shading : { render::Shading::Ratio, render::Shading::Separate }) {
            unfiltered.shading = shading;
            renderer.render(unfiltered, {}, true);
            const image::Window all { 0, 0, width, height };
            CHECK(sameBits(pixels(renderer, "direct", all), pixels(renderer, "directNoisy", all)));
        }
    });
}

TEST_CASE("a pixel without a kernel keeps its own Monte Carlo value")
{
    onEveryDevice([](const device::Device& device) {
        scene::Scene scene = smallScene();
        scene.areaLights.resize(1);
        render::Renderer renderer(scene, device, renderOptions());
        for (const Named& m : methods()) {
            if (m.settings.method == render::Method::MonteCarlo)
                continue;
            CAPTURE(m.name);
            renderer.render(m.settings, {}, true);
            const image::Window all { 0, 0, width, height };
            const auto direct = pixels(renderer, "direct", all), noisy = pixels(renderer, "directNoisy", all);
            const std::vector<float> beta = widthsOf(renderer, termsOf(renderer).at(0));
            unsigned without = 0, changed = 0;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    const std::size_t i = 3 * pixelAt(x, y);
                    const std::size_t at = shared::pixelIndex(
                        static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), renderer.frame().layout.stride);
                    const bool same = std::equal(&direct[i], &direct[i] + 3, &noisy[i]);
                    changed += same ? 0 : 1;
                    if (!(beta[at] > 0)) {
                        ++without;
                        REQUIRE(same);
                    }
                }
            CHECK(without > 50);
            CHECK(changed > 200);
        }
    });
}
