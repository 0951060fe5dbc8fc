#pragma once

#include "host/app/outputs.h"

#include <optional>
#include <string>

namespace wedge::app {

/// Writes an image whose output cannot be written to a new file, a-rescued.exr for a.exr, in the working folder or else
/// in the temporary one, as a-rescued-2.exr and so on where there are files of that name.
/// Returns its path, or nothing where neither folder takes it. Does not throw.
std::optional<std::string> rescue(const Output& output, const image::LayeredImage& image, const image::Look& look);

} // namespace wedge::app
