#pragma once

#include "host/app/outputs.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wedge::app {

/// Writes a render's images, each of them to all outputs, so that one that fails loses none of the others. What fails
/// is tried again with the next image of a progressive render, and of the last one kept in a rescue file.
class ImageWriter {
public:
    ImageWriter(std::vector<Output> outputs, const image::Look& look)
        : outputs_(std::move(outputs))
        , look_(look)
    {
    }

    /// Tries every output. Returns the errors of those that fail for the first time.
    std::vector<std::string> write(std::shared_ptr<const image::LayeredImage> image);

    /// After the last image: rescues what could not be written of it. Returns a line for each output that failed, with
    /// the rescue file's name. Once; does not throw.
    std::vector<std::string> finish();

    const std::vector<Output>& outputs() const { return outputs_; }
    /// Files that the last image is in.
    const std::vector<std::string>& written() const { return written_; }

private:
    struct Failure {
        const Output* output;
        std::string message;
    };

    std::optional<Output> rescueUnwritten() const;

    std::vector<Output> outputs_;
    image::Look look_;
    std::shared_ptr<const image::LayeredImage> unwritten_; // the last image, where an output failed
    std::vector<Failure> failures_; // of the last image
    std::vector<const Output*> known_; // outputs that failed before
    std::vector<std::string> written_;
};

} // namespace wedge::app
