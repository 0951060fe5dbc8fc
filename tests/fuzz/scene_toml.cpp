// Any text as a scene file, in a folder that holds one mesh, m.obj. Texts that name files outside of it are left out,
// which is told of the parsed text, so that escapes, variables and folders of names are tried.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "host/error.h"
#include "host/scene/load_scene.h"
#include "host/scene/paths.h"
#include "host/scene/toml_reader.h"

namespace {

/// A folder that is gone with the process.
class Folder {
public:
    Folder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "wedge_fuzz_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            std::abort();
        path_ = name;
        std::ofstream(path_ / "m.obj")
            << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng a\nf 1 2 3\ng b\nusemtl b\nf 1 2 3 4\n";
    }
    ~Folder()
    {
        std::error_code code;
        std::filesystem::remove_all(path_, code);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// Of one text, taken for a path and resolved as those of a scene are. One that cannot be resolved names no file.
bool leavesFolder(const std::string& text, const std::filesystem::path& folder)
{
    try {
        const std::filesystem::path path = wedge::scene::resolvePath(text, folder, "fuzz").lexically_normal();
        const std::filesystem::path inside = path.lexically_relative(folder);
        return inside.empty() || *inside.begin() == "..";
    } catch (const wedge::Error&) {
        return false;
    }
}

/// Of any text of the tree.
bool leavesFolder(const toml::node& node, const std::filesystem::path& folder)
{
    if (const auto* text = node.as_string())
        return leavesFolder(text->get(), folder);
    if (const auto* list = node.as_array())
        return std::any_of(
            list->begin(), list->end(), [&](const toml::node& each) { return leavesFolder(each, folder); });
    const auto* table = node.as_table();
    return table != nullptr && std::any_of(table->begin(), table->end(), [&](const auto& each) {
        return leavesFolder(each.second, folder);
    });
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const Folder folder;
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        if (leavesFolder(wedge::scene::parseToml(text, "fuzz.toml"), folder.path()))
            return 0;
        const wedge::scene::Scene scene = wedge::scene::parseScene(text, folder.path() / "fuzz.toml");
        if (scene.warnings.size() > 100)
            __builtin_trap();
    } catch (const wedge::Error&) {
    }
    return 0;
}
