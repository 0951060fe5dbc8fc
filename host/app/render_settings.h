#pragma once

#include "host/app/render_options.h"
#include "host/render/prepared_scene.h"

namespace wedge::app {

/// Puts the lens that the options describe in the place of the scene's. Throws UsageError for a plane in focus of a
/// pinhole.
void applyLens(const RenderOptions& options, scene::Scene& scene);

/// The settings of the frame: options before what the scene file says, that before the defaults. Throws UsageError
/// for options that contradict each other or have no effect together, and for values out of range; Error for counts in
/// the scene file that its method cannot have.
render::Settings resolveSettings(const RenderOptions& options, const render::PreparedScene& scene);

} // namespace wedge::app
