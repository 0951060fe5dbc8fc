// What lets the headers of this folder compile both as OpenCL C 1.2 and as C++20.
//
// Rules for these headers: no float3 members, no bool, size_t or pointers inside structs, 32-bit
// scalars only, helpers are WEDGE_FN or WEDGE_INLINE functions between WEDGE_SHARED_BEGIN and WEDGE_SHARED_END.
#ifndef WEDGE_SHARED_COMPAT_H
#define WEDGE_SHARED_COMPAT_H

// Drivers define the first, clang as a linter of a plain target only the second.
#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)

#define WEDGE_SHARED_BEGIN
#define WEDGE_SHARED_END
#define WEDGE_FN static inline
// For functions in loops over lanes, which become vectors only when nothing is called. Without optimisation it brings
// nothing, and an emulator that runs such code stumbles over what inlining leaves behind.
#ifdef __OPTIMIZE__
#define WEDGE_INLINE static inline __attribute__((always_inline))
#else
#define WEDGE_INLINE static inline
#endif
// Identical bits on every device and on the host for + - *: no fused multiply-adds in shared maths.
// A function that wants them has the pragma with ON in its body; its end ends that, and yet OFF is said again behind
// it, for drivers that forget.
#pragma OPENCL FP_CONTRACT OFF

#else

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#define WEDGE_SHARED_BEGIN namespace wedge::shared {
#define WEDGE_SHARED_END }
#define WEDGE_FN inline
#define WEDGE_INLINE inline

WEDGE_SHARED_BEGIN

using uint = std::uint32_t;
using std::acos;
using std::atan2;
using std::cos;
using std::exp;
using std::fabs;
using std::floor;
using std::log;
using std::pow;
using std::sin;
using std::sqrt;

WEDGE_FN uint as_uint(float x) { return std::bit_cast<uint>(x); }
WEDGE_FN float as_float(uint x) { return std::bit_cast<float>(x); }
WEDGE_FN float fmin(float a, float b) { return std::fmin(a, b); }
WEDGE_FN float fmax(float a, float b) { return std::fmax(a, b); }
WEDGE_FN uint min(uint a, uint b) { return a < b ? a : b; }
WEDGE_FN uint max(uint a, uint b) { return a > b ? a : b; }
WEDGE_FN int min(int a, int b) { return a < b ? a : b; }
WEDGE_FN int max(int a, int b) { return a > b ? a : b; }
WEDGE_FN float clamp(float x, float lo, float hi) { return fmin(fmax(x, lo), hi); }
WEDGE_FN uint clz(uint x) { return static_cast<uint>(std::countl_zero(x)); }

WEDGE_SHARED_END

#endif

#endif
