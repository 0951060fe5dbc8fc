#include "host/app/commands.h"
#include "host/app/console.h"
#include "host/app/finished_frames.h"
#include "host/app/outputs.h"
#include "host/app/pass_table.h"
#include "host/app/reference.h"
#include "host/app/render_job.h"
#include "host/app/render_settings.h"
#include "host/app/shadow_settings.h"
#include "host/device/device.h"
#include "host/device/source.h"
#include "host/error.h"
#include "host/files_opened.h"
#include "host/render/distributed_frame.h"
#include "host/render/layers.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace wedge::app {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::vector<Output> outputsOf(const RenderOptions& options)
{
    return options.outputs.empty() ? defaultOutputs(options.scene, { options.reference, options.report })
                                   : planOutputs(options.outputs);
}

} // namespace

RenderJob::RenderJob(const RenderOptions& options)
    : options_(options)
    , images_(outputsOf(options), look())
    , progress_(!options.quiet)
{
}

int RenderJob::run()
{
    checkCall();
    load();
    if (options_.frames) {
        return runFrames();
    }
    build();
    if (!options_.explain.empty()) {
        explain();
        return 0;
    }
    warnOfPicture();
    prepare();
    try {
        render();
    } catch (...) {
        // An earlier image of a progressive render may be all that there will be.
        finishImages();
        std::ranges::for_each(failures_, complain);
        throw;
    }
    finish();
    if (!failures_.empty()) {
        throw Errors(failures_);
    }
    return interrupted_ ? statusInterrupted : 0;
}

/// What can be refused before any work.
void RenderJob::checkCall() const
{
    if (options_.quiet && options_.verbose) {
        throw UsageError("options contradict each other", "--quiet --verbose", "give one of them");
    }
    if (options_.devices.size() > 1) {
        throw UsageError("several devices cannot render one image yet", options_.devices[1], "give one --device");
    }
    const std::pair<const char*, bool> ofImages[] = { { "-o", !options_.outputs.empty() },
        { "--report", !options_.report.empty() }, { "--reference", !options_.reference.empty() } };
    for (const auto& [name, given] : ofImages) {
        if (given && !options_.explain.empty()) {
            throw UsageError("--explain renders nothing", name, "leave one of them out");
        }
    }
    if (options_.shadowSeconds && (options_.frames || !options_.explain.empty())) {
        throw UsageError(
            "lights are chosen by time for single images", "--shadow-time", "give --shadow-lights and --shadow-scale");
    }
    if (!options_.programs.empty() && options_.explain.empty()) {
        throw UsageError("programs are written of frames that are explained", "--programs", "add --explain FILE.svg");
    }
    const std::vector<Output>& outputs = images_.outputs();
    const bool anyExr = std::ranges::any_of(outputs, [](const Output& o) { return o.format == ImageFormat::Exr; });
    if (!options_.layers.empty() && !anyExr) {
        throw UsageError("layers have no file to go to", options_.layers, "add an output that ends in .exr");
    }
    checkView();
    if (!options_.kernelDir.empty()) {
        device::requireKernelFolder(options_.kernelDir);
    }
    std::vector<std::string> written = { options_.report, options_.explain };
    std::ranges::transform(outputs, std::back_inserter(written), &Output::path);
    refuseOverwriting(written, { options_.scene, options_.reference });
    checkFrames();
    requireWritable(options_.frames ? frameOutputs(outputs, options_.frames->first) : outputs,
        options_.explain.empty() ? options_.report : options_.explain);
}

void RenderJob::checkView() const
{
    const std::vector<Output>& outputs = images_.outputs();
    const bool anyPng = std::ranges::any_of(outputs, [](const Output& o) { return o.format == ImageFormat::Png; });
    if (options_.view && !anyPng) {
        throw UsageError("a view has no picture to go to", "--view", "add an output that ends in .png");
    }
}

void RenderJob::leaveOutInputs()
{
    std::vector<Output> outputs = images_.outputs();
    leaveOutOpened(outputs);
    if (outputs.size() < images_.outputs().size()) {
        images_ = ImageWriter(outputs, look());
        checkView();
    }
}

void RenderJob::keepInputs()
{
    const bool images = options_.explain.empty(), named = !options_.outputs.empty();
    if (images && !named) {
        leaveOutInputs();
    }
    std::vector<std::string> written = { options_.report, options_.explain };
    const auto add = [&written](const std::vector<Output>& outputs) {
        std::ranges::transform(outputs, std::back_inserter(written), &Output::path);
    };
    for (std::uint32_t i = 0; options_.frames && i < options_.frames->count(); ++i) {
        add(frameOutputs(images_.outputs(), options_.frames->first + i));
    }
    if (images && !options_.frames) {
        add(images_.outputs());
    }
    requireNotOpened(written, images && !named ? "name outputs with -o" : "give it a name of its own");
}

