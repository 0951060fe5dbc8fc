#pragma once

#include "host/scene/scene.h"

namespace wedge::scene {

/// A camera of 45 degrees that has the whole box in view, from in front (+z), a little to the right and above.
Camera frameBounds(const Bounds& bounds, double aspect);

/// What a bare mesh lacks: a grey floor under it (its own object and material), a camera and a Gaussian area light
/// above that shines on its centre.
void furnish(Scene& scene);

} // namespace wedge::scene
