#pragma once

#include "host/image/image.h"
#include "host/image/view.h"

#include <optional>
#include <string>
#include <vector>

namespace wedge::app {

enum class ImageFormat { Exr, Png };

/// An image to write.
struct Output {
    std::string path;
    ImageFormat format = ImageFormat::Exr;
};

/// The format that the name's extension tells, if any.
std::optional<ImageFormat> formatOf(const std::string& path);

/// The outputs that the paths name. Throws UsageError for other extensions.
std::vector<Output> planOutputs(const std::vector<std::string>& paths);

/// Those of a call that names none: the scene's name with .exr and with .png in the current folder. The second is left
/// out where that file is there and no picture of ours (it may be a texture, or a photograph), or is one of those in
/// use.
std::vector<Output> defaultOutputs(const std::string& scene, const std::vector<std::string>& inUse);

/// Drops the picture of defaultOutputs() where it is a file that was read.
void leaveOutOpened(std::vector<Output>& defaults);

/// Throws UsageError where two of the files that are written are one, and where one of them is to be read: under
/// whatever spelling, also through symbolic links. Empty paths stand for none. What is known before anything is read;
/// requireNotOpened() is for all that was.
void refuseOverwriting(const std::vector<std::string>& written, const std::vector<std::string>& read);

/// Throws the Errors that writing would end in, as far as can be told now. report: a path, or "".
void requireWritable(const std::vector<Output>& outputs, const std::string& report);

/// Writes the image, whole or not at all. Throws Error.
void writeImage(const Output& output, const image::LayeredImage& image, const image::Look& look);

/// Writes text to a file, whole or not at all. Throws Error.
void writeText(const std::string& path, const std::string& text);

} // namespace wedge::app
