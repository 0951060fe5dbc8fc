#include "host/app/image_writer.h"

#include "host/app/rescue.h"
#include "host/error.h"

#include <algorithm>
#include <new>

#include <fmt/format.h>

namespace wedge::app {
namespace {

/// What went wrong, or "".
std::string attempt(const Output& output, const image::LayeredImage& image, const image::Look& look)
{
    try {
        writeImage(output, image, look);
        return "";
    } catch (const Error& error) {
        return error.what();
    } catch (const std::bad_alloc&) {
        return message("cannot encode image (host memory is exhausted)", output.path, "write fewer layers");
    } catch (const std::exception& error) {
        return message(fmt::format("cannot write image ({})", error.what()), output.path, "write elsewhere");
    }
}

/// The path is never shortened: who reads it looks for the file.
std::string withRescue(const std::string& message, const std::string& kept)
{
    constexpr std::size_t most = 380;
    const std::string end = kept.empty() ? "; nor could it be kept elsewhere" : "; kept as " + kept;
    return shortened(message, most - std::min<std::size_t>(end.size(), most / 2)) + end;
}

bool isExr(const Output& output) { return output.format == ImageFormat::Exr; }

} // namespace

std::vector<std::string> ImageWriter::write(std::shared_ptr<const image::LayeredImage> image)
{
    std::vector<std::string> news;
    failures_.clear();
    written_.clear();
    for (const Output& output : outputs_) {
        const std::string error = attempt(output, *image, look_);
        if (error.empty()) {
            written_.push_back(output.path);
            continue;
        }
        failures_.push_back({ &output, error });
        if (std::ranges::count(known_, &output) == 0) {
            known_.push_back(&output);
            news.push_back(error);
        }
    }
    unwritten_ = failures_.empty() ? nullptr : std::move(image);
    return news;
}

/// An EXR has what no other file has; a PNG is worth one where it would be the only picture, and is the smallest of
/// all.
std::optional<Output> ImageWriter::rescueUnwritten() const
{
    std::vector<Output> wanted;
    const auto exr = std::ranges::find_if(failures_, [](const Failure& f) { return isExr(*f.output); });
    if (exr != failures_.end()) {
        wanted.push_back(*exr->output);
    }
    if (written_.empty()) {
        wanted.push_back({ failures_.front().output->path, ImageFormat::Png });
    }
    for (const Output& output : wanted) {
        if (const auto path = rescue(output, *unwritten_, look_)) {
            return Output { *path, output.format };
        }
    }
    return std::nullopt;
}

std::vector<std::string> ImageWriter::finish()
{
    if (failures_.empty()) {
        return {};
    }
    const std::optional<Output> kept = rescueUnwritten();
    std::vector<std::string> lines;
    for (const Failure& failure : failures_) {
        const bool expected = isExr(*failure.output) || written_.empty();
        lines.push_back(expected ? withRescue(failure.message, kept ? kept->path : "") : failure.message);
    }
    if (kept) {
        written_.push_back(kept->path);
    }
    failures_.clear();
    unwritten_ = nullptr;
    return lines;
}

} // namespace wedge::app
