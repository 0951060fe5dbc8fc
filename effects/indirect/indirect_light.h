#pragma once

#include "host/render/effect.h"

#include <memory>

namespace wedge::render {

/// Indirect light by paths, and ambient occlusion, thesis chapter 4, docs/indirect.md. One term a component.
std::unique_ptr<const Effect> indirectLight();

} // namespace wedge::render
