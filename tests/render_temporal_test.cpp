// Frames that are filtered over time, as the renderer has them: what is kept of which frame, and what it takes.
#include "filters/temporal/temporal.h"
#include "host/render/layers.h"
#include "tests/render_support.h"

#include <doctest/doctest.h>

using namespace wedge;
using namespace wedge::test;

namespace {

/// Two kinds of frames: of one receiver a pixel, and of several.
render::Settings settingsOf(bool antialias, int width = 37, int height = 21)
{
    render::Settings settings = sized(render::axisAligned(16), width, height);
    settings.antialias = antialias;
    settings.temporal = render::Temporal::On;
    return settings;
}

/// A sequence whose frames have samples of their own.
struct Sequence {
    explicit Sequence(const device::Device& device)
        : renderer(smallScene(), device, renderOptions())
        , filter(std::make_shared<filters::TemporalFilter>(device))
    {
        renderer.filterFrames(filter);
    }

    std::vector<float> frame(std::uint32_t number, render::Settings settings, const std::atomic<bool>* cancel = nullptr)
    {
        settings.frame = number;
        filter->next(nullptr);
        render::Control control;
        control.cancel = cancel;
        renderer.render(settings, control);
        return pixels(renderer, "beauty", { 0, 0, settings.width, settings.height });
    }

    render::Renderer renderer;
    std::shared_ptr<filters::TemporalFilter> filter;
};

bool mentionsFilter(const Sequence& sequence, const render::Settings& settings)
{
    return sequence.renderer.explain(settings).text.find("filter over time") != std::string::npos;
}

} // namespace

TEST_CASE("a sequence of another size or with other terms begins anew, with the same filter")
{
    onEveryDevice([](const device::Device& device) {
        Sequence sequence(device);
        sequence.frame(0, settingsOf(false));
        sequence.frame(1, settingsOf(false));
        render::Settings more = settingsOf(false, 64, 48);
        for (const int bounces : { 0, 1 }) {
            CAPTURE(bounces);
            more.bounces = bounces;
            Sequence fresh(device);
            for (std::uint32_t number = 2; number < 4; ++number) {
                CAPTURE(number);
                const std::vector<float> expected = fresh.frame(number, more);
                CHECK(sequence.frame(number, more) == expected);
            }
        }
    });
}

TEST_CASE("a frame that was stopped is not kept")
{
    onEveryDevice([](const device::Device& device) {
        const std::atomic<bool> stop { true };
        for (const bool antialias : { false, true }) {
            CAPTURE(antialias);
            Sequence stopped(device), without(device), whole(device);
            for (std::uint32_t number = 0; number < 4; ++number) {
                stopped.frame(number, settingsOf(antialias), number == 2 ? &stop : nullptr);
                whole.frame(number, settingsOf(antialias));
                if (number != 2)
                    without.frame(number, settingsOf(antialias));
            }
            const image::Window all { 0, 0, 37, 21 };
            const auto of = [&](Sequence& sequence) { return pixels(sequence.renderer, "beauty", all); };
            CHECK(of(stopped) == of(without));
            CHECK(of(stopped) != of(whole));
        }
    });
}

TEST_CASE("frames have a filter's passes as long as the renderer has it, and are else as they were")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool antialias : { false, true }) {
            CAPTURE(antialias);
            Sequence sequence(device);
            const render::Settings settings = settingsOf(antialias);
            render::Settings single = settings;
            single.temporal = render::Temporal::Off;
            CHECK(mentionsFilter(sequence, settings));
            CHECK_FALSE(mentionsFilter(sequence, single));
            sequence.frame(0, settings);
            const std::vector<float> filtered = sequence.frame(1, settings);
            sequence.renderer.filterFrames(nullptr);
            CHECK_FALSE(mentionsFilter(sequence, settings));
            const std::vector<float> alone = sequence.frame(1, settings);
            CHECK(filtered != alone);
            CHECK(alone == sequence.frame(1, single));
        }
    });
}

