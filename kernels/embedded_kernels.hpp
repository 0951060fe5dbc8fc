#pragma once

#include <span>
#include <string_view>

namespace wedge {

/// One file of kernels/, embedded at build time.
struct EmbeddedKernel {
    std::string_view path; ///< relative to kernels/, "primary.cl" or "shared/vec.h"
    std::string_view text;
};

/// All device sources, sorted by path.
std::span<const EmbeddedKernel> embeddedKernels();

} // namespace wedge
