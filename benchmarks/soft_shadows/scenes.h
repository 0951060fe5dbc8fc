#pragma once

#include "host/scene/scene.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// A row of Table 3.1: milliseconds at 640x480 on a GTX 570.
struct PaperRow {
    const char* name;
    double triangles, spp, firstPass, secondPass, tracing, analysis, filter, overhead, total, fpsWith, fpsWithout;
};

/// What a scene is to reach, and what the thesis reports of samples saved.
struct Goals {
    std::optional<double> samplesSaved, samplesSavedPublished, overhead, paperSamplesSaved;
};

/// A scene that can be measured.
struct SceneSource {
    std::string name; ///< as in claims
    std::string origin; ///< one line
    std::function<std::string()> file; ///< makes the scene file where that is needed, and returns its path
    const PaperRow* paper = nullptr;
    Goals goals;
    bool curves = true; ///< with all the curves of Fig. 3.6c
    std::string mesh; ///< what it needs below WEDGE_DATA, "" for nothing
};

/// All scenes with a name: ours, then those of the thesis' authors.
const std::vector<SceneSource>& knownScenes();

/// True if the scene needs no mesh of others, or WEDGE_DATA points to where it is.
bool available(const SceneSource& source);

/// The scene of that name, or the scene file of that path, called by its file name. Throws Error.
SceneSource findScene(const std::string& nameOrPath);

} // namespace wedge::benchmark
