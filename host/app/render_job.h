#pragma once

#include "filters/temporal/object_motion.h"
#include "filters/temporal/temporal.h"
#include "host/app/console.h"
#include "host/app/image_writer.h"
#include "host/app/interrupt.h"
#include "host/app/progress_line.h"
#include "host/app/render_options.h"
#include "host/render/renderer.h"
#include "host/render/report.h"
#include "host/scene/sequence.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace wedge::app {

/// One call of `wedge render`, step by step.
class RenderJob {
public:
    explicit RenderJob(const RenderOptions& options);

    int run();

private:
    using Clock = std::chrono::steady_clock;

    /// A frame that is rendered: to be written, or for the sake of those after it alone.
    struct Visit {
        std::uint32_t frame;
        bool written;
    };

    void checkCall() const;
    // Of a sequence, in render_sequence.cpp.
    void checkFrames() const;
    void findUnfinished();
    void planVisits();
    void moveTo(std::uint32_t frame);
    void prepareFrame(bool first);
    int runFrames();
    void runVisits();
    /// Returns false if it was stopped.
    bool renderFrame(const Visit& visit, std::size_t number, Clock::time_point start);
    bool filtersOverTime() const { return settings_.temporal != render::Temporal::Off; }
    image::Look look() const { return { options_.exposureStops, options_.view.value_or(image::View::Srgb) }; }
    const render::PreparedScene& scene() const { return renderer_ ? renderer_->scene() : *loaded_; }
    bool keepsLayers() const { return !layers_.empty(); }

    void checkView() const;
    void warnOfPicture() const;
    /// Refuses outputs that are a file that was read until now; of those that nobody named, the picture is left out.
    void keepInputs();
    void leaveOutInputs();
    void load();
    void build();
    void explain();
    void writePrograms() const;
    void prepare();
    void render();
    void renderSteps(const render::Control& control);
    void showStep(const render::ProgressiveStep& step);
    std::string endOfSteps() const;
    void write();
    void finishImages();
    /// Those of all images that were written: of a sequence, several.
    std::vector<render::FrameStatistics> shown() const;
    void warnOfSamples() const;
    void writeReport();
    void finish();

    template <class... Args>
    void tell(fmt::format_string<Args...> format, Args&&... args) const
    {
        if (!options_.quiet) {
            say(format, std::forward<Args>(args)...);
        }
    }

    const RenderOptions& options_;
    std::optional<InterruptGuard>
        guard_; // goes last, so that no late signal ends the program before it says how it went
    ImageWriter images_;
    std::vector<std::string> failures_; // lines about outputs
    ProgressLine progress_;
    std::optional<render::PreparedScene> loaded_; ///< until the renderer has it
    render::ReportExtras extras_;
    render::Settings settings_;
    std::vector<std::string> layers_;
    std::optional<image::RgbImage> reference_;
    std::unique_ptr<render::Renderer> renderer_;
    render::FrameStatistics statistics_;
    // Of a sequence.
    std::optional<scene::Sequence> sequence_;
    std::string inputs_;
    std::vector<std::uint32_t> unfinished_;
    std::vector<Visit> visits_;
    std::optional<filters::ObjectTracker> tracker_;
    std::shared_ptr<const filters::ObjectPlaces> places_; ///< null where nothing ever moves
    std::shared_ptr<filters::TemporalFilter> temporal_;
    std::vector<render::FrameStatistics> rendered_;
    std::optional<bool> rehearsed_; // for distributed frames, or not
    bool interrupted_ = false, reported_ = false;
    double fraction_ = 0;
};

} // namespace wedge::app
