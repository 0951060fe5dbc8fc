#pragma once

#include "host/scene/scene.h"

#include <functional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// A scene whose rays can be measured.
struct RayScene {
    std::string name; ///< as in claims
    std::string origin; ///< one line
    std::function<scene::Scene()> load;
    std::string mesh; ///< what it needs below WEDGE_DATA, "" for nothing
    bool quick = false; ///< among those of --quick
    bool full = true; ///< among those of a full run
};

/// All scenes with a name.
const std::vector<RayScene>& rayScenes();

/// True if the scene needs no mesh of others, or WEDGE_DATA points to where it is.
bool available(const RayScene& source);

/// The scene of that name, or the scene file of that path, called by its file name. Throws Error.
RayScene findRayScene(const std::string& nameOrPath);

} // namespace wedge::benchmark
