// Samples of indirect light that are not finite: how many a filter of samples leaves out, over whole frames.
#include "host/render/filter_chain.h"
#include "host/render/progressive.h"
#include "tests/filtered_frames.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 45, height = 34;
constexpr std::uint64_t pixelCount = std::uint64_t { width } * height;
const render::ChosenFilter density { "path-density", { 10, 2, 3, 3, 1 } };

const std::vector<render::ChosenFilter>& filters()
{
    static const std::vector<render::ChosenFilter> all { density, { "clamp", { 10, 0, 1 } }, { "trim", { 0.1f, 0 } },
        { "gmon", { 9, 0 } }, { "reweight", { 1, 0, 1 } } };
    return all;
}

bool knowsBins(const render::ChosenFilter& filter) { return filter.name != "trim" && filter.name != "gmon"; }

constexpr float matt = 0.8f, beyond = 3e38f; ///< reflectances: `beyond` makes any light infinite

/// A closed room, a plate behind the camera, and a screen of ordinary reflectance that fills the view: all its paths
/// meet the walls or the plate. Where both reflect alike there is no plate, and a point light lights all that they
/// meet.
scene::Scene room(float walls, float plate)
{
    SceneBuilder b;
    for (const float reflectance : { walls, plate }) {
        b.scene.materials.emplace_back();
        b.scene.materials.back().diffuse = glm::vec3(reflectance);
    }
    b.box(glm::vec3(-1), glm::vec3(1), 1);
    if (plate != walls) {
        b.newObject();
        b.quad({ 0, 0, 0.95f }, { 0.4f, 0, 0 }, { 0, 0.4f, 0 }, 2);
    }
    b.newObject();
    b.quad({ 0, 0, -0.9f }, { 0.95f, 0, 0 }, { 0, 0.95f, 0 }, 0);
    b.scene.pointLights.push_back({ { 0, 0.3f, 0.2f }, glm::vec3(1e3f) });
    b.camera({ 0.1f, -0.2f, 0.3f }, { 0, -0.1f, -1 });
    return b.scene;
}

render::Settings of(render::Settings settings, bool antialias = false)
{
    render::Settings s = sized(std::move(settings), width, height);
    s.bounces = 1;
    s.antialias = antialias;
    return s;
}

/// All samples that a frame of one term has taken in pixels that it shows, all of which show something.
std::uint64_t taken(const render::FrameStatistics& statistics)
{
    return static_cast<std::uint64_t>(
        std::llround(statistics.indirectSpp * static_cast<double>(statistics.shadedPixels)));
}

/// Pixels of an image of one sample each that are not finite.
std::uint64_t pixelsNotFinite(render::Renderer& renderer, const render::Settings& settings)
{
    const std::vector<float> image = rendered(renderer, settings);
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < image.size(); i += 3)
        count += notFinite(std::span(image).subspan(i, 3)) > 0 ? 1u : 0u;
    return count;
}

} // namespace

TEST_CASE("where all samples are infinite all are counted, each once; where none is none; without a filter nothing is")
{
    onEveryDevice([](const device::Device& device) {
        for (const bool infinite : { false, true }) {
            const float reflectance = infinite ? beyond : matt;
            render::Renderer renderer(room(reflectance, reflectance), device, renderOptions());
            for (const render::ChosenFilter& filter : filters())
                for (const bool antialias : { false, true })
                    for (const bool layers : { false, true })
                        for (const render::Settings& plain :
                            { of(render::monteCarlo(20), antialias), of(render::axisAligned(40), antialias) }) {
                            if (antialias && !knowsBins(filter))
                                continue;
                            CAPTURE(infinite);
                            CAPTURE(filter.name);
                            CAPTURE(antialias);
                            CAPTURE(layers);
                            CAPTURE(plain.spp);
                            CHECK_FALSE(renderer.render(plain, {}, layers).notFiniteSamples);
                            const render::FrameStatistics found = renderer.render(with(plain, filter), {}, layers);
                            REQUIRE(found.notFiniteSamples);
                            CHECK(found.notFiniteSamples.value_or(0) == (infinite ? taken(found) : 0));
                            CHECK(found.shadedPixels == pixelCount);
                            CHECK(taken(found) >= pixelCount * (plain.spp == 20 ? 20 : 16));
                        }
        }
    });
}

