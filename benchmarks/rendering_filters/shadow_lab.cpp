#include "benchmarks/rendering_filters/shadow_lab.h"

#include "benchmarks/common/lab.h"
#include "host/error.h"
#include "host/image/metrics.h"
#include "host/render/report.h"
#include "host/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace wedge::benchmark {
namespace {

/// Lights that the smallest of maps has places for (effects/shadow_lights/map_lights.h).
constexpr int mostEqualLights = 2048;
constexpr int mostEqualSpp = 4096;
/// Counts are chosen so often, or until times differ by no more than this fraction.
constexpr double equalEnough = 0.05;
constexpr int mostTries = 3;

/// What is said of the frames of one setting.
struct Gathered {
    std::vector<ImageErrors> errors {};
    std::vector<double> fromLights {}, milliseconds {};
};

} // namespace

int claimedLights(const ShadowPlan& plan)
{
    constexpr int usual = 40;
    return std::ranges::find(plan.lights, usual) != plan.lights.end() ? usual : std::ranges::max(plan.lights);
}

const ShadowPoint* pointOf(
    const std::vector<ShadowPoint>& points, const std::string& way, int count, const std::string& timeOf)
{
    const auto found = std::ranges::find_if(points, [&](const ShadowPoint& point) {
        return point.way == way && point.timeOf == timeOf && (point.count == count || !timeOf.empty());
    });
    return found != points.end() ? &*found : nullptr;
}

ShadowLab::ShadowLab(const ShadowScene& source, const device::Device& device, const ShadowPlan& plan)
    : plan_(plan)
    , name_(source.name)
    , renderer_(scene::loadScene(source.file()), device)
    , truth_(truth(source))
    , ofLights_(ofLights())
{
}

render::Settings ShadowLab::sized(render::Settings settings) const
{
    settings.width = plan_.width;
    settings.height = plan_.height;
    settings.seed = 1;
    return settings;
}

Truth ShadowLab::truth(const ShadowScene& source)
{
    if (renderer_.scene().picture() == nullptr) {
        throw Error("scene", source.name, "give it an [environment] that lights can stand for");
    }
    const render::Settings settings =
        source.plainReference ? render::monteCarlo(plan_.referenceSpp) : render::axisAligned(plan_.referenceSpp);
    return obtainTruth(renderer_, sized(settings), plan_.referenceFolder, name_);
}

image::RgbImage ShadowLab::ofLights()
{
    const render::Settings settings = ofWay(shadowWays({ additiveWay }).front(), plan_.referenceLights).settings;
    return obtainReference(renderer_, settings, plan_.referenceFolder, name_ + "_lights").image;
}

ShadowLab::Setting ShadowLab::ofWay(const ShadowWay& way, int lights) const
{
    Setting out { { .way = way.name, .count = lights }, sized(render::axisAligned(plan_.spp)) };
    render::ShadowSettings& shadows = out.settings.environment.shadows;
    shadows.lights = lights;
    way.set(shadows);
    shadows.chosen = std::min(shadows.chosen, lights);
    return out;
}

ShadowLab::Setting ShadowLab::plain(int spp) const
{
    return { { .way = plainWay, .count = spp }, sized(render::monteCarlo(spp)), true };
}

std::vector<ShadowPoint> ShadowLab::measure(const std::vector<Setting>& settings)
{
    std::vector<ShadowPoint> out;
    out.reserve(settings.size());
    for (const Setting& setting : settings) {
        renderer_.rehearse(setting.settings);
        out.push_back(setting.head);
    }
    std::vector<Gathered> gathered(settings.size());
    for (int seed = 1; seed <= plan_.seeds; ++seed) {
        for (std::size_t i = 0; i < settings.size(); ++i) {
            render::Settings frameSettings = settings[i].settings;
            frameSettings.seed = static_cast<std::uint32_t>(seed);
            const render::FrameStatistics frame = renderer_.render(frameSettings);
            gathered[i].milliseconds.push_back(frame.deviceMilliseconds);
            if (seed > 1 && !settings[i].isNoisy) {
                continue; // the same image
            }
            const image::RgbImage image = imageOf(renderer_, frameSettings, frame);
            gathered[i].errors.push_back(truth_.errorsOf(image));
            gathered[i].fromLights.push_back(image::rmse(image, ofLights_));
            out[i].rays = render::raysPerPixel(frame, frameSettings);
            out[i].clampedPixels = frame.clampedPixels;
        }
    }
    for (std::size_t i = 0; i < settings.size(); ++i) {
        out[i].errors = averaged(gathered[i].errors);
        out[i].fromLights = summarize(gathered[i].fromLights).median;
        out[i].milliseconds = summarize(gathered[i].milliseconds);
    }
    return out;
}

ShadowPoint ShadowLab::ofEqualTime(
    const ShadowPoint& other, std::vector<CountTime> timed, int mostCount, const std::function<Setting(int)>& of)
{
    const double wanted = other.milliseconds.median;
    const auto away = [&](const ShadowPoint& p) { return std::abs(std::log(p.milliseconds.median / wanted)); };
    std::optional<ShadowPoint> best;
    for (int tries = 0; tries < mostTries && !(best && away(*best) <= equalEnough); ++tries) {
        const double count = std::clamp(countOfTime(timed, wanted), 1.0, 1.0 * mostCount);
        const ShadowPoint point = measure({ of(static_cast<int>(std::lround(count))) }).front();
        timed.push_back({ point.count, point.milliseconds.median });
        if (!best || away(point) < away(*best)) {
            best = point;
        }
    }
    best->timeOf = other.way;
    return *best;
}

void ShadowLab::addOfEqualTime(std::vector<ShadowPoint>& out, const std::vector<ShadowWay>& ways)
{
    const auto timesOf = [](const std::vector<ShadowPoint>& points, const std::string& way) {
        std::vector<CountTime> timed;
        for (const ShadowPoint& point : points) {
            if (point.way == way) {
                timed.push_back({ point.count, point.milliseconds.median });
            }
        }
        return timed;
    };
    const auto add = [&](const ShadowPoint& point) { out.push_back(point); };
    add(ofEqualTime(*pointOf(out, filteredWay, plan_.spp), timesOf(measure({ plain(4), plain(16) }), plainWay),
        mostEqualSpp, [this](int spp) { return plain(spp); }));
    const auto additive = std::ranges::find(ways, additiveWay, &ShadowWay::name);
    if (const ShadowPoint* other = pointOf(out, subtractiveWay, claimedLights(plan_));
        other != nullptr && additive != ways.end()) {
        add(ofEqualTime(*other, timesOf(out, additiveWay), mostEqualLights,
            [&, this](int lights) { return ofWay(*additive, lights); }));
    }
}

std::vector<ShadowPoint> ShadowLab::measureAll(const std::vector<ShadowWay>& ways)
{
    std::vector<Setting> settings { { { .way = filteredWay, .count = plan_.spp }, sized(render::axisAligned(plan_.spp)),
        true } };
    for (const ShadowWay& way : ways) {
        for (const int lights : plan_.lights) {
            settings.push_back(ofWay(way, lights));
        }
    }
    std::vector<ShadowPoint> out = measure(settings);
    addOfEqualTime(out, ways);
    return out;
}

} // namespace wedge::benchmark
