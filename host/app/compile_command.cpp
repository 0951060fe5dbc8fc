#include "host/app/commands.h"

#include "host/render/compilers.h"

#include <charconv>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace wedge::app {

std::string ownProgram()
{
    std::error_code failed;
    const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", failed);
    return failed ? "" : path.string();
}

std::optional<int> compileForOther(int argc, char** argv)
{
    if (argc != 3 || std::string_view(argv[1]) != "compile-kernels") {
        return std::nullopt;
    }
    const std::string_view number = argv[2];
    int file = -1;
    std::from_chars(number.data(), number.data() + number.size(), file);
    return render::compileShare(file);
}

} // namespace wedge::app
