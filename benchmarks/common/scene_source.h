#pragma once

#include "data/generator/scene_writer.h"
#include "host/error.h"

#include <functional>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// A scene that can be measured. Benchmarks add what they know of it.
struct SceneSource {
    std::string name; ///< as in claims
    std::string origin; ///< one line
    std::function<std::string()> file; ///< makes the scene file where that is needed, and returns its path
    std::string mesh; ///< what it needs below WEDGE_DATA, "" for nothing
    std::string map = {}; ///< of its environment, likewise
};

/// A scene that is generated when it is used.
SceneSource generatedScene(const std::string& name, generator::GeneratedScene (*make)());

/// One of data/external, which has a mesh of others, and maybe a map of its environment.
SceneSource externalScene(
    const std::string& name, const std::string& origin, const std::string& mesh, const std::string& map = "");

/// One of data/scenes.
SceneSource shippedScene(const std::string& name, const std::string& origin);

/// A scene whose file is written when it is used. text: what goes into it, of the path of data/scenes. map: as above.
SceneSource writtenScene(const std::string& name, const std::string& origin,
    const std::function<std::string(const std::string& scenes)>& text, const std::string& map = "");

/// A scene file, called by its file name. Throws UsageError, which lists the names of known scenes, where there is
/// none.
SceneSource sceneOfFile(const std::string& path, const std::vector<std::string>& known);

/// What the scene needs that is not below WEDGE_DATA; empty if all is there.
std::string missing(const SceneSource& source);

/// Where references are kept unless another folder is named.
std::string defaultReferenceFolder();

/// The scene of that name, or the scene file of that path. Source: a SceneSource and more. Throws UsageError.
template <class Source>
Source findScene(const std::vector<Source>& scenes, const std::string& nameOrPath)
{
    std::vector<std::string> names;
    for (const Source& scene : scenes) {
        if (scene.name == nameOrPath) {
            return scene;
        }
        names.push_back(scene.name);
    }
    Source out;
    static_cast<SceneSource&>(out) = sceneOfFile(nameOrPath, names);
    return out;
}

/// The scenes asked for, all where none is; those that need files which are not there go to `skipped`, unless named.
/// Throws Error.
template <class Source>
std::vector<Source> chooseScenes(
    const std::vector<Source>& scenes, const std::vector<std::string>& wanted, std::vector<std::string>& skipped)
{
    std::vector<Source> chosen;
    for (const std::string& name : wanted) {
        chosen.push_back(findScene(scenes, name));
        if (const std::string file = missing(chosen.back()); !file.empty()) {
            throw Error("scene", name, "set WEDGE_DATA to the folder that holds " + file);
        }
    }
    if (!wanted.empty()) {
        return chosen;
    }
    for (const Source& source : scenes) {
        if (!missing(source).empty()) {
            skipped.push_back(source.name);
        } else {
            chosen.push_back(source);
        }
    }
    return chosen;
}

} // namespace wedge::benchmark