TEST_CASE("of frames of a sample a pixel those are counted that are not finite in the image without a filter")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(room(matt, beyond), device, renderOptions());
        for (const bool antialias : { false, true })
            for (const render::ChosenFilter& filter : filters()) {
                if (antialias && !knowsBins(filter))
                    continue;
                CAPTURE(antialias);
                CAPTURE(filter.name);
                const render::Settings s = of(render::monteCarlo(1), antialias);
                const std::uint64_t expected = pixelsNotFinite(renderer, s);
                CHECK(expected > 20);
                CHECK(expected < pixelCount / 4);
                CHECK(renderer.render(with(s, filter)).notFiniteSamples.value_or(0) == expected);
                CHECK(pixelsNotFinite(renderer, with(s, filter)) == 0);
            }
    });
}

TEST_CASE("of frames of more samples the share is that of one, also where the first are taken twice")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(room(matt, beyond), device, renderOptions());
        double single = 0;
        render::Settings one = of(render::monteCarlo(1));
        constexpr int runs = 16;
        for (one.seed = 0; one.seed < runs; ++one.seed)
            single += static_cast<double>(pixelsNotFinite(renderer, one)) / (double { runs } * pixelCount);
        for (const render::Settings& s :
            { of(render::monteCarlo(24)), of(render::axisAligned(24)), of(render::monteCarlo(24), true) }) {
            CAPTURE(s.antialias);
            CAPTURE(s.method == render::Method::MonteCarlo);
            const render::FrameStatistics found = renderer.render(with(s, density));
            const double share =
                static_cast<double>(found.notFiniteSamples.value_or(0)) / static_cast<double>(taken(found));
            CAPTURE(single);
            CAPTURE(share);
            CHECK(taken(found) > 20 * pixelCount);
            CHECK(std::fabs(share - single) < 0.1 * single);
        }
        // Receivers that have several samples lose all of them with one that is infinite.
        const render::FrameStatistics several = renderer.render(with(of(render::axisAligned(64), true), density));
        CHECK(several.indirectSpp > 1.5 * several.primarySpp);
        const double share =
            static_cast<double>(several.notFiniteSamples.value_or(0)) / static_cast<double>(taken(several));
        CHECK(share > 1.5 * single);
        CHECK(share < 1);
    });
}

TEST_CASE("a crop counts the samples of the pixels that it shows")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(room(beyond, beyond), device, renderOptions());
        for (const bool antialias : { false, true })
            for (render::Settings s :
                { of(render::monteCarlo(8), antialias), of(render::axisAligned(24), antialias) }) {
                CAPTURE(antialias);
                CAPTURE(s.spp);
                s.crop = { 17, 11, 30, 23 };
                const render::FrameStatistics found = renderer.render(with(s, density));
                CHECK(found.shadedPixels == 13 * 12);
                CHECK(found.notFiniteSamples.value_or(0) == taken(found));
            }
    });
}

TEST_CASE("progressive frames count what is not finite in all steps so far, of both halves")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(room(beyond, beyond), device, renderOptions());
        for (const bool layers : { false, true })
            for (const render::Settings& s : { of(render::monteCarlo(32)), of(render::axisAligned(64)) }) {
                CAPTURE(layers);
                CAPTURE(s.spp);
                std::uint64_t before = 0;
                int steps = 0;
                renderer.renderProgressively(
                    with(s, density), {},
                    [&](const render::ProgressiveStep& step) {
                        CAPTURE(step.spp);
                        CHECK(step.statistics.notFiniteSamples.value_or(0) == taken(step.statistics));
                        CHECK(taken(step.statistics) >= before);
                        before = taken(step.statistics);
                        ++steps;
                    },
                    layers);
                CHECK(steps > 1);
                // Counts of method aaf go by noise, of which nothing is left.
                CHECK(before >= pixelCount * (s.spp == 32 ? 32u : 16u));
            }
    });
}

TEST_CASE("a frame that is stopped counts no more than it has sampled")
{
    onEveryDevice([](const device::Device& device) {
        render::Renderer renderer(room(beyond, beyond), device, renderOptions());
        renderer.queue().setTargetMilliseconds(0.05);
        std::uint64_t counted = 0;
        for (const render::Settings& s : { of(render::monteCarlo(1100)), of(render::axisAligned(200)) })
            for (const int most : { 6, 60 }) {
                CAPTURE(s.spp);
                CAPTURE(most);
                std::atomic<bool> cancel { false };
                int looks = 0;
                render::Control control;
                control.cancel = &cancel;
                control.progress = [&](double) { cancel = ++looks >= most; };
                const render::FrameStatistics found = renderer.render(with(s, density), control);
                CHECK_FALSE(found.complete);
                CHECK(found.notFiniteSamples.value_or(0) == taken(found));
                counted += found.notFiniteSamples.value_or(0);
            }
        CHECK(counted > 0);
    });
}
