#pragma once

#include "effects/indirect/indirect.h"
#include "host/render/effect.h"

namespace wedge::render {

/// A term of direct light that is sampled, analysed and filtered as paths of no bounce. name: what the layer of its
/// filter widths ends in.
Term directPathTerm(Component component, const char* name, const Settings& settings);

} // namespace wedge::render
