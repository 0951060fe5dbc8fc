// What holds of every filter, of samples and of finished images, over whole frames (host/render/filter_chain.h).
#include "host/render/filter_chain.h"
#include "tests/image_means.h"
#include "tests/render_support.h"

#include "host/render/progressive.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>

using namespace wedge;
using namespace wedge::test;

namespace {

constexpr int width = 45, height = 34;

/// Values of each filter that change an image.
const std::map<std::string, std::vector<float>> effective = { { "gaussian", { 1.7f } }, { "bilateral", { 1.2f, 0.7f } },
    { "median", { 1 } }, { "mad-median", { 1, 2 } }, { "sharpen", { 1.3f, 0.6f } }, { "bloom", { 0.2f, 0.3f, 0.4f } },
    { "colour", { 0.5f, 1.5f, 1, 0.7f } }, { "box", { 2 } }, { "path-density", { 10, 0.2f, 1, 2, 0, 0, 0, 8 } },
    { "clamp", { 0.3f, 0, 0, 0 } }, { "trim", { 0.3f, 1, 0 } }, { "gmon", { 3, 1, 0 } },
    { "reweight", { 4, 0, 0, 0 } } };
/// And values that do not.
const std::map<std::string, std::vector<float>> neutral = { { "gaussian", { 0 } }, { "bilateral", { 0, 1 } },
    { "median", { 0 } }, { "mad-median", { 0, 2 } }, { "sharpen", { 1, 0 } }, { "bloom", { 0.2f, 0, 2 } },
    { "colour", { 0.5f, 2, 3, 0 } }, { "box", { 0 } }, { "path-density", { 10, 4, 4, 2, 0, 0, 0, 8 } },
    { "clamp", { 1e9f, 0, 0, 0 } }, { "trim", { 0, 1, 0 } }, { "gmon", { 1, 1, 0 } }, { "reweight", { 0, 0, 0, 0 } } };

render::Settings plain(bool filtered = false)
{
    render::Settings s = sized(filtered ? render::axisAligned(16) : render::monteCarlo(4), width, height);
    s.bounces = 1;
    return s;
}

render::Settings with(render::Settings settings, const std::vector<std::string>& filters,
    const std::map<std::string, std::vector<float>>& values = effective)
{
    for (const std::string& name : filters)
        settings.filters.push_back({ name, values.at(name) });
    return settings;
}

/// Names of all filters of that stage.
std::vector<std::string> registered(render::Stage stage = render::Stage::Image)
{
    std::vector<std::string> names;
    for (const auto& filter : render::registeredFilters())
        if (filter->stage() == stage)
            names.push_back(filter->name());
    return names;
}

/// Of every stage.
std::vector<std::string> all()
{
    std::vector<std::string> names = registered(render::Stage::Samples);
    for (std::string& name : registered())
        names.push_back(std::move(name));
    return names;
}

std::vector<float> rendered(render::Renderer& renderer, const render::Settings& settings)
{
    renderer.render(settings);
    return pixels(renderer, "beauty", render::outputWindow(settings));
}

/// Of the pixels of 3x3 that are in the image.
template <class At>
float medianAt(const std::vector<float>& image, int x, int y, const At& at)
{
    std::vector<float> around;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
            around.push_back(image[at(u, v)]);
    std::ranges::sort(around);
    const std::size_t half = around.size() / 2;
    return around.size() % 2 == 1 ? around[half] : around[half - 1] + 0.5f * (around[half] - around[half - 1]);
}

} // namespace

TEST_CASE("every filter has values here, within its ranges, and changes an image or does not")
{
    CHECK(all().size() == effective.size());
    for (const auto& filter : render::registeredFilters()) {
        CAPTURE(filter->name());
        const std::vector<render::FilterParameter> parameters = filter->parameters();
        for (const auto* values : { &effective, &neutral }) {
            REQUIRE(values->at(filter->name()).size() == parameters.size());
            for (std::size_t i = 0; i < parameters.size(); ++i) {
                CHECK(values->at(filter->name())[i] >= parameters[i].least);
                CHECK(values->at(filter->name())[i] <= parameters[i].most);
                CHECK(parameters[i].standard >= parameters[i].least);
                CHECK(parameters[i].standard <= parameters[i].most);
            }
        }
    }
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        const std::vector<float> before = rendered(renderer, plain());
        for (const std::string& name : all()) {
            CAPTURE(name);
            CHECK(sameBits(rendered(renderer, with(plain(), { name }, neutral)), before));
            const std::vector<float> after = rendered(renderer, with(plain(), { name }));
            CHECK_FALSE(sameBits(after, before));
            CHECK(notFinite(after) == 0);
            CHECK(std::ranges::all_of(after, [](float x) { return x >= 0.0f; }));
            CHECK(sameBits(rendered(renderer, with(plain(), { name })), after));
        }
    });
}

