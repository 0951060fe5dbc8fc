// What `wedge render --frames` does: the frames of a sequence, one after the other.
#include "host/app/commands.h"
#include "host/app/finished_frames.h"
#include "host/app/frame_names.h"
#include "host/app/outputs.h"
#include "host/app/render_job.h"
#include "host/app/render_settings.h"
#include "host/error.h"
#include "host/render/distributed_frame.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>

namespace wedge::app {

/// Of a sequence: what does not go with it, and that every frame has files of its own.
void RenderJob::checkFrames() const
{
    if (!options_.frames) {
        if (options_.fps) {
            throw UsageError("option has no effect without --frames", "--fps", "leave it out, or add --frames");
        }
        if (options_.temporal) {
            throw UsageError("option has no effect without --frames", "--temporal", "leave it out, or add --frames");
        }
        return;
    }
    const std::pair<const char*, bool> others[] = { { "--progressive", options_.progressive },
        { "--reference", !options_.reference.empty() }, { "--explain", !options_.explain.empty() } };
    for (const auto& [name, given] : others) {
        if (given) {
            throw UsageError("option does not go with --frames", name, "leave one of them out");
        }
    }
    if (options_.outputs.empty()) {
        throw UsageError("a sequence needs a name for its frames", "--frames", "add -o name.%04d.exr");
    }
    std::set<std::filesystem::path> names;
    for (std::uint32_t i = 0; i < options_.frames->count(); ++i) {
        const std::vector<Output> outputs = frameOutputs(images_.outputs(), options_.frames->first + i);
        std::vector<std::string> written = { options_.report };
        for (const Output& output : outputs) {
            if (!names.insert(std::filesystem::path(output.path).lexically_normal()).second) {
                throw UsageError("output is named twice", output.path, "give each frame a file of its own");
            }
            written.push_back(output.path);
        }
        refuseOverwriting(written, { options_.scene });
    }
}

/// The frames that are not there yet.
void RenderJob::findUnfinished()
{
    const FrameRange range = *options_.frames;
    inputs_ = sequenceInputs(options_, settings_, scene().framesPerUnit, sequence_->contents());
    extras_.sequence = { range.first, range.last, scene().framesPerUnit, {}, "frames" };
    for (std::uint32_t i = 0; i < range.count(); ++i) {
        const std::uint32_t frame = range.first + i;
        const std::vector<Output> outputs = frameOutputs(images_.outputs(), frame);
        // Kernels of one's own may have changed since.
        const bool there = options_.kernelDir.empty() && std::ranges::all_of(outputs, [&](const Output& o) {
            return isFinished(o, frameInputs(inputs_, frame));
        });
        (there ? extras_.sequence->skipped : unfinished_).push_back(frame);
    }
}

/// The scene and the settings of a frame.
void RenderJob::moveTo(std::uint32_t frame)
{
    scene::Moment moment = sequence_->at(frame / scene().framesPerUnit);
    scene::Change change = scene::changeTo(moment, scene());
    const auto alter = [&](scene::Scene& altered) {
        scene::apply(std::move(moment), change, altered);
        applyLens(options_, altered);
    };
    if (renderer_) {
        renderer_->changeScene(change, alter);
    } else {
        loaded_->change(change, alter);
    }
    if (tracker_ && (change.geometry || !places_)) {
        places_ = std::make_shared<const filters::ObjectPlaces>(tracker_->placesIn(scene().geometry));
    }
    settings_ = resolveSettings(options_, scene());
    settings_.frame = frame;
    // A mean over frames of the same numbers were none.
    settings_.sameNumbers = scene().onlyStylesChange && !filtersOverTime();
}

/// What is rendered for the frames that are not there yet: these, and those of which they are made, too.
void RenderJob::planVisits()
{
    for (const std::uint32_t frame : unfinished_) {
        const std::uint32_t before = visits_.empty() ? 0 : visits_.back().frame + 1;
        const std::uint32_t first =
            filtersOverTime() ? std::max(before, filters::firstOfWindow(frame, settings_.temporal)) : frame;
        for (std::uint32_t each = first; each <= frame; ++each) {
            visits_.push_back({ each, each == frame });
        }
    }
}

int RenderJob::runFrames()
{
    findUnfinished();
    const std::size_t skipped = extras_.sequence->skipped.size();
    if (skipped > 0) {
        tell("{} of {} frames are there and left as they are\n", skipped, options_.frames->count());
    }
    if (unfinished_.empty() && options_.report.empty()) {
        return 0;
    }
    planVisits();
    if (filtersOverTime() && sequence_->at(0.0).geometry) {
        tracker_.emplace(scene().geometry);
    }
    moveTo(visits_.empty() ? options_.frames->first : visits_.front().frame);
    build();
    if (filtersOverTime()) {
        temporal_ = std::make_shared<filters::TemporalFilter>(renderer_->device());
        renderer_->filterFrames(temporal_);
    }
    runVisits();
    warnOfSamples();
    writeReport();
    if (!failures_.empty()) {
        throw Errors(failures_);
    }
    return interrupted_ ? statusInterrupted : 0;
}

/// Compiles what the frame needs, where that may not have been.
void RenderJob::prepareFrame(bool first)
{
    const bool distributed = render::isDistributed(settings_, scene());
    if (rehearsed_ == distributed) {
        return;
    }
    if (first) {
        prepare();
    } else {
        renderer_->rehearse(settings_, keepsLayers());
    }
    rehearsed_ = distributed;
}

void RenderJob::runVisits()
{
    const std::vector<Output> patterns = images_.outputs();
    Clock::time_point start {};
    for (std::size_t i = 0; i < visits_.size(); ++i) {
        const Visit& visit = visits_[i];
        if (i > 0) {
            moveTo(visit.frame);
        }
        prepareFrame(i == 0);
        if (i == 0) {
            guard_.emplace(); // before this, an interrupt simply ends the program
            start = Clock::now();
            if (options_.verbose) {
                tell("kernels ready after {:.1f} s\n", renderer_->setupSeconds());
                std::fflush(stdout);
            }
        }
        images_ = ImageWriter(frameOutputs(patterns, visit.frame), look());
        if (!renderFrame(visit, i, start)) {
            interrupted_ = guard_->flag();
            extras_.sequence->ended = interrupted_ ? "interrupt" : "time limit";
            put(stderr,
                fmt::format("wedge: {} in frame {}, which is not written: call again to go on from there\n",
                    interrupted_ ? "interrupted" : "time limit reached", visit.frame));
            break;
        }
    }
}

bool RenderJob::renderFrame(const Visit& visit, std::size_t number, Clock::time_point start)
{
    const double left = options_.timeLimitSeconds - std::chrono::duration<double>(Clock::now() - start).count();
    if (guard_->flag() || (options_.timeLimitSeconds > 0 && left <= 0)) {
        return false;
    }
    render::Control control;
    control.cancel = &guard_->flag();
    control.timeLimitSeconds = options_.timeLimitSeconds > 0 ? left : 0;
    control.progress = [&](double fraction) {
        progress_.update((static_cast<double>(number) + fraction) / static_cast<double>(visits_.size()));
    };
    if (temporal_) {
        temporal_->next(places_, visit.written);
    }
    statistics_ = renderer_->render(settings_, control, keepsLayers());
    progress_.clear();
    if (!statistics_.complete) {
        return false;
    }
    if (!visit.written) {
        return true;
    }
    write();
    finishImages();
    if (!failures_.empty()) {
        throw Errors(failures_); // the next ones would fail, too
    }
    rendered_.push_back(statistics_);
    tell("frame {}: {:.1f} rays a pixel, {:.2f} s, wrote {}\n", visit.frame,
        render::raysPerPixel(statistics_, settings_), 1e-3 * statistics_.wallMilliseconds,
        printable(fmt::format("{}", images_.written().front())));
    std::fflush(stdout);
    return true;
}

} // namespace wedge::app