TEST_CASE("a filter over time changes nothing about how a frame is stored")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool antialias : { false, true }) {
            CAPTURE(antialias);
            Sequence sequence(device);
            render::Settings settings = settingsOf(antialias, 320, 240);
            settings.frame = 0;
            render::Settings single = settings;
            single.temporal = render::Temporal::Off;
            const std::uint64_t bytes = sequence.renderer.planUnbacked(settings).total();
            CHECK(bytes == sequence.renderer.plan(settings).total());
            CHECK(bytes == sequence.renderer.render(settings).memoryBytes);
            device::MemoryPlan kept;
            sequence.filter->addTo(kept, settings, sequence.renderer.scene());
            const double plane = 4.0 * static_cast<double>(render::PlaneLayout(320, 240).size);
            const double more = static_cast<double>(bytes - kept.total())
                - static_cast<double>(sequence.renderer.planUnbacked(single).total());
            // Reflectances, 12 bytes a pixel, of frames of several receivers; sums lie mostly where samples were.
            CHECK(more / plane < (antialias ? 7 : 10));
            CHECK(static_cast<double>(kept.total()) / plane > 8 * 5.4);
        }
    });
}

TEST_CASE("the layer of pixels' sizes is what the edge of a pixel projects to on a surface, and 0 on a miss")
{
    onEveryDevice([](const device::Device& device) {
        // A wall that is turned, so that depths differ, and ends before the image does.
        SceneBuilder b;
        b.quad({ 0, 0, 0 }, { 0.9f, 0, 0.3f }, { 0, 0.8f, 0 });
        b.camera({ 0, 0, 3 }, { 0, 0, 0 });
        const glm::dvec3 normal = glm::normalize(glm::cross(glm::dvec3(0.9, 0, 0.3), glm::dvec3(0, 0.8, 0)));
        const double fov = static_cast<double>(b.scene.camera.verticalFov);
        const double step = 2 * std::tan(0.5 * glm::radians(fov)) / 21;
        struct Kind {
            bool filtered, antialias;
        };
        render::Renderer renderer(b.scene, device, renderOptions());
        for (const Kind& kind : { Kind { false, false }, { true, false }, { false, true }, { true, true } }) {
            CAPTURE(kind.filtered);
            CAPTURE(kind.antialias);
            render::Settings settings = sized(kind.filtered ? render::axisAligned(16) : render::monteCarlo(4), 37, 21);
            settings.antialias = kind.antialias;
            const render::FrameStatistics statistics = renderer.render(settings, {}, true);
            const image::LayeredImage image = render::readLayers(renderer, settings, statistics, { "pixelSize" });
            REQUIRE(image.find("pixelSize.Y") != nullptr);
            const std::vector<float> sizes = image.find("pixelSize.Y")->values;
            const auto ids = pixels(renderer, renderer.frame().counts("objectId"), { 0, 0, 37, 21 });
            int seen = 0;
            for (int y = 0; y < 21; ++y) {
                for (int x = 0; x < 37; ++x) {
                    const auto i = static_cast<std::size_t>(y) * 37 + static_cast<std::size_t>(x);
                    if (ids[i] == 0) {
                        CHECK(sizes[i] == 0.0f);
                        continue;
                    }
                    // A pixel's solid angle over the cosine at the surface, as an area there.
                    const glm::dvec3 ray((x + 0.5 - 18.5) * step, (10.5 - y - 0.5) * step, -1.0);
                    const double length = glm::length(ray), t = -3 * normal.z / glm::dot(ray, normal) * length;
                    const double cosine = std::abs(glm::dot(ray, normal)) / length;
                    const double area = step * step / (length * length * length) * t * t / cosine;
                    CHECK(sizes[i] == doctest::Approx(std::sqrt(area)).epsilon(kind.antialias ? 0.05 : 1e-3));
                    ++seen;
                }
            }
            CHECK(seen > 100);
        }
    });
}
