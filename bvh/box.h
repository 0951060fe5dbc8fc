#pragma once

namespace wedge::bvh::detail {

// Four lanes of GCC's and Clang's portable vector type; x, y, z and a fourth that stays 0.
typedef float Float4 __attribute__((vector_size(16)));
typedef int Int4 __attribute__((vector_size(16)));

inline Float4 minOf(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 maxOf(Float4 a, Float4 b) { return a > b ? a : b; }

/// An axis-aligned box. The empty one has lo above hi, and is the identity of grow.
struct Box {
    Float4 lo, hi;

    static Box empty() { return { Float4 { 1e30f, 1e30f, 1e30f, 0 }, Float4 { -1e30f, -1e30f, -1e30f, 0 } }; }

    void grow(const Box& other)
    {
        lo = minOf(lo, other.lo);
        hi = maxOf(hi, other.hi);
    }

    void grow(Float4 point)
    {
        lo = minOf(lo, point);
        hi = maxOf(hi, point);
    }

    /// Half the surface, in double: extents of 1e18 times counts leave a float's range. 0 for an empty box.
    double halfArea() const
    {
        const Float4 extent = hi - lo;
        if (!(extent[0] >= 0))
            return 0;
        const double x = extent[0], y = extent[1], z = extent[2];
        return x * y + y * z + z * x;
    }
};

} // namespace wedge::bvh::detail
