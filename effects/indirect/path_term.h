#pragma once

#include "effects/indirect/indirect.h"
#include "host/render/effect.h"

namespace wedge::render {

/// A component as a term: sampled, analysed and filtered as paths, of no bounce where it is direct light. name: what
/// the layer of its filter widths ends in.
Term pathTerm(Component component, const char* name, const Settings& settings);

} // namespace wedge::render
