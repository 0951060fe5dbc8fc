#include "host/app/commands.h"
#include "host/app/console.h"
#include "host/app/outputs.h"
#include "host/app/reference.h"
#include "host/app/values.h"
#include "host/decode/limits.h"
#include "host/error.h"
#include "host/files_opened.h"
#include "host/image/atomic_file.h"
#include "host/image/colour.h"
#include "host/image/metrics.h"
#include "host/image/png.h"
#include "host/image/read_image.h"

#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace wedge::app {
namespace {

struct CompareOptions {
    std::string image, reference, errorMap;
    std::optional<std::size_t> metric;
    std::optional<std::int64_t> maxPixels;
    bool json = false;
};

using image::RgbImage;

struct Metric {
    const char* name;
    double (*measure)(const RgbImage& image, const RgbImage& reference);
    const char* unit;
};

constexpr Metric metrics[] = {
    { "rmse", image::rmse, "" },
    { "relmse", image::relMse, "" },
    { "psnr", image::psnr, " dB" },
    { "ssim", image::ssim, "" },
    { "flip", [](const RgbImage& a, const RgbImage& b) { return image::flip(a, b).mean; }, "" },
};

std::vector<std::string> metricNames()
{
    std::vector<std::string> names;
    for (const Metric& metric : metrics) {
        names.emplace_back(metric.name);
    }
    return names;
}

/// FLIP's error as grey, black where nobody sees a difference.
void writeErrorMap(const std::string& path, const RgbImage& a, const RgbImage& b)
{
    const image::FlipResult flip = image::flip(a, b);
    RgbImage map { flip.width, flip.height, {} };
    for (const float error : flip.error) {
        // The error itself is to be the PNG's value, so the sRGB curve of the writer is undone.
        map.rgb.insert(map.rgb.end(), 3, image::decodeSrgb(error));
    }
    image::writePng(path, map);
}

void checkErrorMap(const CompareOptions& options)
{
    if (formatOf(options.errorMap) != ImageFormat::Png) {
        throw UsageError("error map of another format than PNG", options.errorMap, "end its name in .png");
    }
    refuseOverwriting({ options.errorMap }, { options.image, options.reference });
    image::checkWritable(options.errorMap);
}

/// Who says how many pixels may be read has looked at the files, which are then no longer asked for their bytes.
decode::Limits limitsOf(const CompareOptions& options)
{
    decode::Limits limits = decode::referenceLimits;
    limits.remedy = "use a smaller image, or allow as many pixels with --max-pixels";
    limits.pixels = options.maxPixels.value_or(limits.pixels);
    limits.unquestioned = options.maxPixels.value_or(limits.unquestioned);
    return limits;
}

int compare(const CompareOptions& options)
{
    if (!options.errorMap.empty()) {
        checkErrorMap(options);
    }
    const decode::Limits limits = limitsOf(options);
    image::ImageFile imageFile(options.image, limits), referenceFile(options.reference, limits);
    requireNotOpened({ options.errorMap }, "give it a name of its own");
    const image::ComparedParts parts = image::comparedParts(imageFile, referenceFile);
    if (parts.isLess) {
        const image::Window& part = parts.image;
        warn(fmt::format("compared are the pixels {},{},{},{} of the frame, which both {} and {} store", part.x0,
            part.y0, part.x1, part.y1, options.image, options.reference));
    }
    const RgbImage a = imageFile.read(parts.image);
    const RgbImage b = referenceFile.read(parts.reference);
    nlohmann::ordered_json json;
    for (std::size_t i = 0; i < std::size(metrics); ++i) {
        if (options.metric && *options.metric != i) {
            continue;
        }
        const double value = metrics[i].measure(a, b);
        json[metrics[i].name] = value;
        if (!options.json) {
            options.metric ? say("{:.9g}\n", value) : say("{:<7} {:.6g}{}\n", metrics[i].name, value, metrics[i].unit);
        }
    }
    const std::size_t invalid = image::countInvalidPixels(a, b);
    if (!options.metric) {
        json["invalid_pixels"] = invalid;
        if (!options.json) {
            say("invalid pixels {}\n", invalid);
        }
    }
    warnOfInvalidPixels(invalid, a);
    if (options.json) {
        say("{}\n", json.dump(2));
    }
    if (!options.errorMap.empty()) {
        writeErrorMap(options.errorMap, a, b);
    }
    requireSaid();
    return 0;
}

} // namespace

void addCompareCommand(CLI::App& parser, Action& action)
{
    CLI::App* command = parser.add_subcommand("compare", "Measure how far an image is from a reference");
    const auto options = std::make_shared<CompareOptions>();
    command->add_option("IMAGE", options->image, "Image: .exr, .png or .hdr")->type_name("")->required();
    command->add_option("REFERENCE", options->reference, "What it should be")->type_name("")->required();
    command
        ->add_option_function<std::string>(
            "--metric",
            [options](const std::string& text) { options->metric = choice("--metric", text, metricNames()); },
            "Print this number alone")
        ->type_name("rmse|relmse|psnr|ssim|flip")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command
        ->add_option_function<std::string>(
            "--max-pixels",
            [options](const std::string& text) {
                options->maxPixels = wholeNumber("--max-pixels", text, 1, std::int64_t { 1 } << 30);
            },
            "Read images of up to so many pixels, however few bytes their files have")
        ->type_name("N")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command->add_flag("--json", options->json, "Print JSON; a value that is not finite is null");
    command->add_option("--error-map", options->errorMap, "Write where FLIP sees the error, as a grey PNG")
        ->type_name("FILE");
    command->callback([options, &action] { action = [options] { return compare(*options); }; });
}

} // namespace wedge::app
