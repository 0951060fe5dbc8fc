#include "host/render/report.h"

#include "host/render/effect.h"
#include "host/render/metadata.h"

#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

namespace wedge::render {
namespace {

using Json = nlohmann::ordered_json;

/// Numbers and truth values as such, anything else as text.
Json typed(const std::string& text)
{
    if (text == "true" || text == "false") {
        return text == "true";
    }
    double number = 0;
    const char* end = text.data() + text.size();
    const auto [stop, status] = std::from_chars(text.data(), end, number);
    if (text.empty() || stop != end || status != std::errc()) {
        return text;
    }
    const auto whole = static_cast<std::int64_t>(number);
    return static_cast<double>(whole) == number ? Json(whole) : Json(number);
}

Json deviceSection(const Renderer& renderer)
{
    const device::DeviceInfo& info = renderer.device().info();
    return { { "name", info.name }, { "platform", info.platform }, { "platform_version", info.platformVersion },
        { "driver", info.driver }, { "type", device::deviceTypeName(info.type) }, { "index", info.index },
        { "compute_units", info.computeUnits }, { "host_timers", info.hostTimers },
        { "build_options", renderer.buildOptions() }, { "traversal", traversalName(renderer.traversal()) } };
}

Json sceneSection(const Renderer& renderer, std::uint64_t memoryBytes)
{
    const scene::Summary s = scene::summary(renderer.scene());
    const bvh::Statistics& b = renderer.hierarchy().statistics;
    Json out = { { "path", renderer.scene().path }, { "triangles", s.triangles }, { "vertices", s.vertices },
        { "objects", s.objects }, { "materials", s.materials }, { "textures", s.textures },
        { "area_lights", s.areaLights }, { "point_lights", s.pointLights },
        { "directional_lights", s.directionalLights }, { "geometry_bytes", s.geometryBytes },
        { "texture_bytes", s.textureBytes }, { "memory_bytes", memoryBytes },
        { "bvh",
            { { "mode", bvh::modeName(renderer.bvhMode()) }, { "nodes", b.nodes }, { "blocks", b.blocks },
                { "triangles", b.triangles }, { "degenerate", b.degenerate }, { "skipped", b.skipped },
                { "depth", b.depth }, { "sah_cost", b.sahCost }, { "bytes", b.bytes } } } };
    if (const auto picture = renderer.scene().picture()) {
        out["environment"] = environmentReport(*picture);
    }
    out.update(cameraReport(renderer.scene()));
    return out;
}

Json methodSection(const Settings& settings)
{
    Json out;
    for (const auto& [name, value] : describe(settings)) {
        out[name] = typed(value);
    }
    out["antialias"] = settings.antialias;
    out["seed"] = settings.seed;
    out["width"] = settings.width;
    out["height"] = settings.height;
    if (settings.crop.width() > 0 && settings.crop.height() > 0) {
        out["crop"] = { settings.crop.x0, settings.crop.y0, settings.crop.x1, settings.crop.y1 };
    }
    return out;
}

Json frameSection(const FrameStatistics& frame, const Settings& settings)
{
    Json passes = Json::array();
    for (const device::PassRecord& pass : frame.passes) {
        passes.push_back(
            { { "name", pass.name }, { "kind", device::passKindName(pass.kind) }, { "ms", pass.milliseconds },
                { "bytes", pass.bytes }, { "launches", pass.launches }, { "kernels", pass.kernels } });
    }
    Json out = frame.frame ? Json { { "frame", *frame.frame } } : Json::object();
    out.update(Json { { "complete", frame.complete }, { "total_ms", frame.deviceMilliseconds },
        { "wall_ms", frame.wallMilliseconds }, { "overhead_fraction", frame.overheadFraction() },
        { "spp_mean", frame.sppMean }, { "spp_primary", frame.primarySpp }, { "spp_direct", frame.directSpp },
        { "spp_indirect", frame.indirectSpp }, { "shaded_pixels", frame.shadedPixels },
        { "rays_per_pixel", raysPerPixel(frame, settings) }, { "mrays_s", megaraysPerSecond(frame) },
        { "rays",
            { { "primary", frame.primaryRays }, { "shadow", frame.shadowRays },
                { "indirect", frame.indirectRays } } } });
    if (frame.notFiniteSamples) {
        out["samples"] = { { "not_finite", *frame.notFiniteSamples } };
    }
    if (frame.clampedPixels) {
        out["shadows"] = { { "clamped_pixels", *frame.clampedPixels } };
    }
    out.update(Json { { "passes", passes }, { "memory_bytes", frame.memoryBytes } });
    return out;
}

/// files: written after each step.
Json progressiveSection(const ReportExtras& extras, const Settings& settings)
{
    Json steps = Json::array();
    for (const ProgressiveStep& step : extras.steps) {
        const FrameStatistics& s = step.statistics;
        steps.push_back(
            { { "spp", step.spp }, { "spp_mean", s.sppMean }, { "rays_per_pixel", raysPerPixel(s, settings) },
                { "error", step.error.rmse() }, { "noise", step.error.noise }, { "bias", step.error.bias },
                { "wall_ms", s.wallMilliseconds }, { "files", extras.files } });
    }
    return { { "target_error", extras.targetError ? Json(*extras.targetError) : Json() }, { "ended_by", extras.ended },
        { "steps", steps } };
}

} // namespace

Json cameraReport(const scene::Scene& scene)
{
    const scene::Camera& camera = scene.camera;
    return { { "lens",
                 { { "aperture", camera.apertureRadius }, { "focus", scene::distanceInFocus(camera) },
                     { "aperture_profile", scene::profileName(camera.apertureProfile) } } },
        { "shutter",
            { { "open", scene.shutterOpen }, { "close", scene.shutterClose },
                { "profile", scene::profileName(scene.shutterProfile) } } },
        { "camera_moves", scene::cameraMoves(scene) }, { "moving_triangles", scene::summary(scene).movingTriangles } };
}

double degreesAcross(const glm::vec3& half) { return glm::degrees(2.0 * std::atan(double { glm::length(half) })); }

Json environmentReport(const EnvironmentPicture& picture)
{
    Json suns = Json::array();
    for (const Sun& sun : picture.suns) {
        suns.push_back({ { "towards", { sun.towards.x, sun.towards.y, sun.towards.z } },
            { "radiance", { sun.radiance.x, sun.radiance.y, sun.radiance.z } }, { "share", sun.share },
            { "degrees", { degreesAcross(sun.halfU), degreesAcross(sun.halfV) } } });
    }
    return { { "width", picture.width }, { "height", picture.height }, { "suns", suns } };
}

double raysPerPixel(const FrameStatistics& statistics, const Settings& settings)
{
    const bool whole = settings.crop.width() == 0 || settings.crop.height() == 0;
    const double pixels = whole ? static_cast<double>(settings.width) * settings.height
                                : static_cast<double>(settings.crop.width()) * settings.crop.height();
    return static_cast<double>(statistics.primaryRays + statistics.shadowRays + statistics.indirectRays) / pixels;
}

double megaraysPerSecond(const FrameStatistics& statistics)
{
    const double milliseconds = statistics.milliseconds(device::PassKind::Trace);
    const std::uint64_t rays = statistics.primaryRays + statistics.shadowRays + statistics.indirectRays;
    return milliseconds > 0 ? 1e-3 * static_cast<double>(rays) / milliseconds : 0.0;
}

std::string jsonReport(const Renderer& renderer, const Settings& settings, const std::vector<FrameStatistics>& frames,
    const ReportExtras& extras)
{
    Json report;
    report["wedge"] = version();
    report["device"] = deviceSection(renderer);
    report["scene"] =
        sceneSection(renderer, frames.empty() ? renderer.planUnbacked(settings).total() : frames.back().memoryBytes);
    report["method"] = methodSection(settings);
    report["setup"] = { { "load_ms", extras.loadMilliseconds },
        { "bvh_ms", 1e3 * renderer.hierarchy().statistics.buildSeconds },
        { "kernels_ms", 1e3 * renderer.setupSeconds() }, { "plan_ms", 1e3 * renderer.compileSeconds() } };
    report["frames"] = Json::array();
    for (const FrameStatistics& frame : frames) {
        report["frames"].push_back(frameSection(frame, settings));
    }
    if (extras.sequence) {
        const ReportExtras::Sequence& s = *extras.sequence;
        report["sequence"] = { { "first", s.first }, { "last", s.last }, { "fps", s.fps }, { "skipped", s.skipped },
            { "ended_by", s.ended } };
    }
    if (!extras.steps.empty()) {
        report["progressive"] = progressiveSection(extras, settings);
    }
    if (extras.error) {
        const image::Comparison& e = *extras.error;
        report["error"] = { { "reference", extras.reference }, { "rmse", e.rmse }, { "relmse", e.relMse },
            { "psnr", e.psnr }, { "ssim", e.ssim }, { "flip", e.flip }, { "invalid_pixels", e.invalidPixels } };
    }
    // Paths may hold bytes that are not UTF-8: replaced, as JSON has no other way.
    return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace wedge::render
