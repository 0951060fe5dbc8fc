// Any text as a material library. Its textures are looked for where there are none.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "host/error.h"
#include "host/scene/mtl_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    wedge::scene::TextureSet textures(1 << 16);
    wedge::scene::Warnings warnings;
    try {
        for (const wedge::scene::Material& material :
            wedge::scene::parseMtl(text, "/nonexistent/fuzz.mtl", textures, warnings)) {
            if (!std::isfinite(material.exponent) || material.name.empty() || !(material.diffuse.x >= 0.0f))
                __builtin_trap();
        }
    } catch (const wedge::Error&) {
    }
    for (const std::string& line : warnings.lines()) {
        if (line.size() > 400)
            __builtin_trap();
    }
    return 0;
}
