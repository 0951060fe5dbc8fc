#include "host/app/outputs.h"

#include "host/app/console.h"
#include "host/error.h"
#include "host/files_opened.h"
#include "host/image/atomic_file.h"
#include "host/image/exr.h"
#include "host/image/png.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <tuple>
#include <utility>

#include <sys/stat.h>

namespace wedge::app {
namespace {

/// Which file a path leads to, whether it is there or would be made: a folder and a name in it.
struct Place {
    dev_t device = 0;
    ino_t folder = 0;
    std::string name; // of a file in the folder; where there is no such folder, the whole path
    bool replaceable = true; // and no device or pipe, which can be written twice

    bool operator==(const Place& other) const
    {
        return std::tie(device, folder, name) == std::tie(other.device, other.folder, other.name) && replaceable
            && other.replaceable;
    }
};

Place placeOf(const std::string& path)
{
    const std::filesystem::path file = image::behindLinks(path);
    const std::string folder = file.has_parent_path() ? file.parent_path().string() : ".";
    struct stat status = {};
    Place place { 0, 0, file.lexically_normal().string(), true };
    if (stat(folder.c_str(), &status) == 0) {
        place = { status.st_dev, status.st_ino, file.filename().string(), true };
    }
    if (stat(file.c_str(), &status) == 0) {
        place.replaceable = S_ISREG(status.st_mode);
    }
    return place;
}

} // namespace

std::optional<ImageFormat> formatOf(const std::string& path)
{
    std::string extension = std::filesystem::path(path).extension().string();
    std::ranges::transform(
        extension, extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".exr") {
        return ImageFormat::Exr;
    }
    if (extension == ".png") {
        return ImageFormat::Png;
    }
    return std::nullopt;
}

std::vector<Output> planOutputs(const std::vector<std::string>& paths)
{
    std::vector<Output> outputs;
    for (const std::string& path : paths) {
        const std::optional<ImageFormat> format = formatOf(path);
        if (!format) {
            throw UsageError("output of unknown format", path, "end its name in .exr or .png");
        }
        outputs.push_back({ path, *format });
    }
    return outputs;
}

std::vector<Output> defaultOutputs(const std::string& scene, const std::vector<std::string>& inUse)
{
    const std::string stem = std::filesystem::path(scene).stem().string();
    std::vector<Output> outputs = { { stem + ".exr", ImageFormat::Exr } };
    const std::string picture = stem + ".png";
    std::error_code ignored;
    if (std::filesystem::exists(std::filesystem::symlink_status(picture, ignored)) && !image::isOwnPng(picture)) {
        return outputs;
    }
    const Place place = placeOf(picture);
    const auto isPlace = [&place](const std::string& path) { return !path.empty() && placeOf(path) == place; };
    if (std::ranges::none_of(inUse, isPlace)) {
        outputs.push_back({ picture, ImageFormat::Png });
    }
    return outputs;
}

void leaveOutOpened(std::vector<Output>& defaults)
{
    std::erase_if(
        defaults, [](const Output& output) { return output.format == ImageFormat::Png && wasOpened(output.path); });
}

void refuseOverwriting(const std::vector<std::string>& written, const std::vector<std::string>& read)
{
    std::vector<std::pair<Place, std::string>> inputs;
    std::vector<Place> outputs;
    for (const std::string& path : read) {
        if (!path.empty()) {
            inputs.emplace_back(placeOf(path), path);
        }
    }
    for (const std::string& path : written) {
        if (path.empty()) {
            continue;
        }
        const Place place = placeOf(path);
        if (std::ranges::count(outputs, place) > 0) {
            throw UsageError("output is named twice", path, "give each output a name of its own");
        }
        const auto input = std::ranges::find(inputs, place, &std::pair<Place, std::string>::first);
        if (input != inputs.end()) {
            throw UsageError("output is a file that is read, " + input->second, path, "give it a name of its own");
        }
        outputs.push_back(place);
    }
}

void requireWritable(const std::vector<Output>& outputs, const std::string& report)
{
    std::vector<std::string> lines;
    const auto check = [&lines](const std::string& path) {
        try {
            image::checkWritable(path);
        } catch (const Error& error) {
            lines.emplace_back(error.what());
        }
    };
    for (const Output& output : outputs) {
        check(output.path);
    }
    if (!report.empty()) {
        check(report);
    }
    if (!lines.empty()) {
        throw Errors(std::move(lines));
    }
}

void writeImage(const Output& output, const image::LayeredImage& image, const image::Look& look)
{
    if (output.format == ImageFormat::Exr) {
        image::writeExr(output.path, image);
    } else {
        const auto inputs = image.metadata.find("inputs");
        const std::string* text = inputs != image.metadata.end() ? std::get_if<std::string>(&inputs->second) : nullptr;
        image::writePng(output.path, image::beauty(image), look, text != nullptr ? *text : "");
    }
}

void writeText(const std::string& path, const std::string& text)
{
    image::AtomicFile file(path);
    file.write(text);
    file.commit();
}

} // namespace wedge::app
