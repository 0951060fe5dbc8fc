#pragma once

#include "host/app/render_options.h"
#include "host/render/settings.h"
#include "host/scene/scene.h"

namespace wedge::app {

/// How messages call frames whose pixels have several receivers.
inline constexpr const char* distributedFrames = "through a lens or shutter, or with antialiasing";

/// Samples at which a progressive render ends. Those of the file are for one image, and do not cut short what is to end
/// otherwise.
int progressiveSpp(const RenderOptions& options, const scene::Scene& scene);

/// Whether the mean count is given, and not what follows from the spectrum.
bool meanIsGiven(const render::Settings& settings);

/// The counts of method aaf: those of the file are looked at only where no option overrides them and they have an
/// effect. distributed: whether pixels have several receivers, see render::isDistributed(). Throws UsageError for
/// options and Error for values of the file that are out of the range of such frames or contradict each other.
void applyCounts(const RenderOptions& options, const scene::Scene& scene, bool distributed, render::Settings& settings);

} // namespace wedge::app
