#pragma once

#include "host/app/outputs.h"
#include "host/app/render_options.h"
#include "host/render/settings.h"

#include <cstdint>
#include <string>

namespace wedge::app {

/// A name for all that a sequence's frames are made from, but for their number: the version, the bytes of the scene's
/// files, the settings of frame 0, and what else of the options shapes a picture. Devices are not among it.
/// contents: scene::Sequence::contents().
std::string sequenceInputs(
    const RenderOptions& options, const render::Settings& settings, double framesPerUnit, std::uint64_t contents);

/// The same with the frame's number, as its files have it.
std::string frameInputs(const std::string& sequence, std::uint32_t frame);

/// Whether a file is there that is whole and was made from these inputs. Does not throw.
bool isFinished(const Output& output, const std::string& inputs);

} // namespace wedge::app
