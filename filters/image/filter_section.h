#pragma once

#include "host/render/settings.h"
#include "host/scene/scene.h"
#include "host/scene/toml_reader.h"
#include "host/scene/warnings.h"

#include <any>
#include <vector>

namespace wedge::filters {

/// [[filter]] of scene files.
inline constexpr const char* filterSection = "filter";

/// One of them: `type`, the filter's parameters, `on`, what it filters, and `enabled`, which is true where it is not
/// there. A std::optional<render::ChosenFilter>, empty where it is not enabled. Throws Error for what is wrong in it.
std::any readFilter(scene::TableReader& table, scene::Warnings& warnings);

/// Those of a scene that are on, in the file's order.
std::vector<render::ChosenFilter> filtersOf(const scene::Scene& scene);

} // namespace wedge::filters
