#pragma once

#include <cstdint>
#include <string_view>

namespace wedge::graph {

/// How the elements of a resource are stored in device memory, and how kernels read and write one. A resource has one
/// format for good, so that its bits are the same in whatever frame it occurs, and a kernel never asks for it.
struct Format {
    std::string_view name; ///< an identifier
    std::uint32_t bytes; ///< of an element (a pixel, a receiver), all its parts together
    std::string_view storage; ///< OpenCL type of what kernels' pointers point to
    std::string_view value; ///< OpenCL type of an element when it is loaded; empty: kernels index the memory themselves
    /// OpenCL expressions over `plane`, the pointer, `size`, elements of the resource, and `at`, which element; the
    /// second a statement without its semicolon, over `value` as well. Parts of an element lie `size` apart.
    std::string_view load, store;
    bool operator==(const Format& other) const { return name == other.name; }
};

inline constexpr Format floats { "float1", 4, "float", "float", "plane[at]", "plane[at] = value" };
inline constexpr Format vectors { "float3", 12, "float", "float3",
    "(float3)(plane[at], plane[size + at], plane[2 * size + at])",
    "plane[at] = value.x, plane[size + at] = value.y, plane[2 * size + at] = value.z" };
inline constexpr Format counts { "uint1", 4, "uint", "uint", "plane[at]", "plane[at] = value" };
/// As many floats, each in a plane of its own.
constexpr Format floatPlanes(std::uint32_t count)
{
    constexpr std::string_view names[] = { "float0", "float1", "float2", "float3", "float4", "float5", "float6" };
    return count == 1 ? floats : count == 3 ? vectors : Format { names[count], 4 * count, "float", "", "", "" };
}
/// 11 bits of precision, magnitudes up to 65504.
inline constexpr Format halves { "half1", 2, "half", "float", "vload_half(at, plane)",
    "vstore_half(value, at, plane)" };

} // namespace wedge::graph
