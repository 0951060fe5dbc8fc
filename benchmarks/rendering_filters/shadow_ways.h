#pragma once

#include "host/render/settings.h"

#include <string>
#include <vector>

namespace wedge::benchmark {

/// One way to put an environment's direct light together from lights that stand for its map.
struct ShadowWay {
    std::string name;
    void (*set)(render::ShadowSettings& settings); ///< all but the number of lights
};

/// The ways that claims are about.
inline constexpr const char* additiveWay = "additive";
inline constexpr const char* subtractiveWay = "subtractive";
inline constexpr const char* ratioWay = "ratio";
inline constexpr const char* chosenWay = "ratio, 8 a pixel"; ///< by the lights that bring it most

/// Those that are measured where nobody chooses: a row each.
const std::vector<ShadowWay>& shadowWays();

/// Those of these names in the order of shadowWays(), all for no name. Throws UsageError.
std::vector<ShadowWay> shadowWays(const std::vector<std::string>& names);

} // namespace wedge::benchmark
