#pragma once

#include "host/render/renderer.h"
#include "host/render/settings.h"

#include <string>

namespace wedge::app {

/// What each pass cost, device time and share of it, transfers in one line; below, the sum beside the wall clock, the
/// overhead, samples and rays. Several lines, the last one ended.
std::string passTable(const render::FrameStatistics& statistics, const render::Settings& settings);

} // namespace wedge::app
