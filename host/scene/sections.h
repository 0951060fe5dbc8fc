#pragma once

#include "host/scene/scene.h"
#include "host/scene/warnings.h"

#include <any>
#include <functional>
#include <string>
#include <vector>

namespace wedge::scene {

class TableReader;

/// A table of scene files that means something to others alone: [key], or a list of tables, [[key]]. What is read of it
/// becomes Scene::extensions[key].
struct Section {
    std::string key;
    /// Throws Error for what is wrong in it, and warns of what is used in spite of it.
    std::function<std::any(TableReader&, Warnings&)> read;
    bool lights = false; ///< what is read lights the scene
    /// Area lights that what was read brings into a scene of these bounds; may be null.
    std::function<std::vector<AreaLight>(const std::any&, const Bounds&)> areaLights {};
    bool list = false; ///< [[key]], or one [key]: the extension is a std::vector<std::any> of what is read of each
};

/// Adds one. Not while anybody reads scenes.
void registerSection(Section section);
const std::vector<Section>& sections();

} // namespace wedge::scene