/// A call that names no outputs takes no picture that is not its own.
void RenderJob::warnOfPicture() const
{
    if (options_.outputs.empty() && images_.outputs().size() == 1 && !options_.quiet) {
        const std::string& exr = images_.outputs().front().path;
        warn(message("no picture is written, since its file is read or was not written by wedge",
            std::filesystem::path(exr).replace_extension(".png").string(), "name outputs with -o"));
    }
}

void RenderJob::load()
{
    const Clock::time_point start = Clock::now();
    progress_.show("reading " + options_.scene);
    scene::Scene scene;
    if (options_.frames) {
        sequence_.emplace(options_.scene, options_.load);
        scene = sequence_->takeScene();
        scene.framesPerUnit = options_.fps.value_or(scene.framesPerUnit);
    } else {
        scene = scene::loadScene(options_.scene, options_.load);
    }
    extras_.loadMilliseconds = millisecondsSince(start);
    progress_.clear();
    keepInputs();
    if (!options_.quiet) {
        warnOf(scene.warnings);
    }
    applyLens(options_, scene);
    for (const render::SceneChange& change : options_.changes) {
        change(scene);
    }
    loaded_.emplace(std::move(scene));
    settings_ = resolveSettings(options_, *loaded_);
    layers_ = render::selectLayers(options_.layers, settings_, *loaded_);
    if (!options_.reference.empty()) {
        reference_ = readReference(options_.reference, settings_);
        extras_.reference = options_.reference;
    }
    keepInputs(); // what options read is among them
}

/// What there is before memory is planned: the device, the hierarchy, and the programs' options.
void RenderJob::build()
{
    const device::Device device = device::Device::open(options_.devices.empty() ? "" : options_.devices[0]);
    if (!options_.quiet) {
        warnOf(device::deviceNotices());
    }
    render::Options options;
    options.kernelDir = options_.kernelDir;
    options.fastMath = options_.fastMath;
    options.bvh = options_.bvh.value_or(bvh::Mode::Default);
    options.traversal = options_.traversal.value_or(render::Traversal::Automatic);
    options.checkLaunches = options_.checkLaunches;
    options.memoryLimit = options_.memoryLimitBytes;
    options.compiler = ownProgram();
    options.onCompile = [this](std::size_t kernels) {
        progress_.show(fmt::format("compiling {} kernels, once for frames of this kind on this device", kernels));
    };
    progress_.show("building the hierarchy");
    renderer_ = std::make_unique<render::Renderer>(std::move(*loaded_), device, options);
    loaded_.reset();
    progress_.clear();
}

void RenderJob::explain()
{
    const render::Explanation explanation = renderer_->explain(settings_, !layers_.empty());
    keepInputs();
    say("{}", explanation.text);
    writeText(options_.explain, explanation.drawing);
    tell("wrote {}\n", printable(options_.explain));
    if (!options_.programs.empty()) {
        writePrograms();
    }
    std::fflush(stdout);
}

void RenderJob::writePrograms() const
{
    const std::filesystem::path folder = options_.programs;
    const auto files =
        device::programFiles(renderer_->programOptions(), renderer_->programs(settings_, !layers_.empty()));
    for (const auto& [name, text] : files) {
        std::error_code failed;
        std::filesystem::create_directories((folder / name).parent_path(), failed);
        if (failed) {
            throw Error(fmt::format("folder of programs ({})", failed.message()), options_.programs,
                "name a folder that can be written to with --programs");
        }
        writeText((folder / name).string(), text);
    }
    tell("wrote {} files to {}\n", files.size(), printable(options_.programs));
}

void RenderJob::prepare()
{
    if (options_.shadowSeconds) {
        progress_.show("choosing lights for --shadow-time");
        const std::string chosen = chooseShadows(*renderer_, *options_.shadowSeconds, settings_);
        progress_.clear();
        tell("{}\n", chosen);
    }
    const device::DeviceInfo& device = renderer_->device().info();
    const device::MemoryPlan plan = renderer_->plan(settings_, keepsLayers());
    tell("scene {}: {} triangles\n", printable(scene().path), scene().geometry.indices.size() / 3);
    tell("device {} ({})\n", device.name, device.platform);
    if (options_.verbose) {
        tell("traversal {}\nbvh {}\n", render::traversalName(renderer_->traversal()),
            bvh::modeName(renderer_->bvhMode()));
        for (const auto& [name, value] : render::describe(settings_)) {
            tell("{} {}\n", name, value);
        }
        tell("device memory\n{}", plan.table());
    } else {
        tell("device memory {}\n", device::mebibytes(plan.total()));
    }
    std::fflush(stdout);
    progress_.show("building kernels");
    renderer_->rehearse(settings_, keepsLayers());
    progress_.clear();
    keepInputs(); // kernels of --kernel-dir are among them
}

