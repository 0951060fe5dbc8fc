#include "host/image/exr.h"
#include "host/error.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <sys/mman.h>
#include <unistd.h>

namespace {

/// Sizes that would make an execution slow; the limits of what is read are for real pictures.
bool isLarge(std::string_view file)
{
    constexpr std::string_view start("dataWindow\0box2i\0\x10\0\0\0", 21);
    const std::size_t at = file.find(start);
    if (at == std::string_view::npos || file.size() < at + start.size() + 16)
        return false;
    std::int32_t box[4];
    std::copy_n(file.data() + at + start.size(), sizeof box, reinterpret_cast<char*>(box));
    const auto side = [&](int axis) { return std::int64_t { box[axis + 2] } - box[axis]; };
    return std::max(side(0), side(1)) > 512;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const int file = memfd_create("image.exr", 0);
    static const std::string path = "/proc/self/fd/" + std::to_string(file);
    if (isLarge({ reinterpret_cast<const char*>(data), size }))
        return 0;
    if (ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size))
        std::abort();
    try {
        wedge::image::readExr(path);
    } catch (const wedge::Error&) {
    }
    return 0;
}
