#include "benchmarks/rendering_filters/stylized_lab.h"

#include "benchmarks/rendering_filters/shadow_outline.h"
#include "effects/styled_shadows/styled_lights.h"
#include "host/error.h"
#include "host/scene/load_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

/// Passes by what they are for, as reports name them.
const std::map<std::string, std::vector<std::string>>& parts()
{
    static const std::map<std::string, std::vector<std::string>> all {
        { "matte", { "shadows in a style", "levels of a shadow" } }, { "edges", { "edges of shadows" } },
        { "distance", { "distances to shadows' edges" } }, { "blur", { "blur of shadows' edges" } },
        { "transfer", { "areas of shadows", "styles of shadows" } }
    };
    return all;
}

bool isSoft(const scene::Scene& scene)
{
    return std::ranges::any_of(scene.areaLights, [](const scene::AreaLight& light) { return !light.styles.empty(); });
}

/// Soft shadows are filtered before they have a style.
render::Settings settingsOf(const scene::Scene& scene, const StylizedPlan& plan, bool styles)
{
    render::Settings out = isSoft(scene) ? render::axisAligned() : render::monteCarlo(1);
    out.width = plan.width;
    out.height = plan.height;
    out.styles = styles;
    return out;
}

/// Frames with and without styles take turns, so that what else the machine does falls on both.
StylizedTimes timesOf(render::Renderer& renderer, const StylizedPlan& plan)
{
    std::map<std::string, std::vector<double>> ofParts;
    std::vector<double> frames, plain, together;
    const render::Settings styled = settingsOf(renderer.scene(), plan, true);
    const render::Settings without = settingsOf(renderer.scene(), plan, false);
    renderer.rehearse(styled);
    renderer.rehearse(without);
    for (int turn = -1; turn < plan.seeds; ++turn) {
        const double plainMilliseconds = renderer.render(without).deviceMilliseconds;
        const render::FrameStatistics frame = renderer.render(styled);
        if (turn < 0) {
            continue; // warms up
        }
        plain.push_back(plainMilliseconds);
        frames.push_back(frame.deviceMilliseconds);
        together.push_back(0);
        for (const auto& [part, passes] : parts()) {
            double sum = 0;
            for (const std::string& pass : passes) {
                sum += frame.milliseconds(pass);
            }
            ofParts[part].push_back(sum);
            together.back() += sum;
        }
    }
    const auto summary = [&](const char* part) { return summarize(ofParts[part]); };
    return { summary("matte"), summary("edges"), summary("distance"), summary("blur"), summary("transfer"),
        summarize(together), summarize(frames), summarize(plain) };
}

using Turn = std::function<void(scene::ShadowStyle&, float)>;

void turnStyles(scene::Scene& scene, const Turn& turn, float factor)
{
    const auto each = [&](auto& lights) {
        for (auto& light : lights) {
            for (scene::ShadowStyle& style : light.styles) {
                turn(style, factor);
            }
        }
    };
    each(scene.pointLights);
    each(scene.directionalLights);
    each(scene.areaLights);
}

void turnShades(scene::ShadowStyle& style, float factor)
{
    style.inflation.constant *= factor;
    style.softness.constant *= factor;
    style.brightness.constant *= factor;
}

void turnAbstraction(scene::ShadowStyle& style, float factor) { style.abstraction.constant *= factor; }

Summary timesOf(
    render::Renderer& renderer, const render::Settings& settings, const StylizedPlan& plan, const Turn& turn)
{
    using Clock = std::chrono::steady_clock;
    std::vector<double> out;
    for (int i = -1; i < plan.seeds; ++i) {
        const Clock::time_point start = Clock::now();
        renderer.changeScene({ .onlyKnobs = true },
            [&](scene::Scene& scene) { turnStyles(scene, turn, i % 2 == 0 ? 1.0f / 1.05f : 1.05f); });
        renderer.render(settings);
        if (i >= 0) {
            out.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
        }
    }
    return summarize(out);
}

RestyleTimes restylesOf(scene::Scene scene, const device::Device& device, const StylizedPlan& plan)
{
    bool blurs = false;
    const auto addKey = [&](scene::ShadowStyle& style, float factor) {
        scene::ShadowStyle key = style;
        turnShades(key, factor);
        turnAbstraction(key, factor);
        style.keys = { key };
        blurs = blurs || style.abstraction.constant > 0;
    };
    turnStyles(scene, addKey, 1.1f);
    render::Renderer renderer(scene, device);
    render::Settings settings = settingsOf(scene, plan, true);
    settings.sameNumbers = true;
    renderer.rehearse(settings);
    renderer.render(settings);
    RestyleTimes out { timesOf(renderer, settings, plan, turnShades), {} };
    if (blurs) {
        out.abstraction = timesOf(renderer, settings, plan, turnAbstraction);
    }
    return out;
}

/// What a style leaves of the light at that distance, black shadows given.
double lightAt(double distance, const scene::ShadowStyle& style)
{
    const double inflation = double { style.inflation.constant }, softness = double { style.softness.constant };
    if (!(softness > 0)) {
        return distance > inflation ? 1 : 0;
    }
    const double t = std::clamp((distance - inflation) / softness + 0.5, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

StylizedErrors errorsOf(const ShadowOutline& outline, const scene::ShadowStyle& style, const StylizedPlan& plan)
{
    const double work = static_cast<double>(outline.pixels().size()) * static_cast<double>(outline.pieces());
    const auto step = static_cast<std::size_t>(std::max(std::ceil(work / plan.work), 1.0));
    StylizedErrors out;
    out.sampled.resize(plan.samples.size());
    std::mt19937_64 random(1);
    // From the middle of the first step on, each in another column.
    for (std::size_t k = step / 2; k < outline.pixels().size(); k += step) {
        const std::size_t pixel = outline.pixels()[k];
        const double expected = lightAt(outline.byAll(pixel), style);
        const auto squareOff = [&](double distance) { return std::pow(lightAt(distance, style) - expected, 2); };
        out.device += squareOff(outline.onDevice(pixel));
        for (std::size_t s = 0; s < plan.samples.size(); ++s) {
            out.sampled[s] += squareOff(outline.bySome(pixel, plan.samples[s], random));
        }
        ++out.pixels;
    }
    const auto rms = [&](double sum) {
        return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(out.pixels, 1)));
    };
    out.device = rms(out.device);
    std::ranges::transform(out.sampled, out.sampled.begin(), rms);
    return out;
}

} // namespace

StylizedResult measureStyles(const StylizedScene& source, const device::Device& device, const StylizedPlan& plan)
{
    const scene::Scene scene = scene::loadScene(source.file());
    render::Renderer renderer(scene, device);
    const render::Settings settings = settingsOf(scene, plan, true);
    const std::vector<render::StyledLight> lights = render::styledLights(settings, renderer.scene());
    if (lights.empty() && !isSoft(scene)) {
        throw Error("scene", source.name, "give a point light, a directional one or a quad a [[light.style]]");
    }
    StylizedResult out { source, isSoft(scene), 0, timesOf(renderer, plan), restylesOf(scene, device, plan), {} };
    if (lights.empty()) {
        return out;
    }
    renderer.render(settings, {}, true);
    const std::string light = "." + lights.front().name;
    if (renderer.frame().has("shadowDistance" + light)) {
        const ShadowOutline outline(renderer, light);
        out.pieces = outline.pieces();
        out.errors = errorsOf(outline, lights.front().styles.front(), plan);
    }
    return out;
}

} // namespace wedge::benchmark
