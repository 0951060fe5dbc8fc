#pragma once

#include "benchmarks/common/equal_time.h"
#include "benchmarks/common/measure_plan.h"
#include "benchmarks/common/statistics.h"
#include "benchmarks/rendering_filters/image_errors.h"
#include "benchmarks/rendering_filters/shadow_scenes.h"
#include "benchmarks/rendering_filters/shadow_ways.h"
#include "host/device/device.h"
#include "host/render/renderer.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// How much is measured.
struct ShadowPlan : MeasurePlan {
    ShadowPlan()
    {
        width = 240;
        height = 180;
        referenceSpp = 2048;
    }
    std::vector<int> lights { 15, 25, 40, 60, 100 };
    int spp = 28; ///< of method aaf, the default
    int referenceLights = 1000; ///< of the second reference, additive
};

/// Methods without such lights.
inline constexpr const char* filteredWay = "aaf";
inline constexpr const char* plainWay = "mc";

/// Images of one way and one count.
struct ShadowPoint {
    std::string way;
    int count = 0; ///< lights, or samples a pixel of filteredWay and plainWay
    /// The way whose time the count was chosen for; empty where the plan has the count.
    std::string timeOf = {};
    ImageErrors errors = {}; ///< from the reference by samples
    double fromLights = 0; ///< RMS of linear radiance from the reference by lights
    double rays = 0; ///< a pixel, the camera's among them
    Summary milliseconds = {}; ///< of the device, a frame
    std::optional<std::uint64_t> clampedPixels = {}; ///< none where nothing is clamped
};

/// The point of that way, count and ShadowPoint::timeOf, "" for none; null where there is none.
const ShadowPoint* pointOf(
    const std::vector<ShadowPoint>& points, const std::string& way, int count, const std::string& timeOf = "");

/// One scene on one device.
class ShadowLab {
public:
    /// plan must outlive the lab. Throws Error where the scene has no map.
    ShadowLab(const ShadowScene& source, const device::Device& device, const ShadowPlan& plan);

    /// Method aaf; every way with each of the plan's counts of lights; then what takes as long as others: method mc as
    /// method aaf, and additive as subtractive with claimedLights(), where both are among the ways. Frames of a setting
    /// are not one after the other but in turns with those of others, so that what else the machine does falls on all.
    std::vector<ShadowPoint> measureAll(const std::vector<ShadowWay>& ways);

    const Truth& truth() const { return truth_; }

private:
    /// A point without its numbers, and the frames that it is of.
    struct Setting {
        ShadowPoint head;
        render::Settings settings;
        bool isNoisy = false; ///< seeds make a difference
    };

    render::Settings sized(render::Settings settings) const;
    Truth truth(const ShadowScene& source);
    image::RgbImage ofLights();
    Setting ofWay(const ShadowWay& way, int lights) const;
    Setting plain(int spp) const;
    std::vector<ShadowPoint> measure(const std::vector<Setting>& settings);
    ShadowPoint ofEqualTime(
        const ShadowPoint& other, std::vector<CountTime> timed, int mostCount, const std::function<Setting(int)>& of);
    void addOfEqualTime(std::vector<ShadowPoint>& out, const std::vector<ShadowWay>& ways);

    const ShadowPlan& plan_;
    std::string name_;
    render::Renderer renderer_;
    Truth truth_;
    image::RgbImage ofLights_; ///< the reference by lights
};

/// Lights that claims are of: 40 where the plan has them, else its most.
int claimedLights(const ShadowPlan& plan);

} // namespace wedge::benchmark