TEST_CASE("filters of images trace nothing, and change the beauty alone")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        for (const bool distributed : { false, true }) {
            CAPTURE(distributed);
            render::Settings s = plain(true);
            s.antialias = distributed;
            const auto layers = [&](const render::Settings& settings) {
                const render::FrameStatistics statistics = renderer.render(settings, {}, true);
                std::vector<float> out;
                for (const char* plane : { "direct", "directNoisy", "indirect", "emission", "albedo" }) {
                    const std::vector<float> shown = pixels(renderer, plane, { 0, 0, width, height });
                    out.insert(out.end(), shown.begin(), shown.end());
                }
                return std::pair(out, statistics.shadowRays + statistics.indirectRays + statistics.primaryRays);
            };
            const auto before = layers(s), after = layers(with(s, registered()));
            CHECK(sameBits(after.first, before.first));
            CHECK(after.second == before.second);
        }
    });
}

TEST_CASE("a crop of a filtered image has the bits of the whole, whatever lay in the memory, in every kind of frame")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Options poisoned = renderOptions();
        poisoned.poison = true;
        render::Renderer renderer(scene, device, renderOptions()), other(scene, device, poisoned);
        std::vector<std::vector<std::string>> chains;
        for (const std::string& name : all())
            chains.push_back({ name });
        chains.push_back({ "median", "gaussian" });
        chains.push_back(registered());
        chains.push_back({ "path-density", "median" });
        for (const bool distributed : { false, true }) {
            for (const std::vector<std::string>& chain : chains) {
                if (distributed && (chain.size() == 1 || chain.front() == "path-density"))
                    continue; // one after the other is enough; and those of samples are of frames through a pinhole
                CAPTURE(distributed);
                CAPTURE(chain.front());
                render::Settings s = with(plain(), chain);
                s.antialias = distributed;
                const std::vector<float> whole = rendered(renderer, s);
                s.crop = { 13, 9, 29, 25 };
                const std::vector<float> crop = rendered(other, s);
                std::vector<float> expected;
                const auto value = [&](int x, int y, int c) {
                    return whole[3 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x))
                        + static_cast<std::size_t>(c)];
                };
                for (int y = s.crop.y0; y < s.crop.y1; ++y)
                    for (int x = s.crop.x0; x < s.crop.x1; ++x)
                        for (int c = 0; c < 3; ++c)
                            expected.push_back(value(x, y, c));
                CHECK(sameBits(crop, expected));
            }
        }
    });
}

TEST_CASE("filters are done in the order that they are given, one over what the other made")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        const auto of = [&](const std::vector<std::string>& chain) { return rendered(renderer, with(plain(), chain)); };
        CHECK_FALSE(sameBits(of({ "median", "gaussian" }), of({ "gaussian", "median" })));
        // Of a colour that is everywhere the same the order does not matter but for rounding; twice it is squared.
        render::Settings twice = plain();
        twice.filters = { { "colour", { 0.5f, 2, 1, 1 } }, { "colour", { 0.5f, 2, 1, 1 } } };
        render::Settings once = plain();
        once.filters = { { "colour", { 0.25f, 4, 1, 1 } } };
        CHECK(sameBits(rendered(renderer, twice), rendered(renderer, once)));
    });
}

TEST_CASE("progressive frames are filtered once both halves are one image, and their estimate of the error is not")
{
    onEveryDevice([](const device::Device& device) {
        const scene::Scene scene = richScene();
        render::Renderer renderer(scene, device, renderOptions());
        render::Settings s = plain();
        s.spp = 32;
        s.progressive = true;
        const auto steps = [&](const render::Settings& settings) {
            std::vector<double> errors;
            std::vector<std::vector<float>> images;
            renderer.renderProgressively(settings, {}, [&](const render::ProgressiveStep& step) {
                errors.push_back(step.error.noise);
                images.push_back(pixels(renderer, "beauty", { 0, 0, width, height }));
            });
            return std::pair(errors, images);
        };
        const auto before = steps(s), after = steps(with(s, { "median" }));
        CHECK(after.first == before.first);
        REQUIRE(after.second.size() == before.second.size());
        CHECK(after.second.size() > 1);
        for (std::size_t i = 0; i < after.second.size(); ++i) {
            CAPTURE(i);
            bool same = true;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    for (int c = 0; c < 3; ++c) {
                        const auto at = [c](int u, int v) {
                            return 3 * (static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u))
                                + static_cast<std::size_t>(c);
                        };
                        same = same && after.second[i][at(x, y)] == medianAt(before.second[i], x, y, at);
                    }
            CHECK(same);
        }
    });
}
