// Any text as an OBJ file, as far as its own triangles and what becomes of them.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "host/error.h"
#include "host/scene/mesh_builder.h"
#include "host/scene/obj_parser.h"
#include "host/scene/smooth_normals.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        wedge::scene::Warnings warnings;
        wedge::scene::Mesh mesh = wedge::scene::parseObj(text, "fuzz.obj", warnings).mesh;
        wedge::scene::smoothNormals(mesh, size % 2 == 0 ? 180.0f : 40.0f);
        wedge::scene::Geometry geometry;
        wedge::scene::addInstance(geometry, wedge::scene::indexMesh(mesh, 0), {}, -1, "", "fuzz.obj");
        for (const std::uint32_t index : geometry.indices) {
            if (3 * std::size_t { index } + 2 >= geometry.positions.size())
                __builtin_trap();
        }
        for (const std::string& line : warnings.lines()) {
            if (line.size() > 400)
                __builtin_trap();
        }
    } catch (const wedge::Error&) {
    }
    return 0;
}
