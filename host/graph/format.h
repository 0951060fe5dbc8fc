#pragma once

#include <cstdint>
#include <string_view>

namespace wedge::graph {

/// How the elements of a resource are stored in device memory. A resource has one format for good, so that its bits are
/// the same in whatever frame it occurs. Kernels read and write elements by functions of the format's name
/// (kernels/core/formats.h), and never ask which it is.
struct Format {
    std::string_view name; ///< an identifier
    std::uint32_t bytes; ///< of an element (a pixel, a receiver), all its parts together
    std::string_view storage; ///< OpenCL type of what kernels' pointers point to
    bool whole = true; ///< false: there are no such functions, and kernels take the parts that they need
    bool blocks = false; ///< there is one that reads sixteen elements
    bool operator==(const Format& other) const { return name == other.name && bytes == other.bytes; }
};

inline constexpr Format floats { .name = "float1", .bytes = 4, .storage = "float", .blocks = true };
inline constexpr Format vectors { .name = "float3", .bytes = 12, .storage = "float", .blocks = true };
inline constexpr Format counts { .name = "uint1", .bytes = 4, .storage = "uint", .blocks = true };
inline constexpr Format pairs { .name = "float2", .bytes = 8, .storage = "float" };
/// As many floats, each in a plane of its own, of which kernels take those that they need.
constexpr Format floatPlanes(std::uint32_t count)
{
    return count == 1 ? floats
        : count == 3  ? vectors
                      : Format { .name = "floats", .bytes = 4 * count, .storage = "float", .whole = false };
}

} // namespace wedge::graph