void RenderJob::render()
{
    // Before this, an interrupt simply ends the program: there is nothing yet to write.
    guard_.emplace();
    if (options_.verbose) {
        tell("kernels ready after {:.1f} s\n", renderer_->setupSeconds());
        std::fflush(stdout);
    }
    render::Control control;
    control.cancel = &guard_->flag();
    control.timeLimitSeconds = options_.timeLimitSeconds;
    control.progress = [this](double fraction) {
        fraction_ = fraction;
        progress_.update(fraction);
    };
    if (settings_.progressive) {
        renderSteps(control);
    } else {
        statistics_ = renderer_->render(settings_, control, !layers_.empty());
    }
    progress_.clear();
    interrupted_ = !statistics_.complete && guard_->flag();
    if (!statistics_.complete) {
        put(stderr,
            fmt::format("wedge: {} at {:.0f} %: writing what is there\n",
                interrupted_ ? "interrupted" : "time limit reached", 100 * fraction_));
    }
    if (settings_.progressive) {
        extras_.ended = endOfSteps();
    } else {
        write();
    }
    finishImages();
    warnOfSamples();
    writeReport();
}

void RenderJob::renderSteps(const render::Control& control)
{
    render::Control until = control;
    until.targetError = options_.targetError.value_or(0);
    extras_.targetError = options_.targetError;
    statistics_ = renderer_->renderProgressively(
        settings_, until, [this](const render::ProgressiveStep& step) { showStep(step); }, !layers_.empty());
}

/// Writes the image so far and says how good it is.
void RenderJob::showStep(const render::ProgressiveStep& step)
{
    progress_.clear();
    statistics_ = step.statistics;
    write();
    extras_.steps.push_back(step);
    extras_.steps.back().statistics.passes.clear();
    const double error = step.error.rmse();
    tell("{} spp, {:.1f} rays a pixel, {:.1f} s: error {}\n", step.spp, render::raysPerPixel(statistics_, settings_),
        1e-3 * statistics_.wallMilliseconds, std::isnan(error) ? "unknown" : fmt::format("{:.3g}", error));
    std::fflush(stdout);
}

std::string RenderJob::endOfSteps() const
{
    if (!statistics_.complete) {
        return interrupted_ ? "interrupt" : "time limit";
    }
    return extras_.steps.back().error.rmse() <= options_.targetError.value_or(0) ? "target error" : "samples";
}

/// The image that the renderer has now.
void RenderJob::write()
{
    auto read = render::readLayers(*renderer_, settings_, statistics_, layers_);
    if (settings_.frame) {
        read.metadata["inputs"] = frameInputs(inputs_, *settings_.frame);
    }
    const auto image = std::make_shared<const image::LayeredImage>(std::move(read));
    const std::vector<std::string> errors = images_.write(image);
    if (settings_.progressive && !options_.quiet) {
        for (const std::string& error : errors) {
            warn(error + "; trying again after the next step");
        }
    }
    if (reference_) {
        extras_.error = image::compare(image::beauty(*image), *reference_);
        if (!options_.quiet) {
            warnOfInvalidPixels(extras_.error->invalidPixels, *reference_);
        }
    }
}

void RenderJob::finishImages()
{
    std::ranges::copy(images_.finish(), std::back_inserter(failures_));
    extras_.files = images_.written();
}

std::vector<render::FrameStatistics> RenderJob::shown() const
{
    return options_.frames ? rendered_ : std::vector { statistics_ };
}

void RenderJob::warnOfSamples() const
{
    std::uint64_t count = 0;
    for (const render::FrameStatistics& frame : shown()) {
        count += frame.notFiniteSamples.value_or(0);
    }
    if (count > 0 && !options_.quiet) {
        warn(fmt::format("samples of indirect light that are not finite, which are left out: {}", count));
    }
}

void RenderJob::writeReport()
{
    if (options_.report.empty()) {
        return;
    }
    try {
        writeText(options_.report, render::jsonReport(*renderer_, settings_, shown(), extras_));
        reported_ = true;
    } catch (const Error& error) {
        failures_.emplace_back(error.what());
    } catch (const std::exception& error) {
        failures_.push_back(
            message(fmt::format("cannot write report ({})", error.what()), options_.report, "write elsewhere"));
    }
}

void RenderJob::finish()
{
    tell("\n{}", passTable(statistics_, settings_));
    if (extras_.error) {
        tell("error against {}: {}\n", printable(extras_.reference), describe(*extras_.error));
    }
    for (const std::string& path : images_.written()) {
        tell("wrote {}\n", printable(path));
    }
    if (reported_) {
        tell("wrote {}\n", printable(options_.report));
    }
    std::fflush(stdout);
}

void addRenderCommand(CLI::App& parser, Action& action)
{
    CLI::App* command = parser.add_subcommand("render", "Render a scene to an image");
    const auto options = std::make_shared<RenderOptions>();
    addRenderOptions(*command, *options);
    command->callback([options, &action] { action = [options] { return RenderJob(*options).run(); }; });
}

} // namespace wedge::app
