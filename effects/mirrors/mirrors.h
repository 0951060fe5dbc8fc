#pragma once

#include "host/render/effect.h"

#include <memory>

namespace wedge::render {

/// What mirrors and glass show, docs/materials.md: unfiltered, a path a sample.
std::unique_ptr<const Effect> mirrors();

} // namespace wedge::render
