// Any text as a scene file, in a folder that holds one mesh, m.obj. Texts that name files outside of it are left out.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "host/error.h"
#include "host/scene/load_scene.h"

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

/// By a path, or one that a variable or an escape may hide.
bool leavesFolder(std::string_view text)
{
    return text.find('/') != std::string_view::npos || text.find("${") != std::string_view::npos
        || text.find('\\') != std::string_view::npos;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const Folder folder;
    const std::string text(reinterpret_cast<const char*>(data), size);
    if (leavesFolder(text))
        return 0;
    try {
        const wedge::scene::Scene scene = wedge::scene::parseScene(text, folder.path() / "fuzz.toml");
        if (scene.warnings.size() > 100)
            __builtin_trap();
    } catch (const wedge::Error&) {
    }
    return 0;
}
