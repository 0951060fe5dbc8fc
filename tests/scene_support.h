#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "host/error.h"
#include "host/scene/scene.h"

namespace scene_test {

/// A folder that is gone after the test.
class TemporaryFolder {
public:
    TemporaryFolder()
    {
        static int number = 0;
        path_ = std::filesystem::temp_directory_path()
            / ("wedge_scene_test_" + std::to_string(getpid()) + "_" + std::to_string(number++));
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder()
    {
        std::error_code code;
        std::filesystem::remove_all(path_, code);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    /// Writes a file and returns its path.
    std::string write(const std::string& name, const std::string& text) const
    {
        std::ofstream(path_ / name, std::ios::binary) << text;
        return (path_ / name).string();
    }
    std::string path(const std::string& name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
};

/// The message of the Error that loading gives, without the folder's path, or "" when it gives none.
inline std::string errorOf(const std::string& file)
{
    try {
        wedge::scene::loadScene(file);
    } catch (const wedge::Error& error) {
        std::string text = error.what();
        const std::string folder = std::filesystem::path(file).parent_path().string() + "/";
        for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
            text.erase(at, folder.size());
        return text;
    }
    return "";
}

inline const char* const triangleObj = "o tri\nv 0 0 0\nv 1 0 0\nv 0 0 -1\nvn 0 1 0\nf 1//1 2//1 3//1\n";
inline const std::string mesh = "[[mesh]]\nfile = \"m.obj\"\n";

/// Loads a scene file's text next to a mesh m.obj of one triangle that faces +y.
inline wedge::scene::Scene load(const std::string& toml)
{
    const TemporaryFolder folder;
    folder.write("m.obj", triangleObj);
    return wedge::scene::loadScene(folder.write("s.toml", toml));
}

/// What loading it fails with.
inline std::string error(const std::string& toml)
{
    const TemporaryFolder folder;
    folder.write("m.obj", triangleObj);
    return errorOf(folder.write("s.toml", toml));
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Whether any warning of the scene holds the text.
inline bool warns(const wedge::scene::Scene& scene, const std::string& part)
{
    for (const std::string& warning : scene.warnings) {
        if (contains(warning, part))
            return true;
    }
    return false;
}

inline std::string dataFolder()
{
    const char* folder = std::getenv("WEDGE_TEST_DATA");
    return folder != nullptr ? folder : "data";
}

inline glm::vec3 vectorAt(const std::vector<float>& values, std::size_t index)
{
    return { values[3 * index], values[3 * index + 1], values[3 * index + 2] };
}

/// The corners of a triangle.
inline glm::vec3 corner(const wedge::scene::Geometry& g, std::size_t triangle, std::size_t which)
{
    return vectorAt(g.positions, g.indices[3 * triangle + which]);
}

} // namespace scene_test
