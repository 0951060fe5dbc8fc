#pragma once

#include "benchmarks/common/measure_plan.h"
#include "benchmarks/common/scene_source.h"
#include "benchmarks/denoiser/open_image_denoise.h"
#include "benchmarks/rendering_filters/filter_variants.h"
#include "benchmarks/rendering_filters/image_errors.h"
#include "host/device/device.h"
#include "host/render/renderer.h"

#include <cstdint>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// How much is measured.
struct FilterPlan : MeasurePlan {
    FilterPlan()
    {
        width = 96;
        height = 72;
        referenceSpp = 8192;
        seeds = 1;
    }
    int bounces = 3;
    bool antialias = false; ///< samples lie all over their pixels, and are filtered by their brightness
    std::vector<int> spp { 8, 64, 256, 1024 }; ///< of method mc
    std::vector<int> filteredSpp { 16, 64 }; ///< of method aaf, without a filter of samples and with path-density
    const OpenImageDenoise* denoiser = nullptr; ///< what the same images are denoised by as well; null: they are not
};

/// Images of one method, filter and count.
struct FilterPoint {
    render::Method method = render::Method::MonteCarlo;
    std::string variant;
    int spp = 0;
    ImageErrors beauty, indirect;
    double tracing = 0, filter = 0, total = 0; ///< milliseconds of the device, medians over the seeds
    double denoising = 0; ///< likewise, of the host; 0 where nothing is denoised
    std::uint64_t memory = 0; ///< bytes on the device, of frames without layers
};

/// One scene on one device.
class FilterLab {
public:
    /// plan must outlive the lab.
    FilterLab(const SceneSource& source, const device::Device& device, const FilterPlan& plan);

    /// By method, then count, then variant; what is denoised follows what it is made of.
    std::vector<FilterPoint> measureAll(const std::vector<FilterVariant>& variants);

    const Truth& beauty() const { return beauty_; }
    const Truth& indirect() const { return indirect_; }

private:
    render::Settings sized(render::Settings settings, std::uint32_t seed) const;
    Truth truth(const std::string& layer);
    void measure(std::vector<FilterPoint>& out, const render::Settings& wanted, int spp, const FilterVariant& variant);
    Denoised denoised(const render::Settings& settings, const render::FrameStatistics& frame);

    const FilterPlan& plan_;
    std::string name_;
    render::Renderer renderer_;
    Truth beauty_, indirect_;
};

} // namespace wedge::benchmark
