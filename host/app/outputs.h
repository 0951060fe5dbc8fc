#pragma once

#include "host/image/image.h"

#include <string>
#include <vector>

namespace wedge::app {

enum class ImageFormat { Exr, Png };

/// An image to write.
struct Output {
    std::string path;
    ImageFormat format = ImageFormat::Exr;
};

/// The outputs that the paths name, their formats told by the extension; without any, the scene's name with .exr in the
/// current folder. Throws UsageError for other extensions and for a path named twice.
std::vector<Output> planOutputs(const std::vector<std::string>& paths, const std::string& scene);

/// Throws the Error that writing would end in, as far as can be told now. report: a path, or "".
void requireWritable(const std::vector<Output>& outputs, const std::string& report);

/// Writes the image to each, whole or not at all. Throws Error.
void writeOutputs(const std::vector<Output>& outputs, const image::LayeredImage& image, float exposureStops);

/// Writes text to a file, whole or not at all. Throws Error.
void writeText(const std::string& path, const std::string& text);

} // namespace wedge::app
