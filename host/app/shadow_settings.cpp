#include "host/app/shadow_settings.h"

#include "effects/shadow_lights/map_lights.h"
#include "host/app/console.h"
#include "host/app/values.h"
#include "host/error.h"
#include "host/render/effect.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace wedge::app {
namespace {

/// The option that chooses lights for a map, as it was given.
std::string shadowsOption(const RenderOptions& o)
{
    return "--shadows " + render::shadowsName(o.shadows.value_or(render::Shadows::Sampled));
}

/// Those that go with it.
std::string shadowLights(const RenderOptions& o)
{
    render::ShadowSettings s;
    s.lights = o.shadowLights.value_or(0);
    s.chosen = o.chosenLights.value_or(0);
    return "--shadow-lights " + render::shadowLightsText(s);
}

std::string shadowScale(const RenderOptions& o)
{
    render::ShadowSettings s;
    s.blockSide = o.shadowBlockSide.value_or(1);
    return "--shadow-scale " + render::shadowScaleText(s);
}

std::string shadowTime(const RenderOptions& o) { return fmt::format("--shadow-time {}", o.shadowSeconds.value_or(0)); }

std::string shadowComplete(const RenderOptions& o)
{
    return "--shadow-complete "
        + wholeLights[static_cast<std::size_t>(o.shadowComplete.value_or(render::WholeLight::Map))];
}

std::string shadowClamp(const RenderOptions& o)
{
    return std::string("--shadow-clamp ") + (o.shadowClamp.value_or(true) ? "on" : "off");
}

/// One of these.
std::string shadowOfThem(const RenderOptions& o)
{
    return o.shadowSeconds  ? shadowTime(o)
        : o.shadowLights    ? shadowLights(o)
        : o.shadowBlockSide ? shadowScale(o)
        : o.shadowComplete  ? shadowComplete(o)
                            : shadowClamp(o);
}

/// Device time of a frame.
struct TimeModel {
    double each = 0, constant = 0; ///< seconds: of a light where all pixels trace rays, and of all else
};

/// By two frames of 1/64 of the pixels.
TimeModel timesOfFrames(render::Renderer& renderer, const render::Settings& settings)
{
    constexpr int part = 8, fewLights = 16, manyLights = 64;
    render::Settings probe = settings;
    probe.width = std::max(settings.width / part, part);
    probe.height = std::max(settings.height / part, part);
    probe.crop = {};
    // Tables of the whole light take as long in frames of any size.
    const bool tables = settings.environment.shadows.whole == render::WholeLight::Cache;
    double ofTables = 0;
    const auto seconds = [&](int lights) {
        probe.environment.shadows.lights = lights;
        renderer.render(probe); // the first of a kind takes longer
        const render::FrameStatistics frame = renderer.render(probe);
        ofTables = tables ? 1e-3 * frame.milliseconds("whole light") : 0.0;
        return 1e-3 * frame.deviceMilliseconds - ofTables;
    };
    const double few = seconds(fewLights), many = seconds(manyLights);
    const auto pixelsOf = [&](const render::Settings& of) {
        const Window made = render::outputWindow(of);
        const double more = 2.0 * render::frameLayout(of, renderer.scene()).margin;
        return (made.width() + more) * (made.height() + more);
    };
    const double pixels = pixelsOf(settings) / pixelsOf(probe);
    const double each = std::max(many - few, 1e-3 * many) / (manyLights - fewLights);
    return { pixels * each, pixels * std::max(few - fewLights * each, 0.0) + ofTables };
}

} // namespace

void applyShadows(const RenderOptions& o, const render::PreparedScene& scene, render::Settings& s)
{
    render::ShadowSettings& to = s.environment.shadows;
    to.shadows = o.shadows.value_or(render::Shadows::Sampled);
    const std::string option = shadowsOption(o);
    const bool sampled = to.shadows == render::Shadows::Sampled;
    refuse(!sampled && scene.picture() == nullptr, "without an environment", option, "add [environment] to the scene");
    const std::string without = o.shadows ? "with " + option : "without --shadows";
    refuse(sampled && o.shadowSeconds, without, shadowTime(o), "add --shadows ratio");
    refuse(o.shadowSeconds && o.shadowLights, "with " + shadowTime(o), shadowLights(o), "leave out --shadow-time");
    refuse(o.shadowSeconds && o.shadowBlockSide, "with " + shadowTime(o), shadowScale(o), "leave out --shadow-time");
    refuse(sampled && o.shadowLights, without, shadowLights(o), "add --shadows ratio");
    refuse(o.shadowComplete && (sampled || to.shadows == render::Shadows::Additive), without, shadowComplete(o),
        "add --shadows ratio");
    refuse(o.shadowClamp && to.shadows != render::Shadows::Subtractive, without, shadowClamp(o),
        "add --shadows subtractive");
    refuse(o.shadowBlockSide && (sampled || to.shadows == render::Shadows::Additive), without, shadowScale(o),
        "add --shadows ratio");
    refuse(o.shadowBlockSide.value_or(1) > 1 && o.shadowComplete == render::WholeLight::Lights,
        "with --shadow-complete lights", shadowScale(o), "choose another whole light");
    refuse(!sampled && o.environmentWidths, "with " + option, "--environment-widths", "leave out --shadows");
    to.lights = o.shadowLights.value_or(to.lights);
    to.chosen = o.chosenLights.value_or(to.chosen);
    to.blockSide = o.shadowBlockSide.value_or(to.blockSide);
    to.whole = o.shadowComplete.value_or(to.whole);
    to.clamp = o.shadowClamp.value_or(to.clamp);
    if (!sampled) {
        render::requirePlaces(*scene.picture(), static_cast<std::size_t>(to.lights));
    }
}

void refuseShadows(const RenderOptions& o, const std::string& with, const std::string& remedy)
{
    refuse(o.shadows.has_value(), with, shadowsOption(o), remedy);
    refuse(o.shadowSeconds || o.shadowLights || o.shadowBlockSide || o.shadowComplete || o.shadowClamp, with,
        shadowOfThem(o), remedy);
}

std::string chooseShadows(render::Renderer& renderer, double seconds, render::Settings& settings)
{
    render::ShadowSettings& s = settings.environment.shadows;
    const TimeModel model = timesOfFrames(renderer, settings);
    const render::EnvironmentPicture& picture = *renderer.scene().picture();
    const render::PlaceGrid places = render::placeGrid(picture.width, picture.height);
    const int most = std::min(render::mostShadowLights, places.columns * places.rows);
    const int enough = std::min(render::ShadowSettings().lights, most);
    const bool scales = s.shadows != render::Shadows::Additive && s.whole != render::WholeLight::Lights;
    double expected = 0;
    for (const int side : shadowBlockSides) {
        if (side > 1 && (!scales || settings.width * settings.height < side * side)) {
            break;
        }
        const double each = std::max(model.each / (side * side), 1e-12);
        s.blockSide = side;
        s.lights = static_cast<int>(std::clamp((seconds - model.constant) / each, 1.0, static_cast<double>(most)));
        expected = model.constant + each * s.lights;
        if (s.lights >= enough) {
            break;
        }
    }
    std::string chosen = fmt::format("--shadow-lights {} --shadow-scale {}: about {:.3g} s",
        render::shadowLightsText(s), render::shadowScaleText(s), expected);
    if (expected > 1.05 * seconds) {
        warn(message("frames of few lights take longer", fmt::format("--shadow-time {}", seconds),
            fmt::format("the least there is was chosen: {}", chosen)));
    }
    return chosen;
}

} // namespace wedge::app
