#pragma once

#include "host/device/opencl.h"

#include <cstddef>

namespace wedge::device {

/// So many bytes for kernels of a CPU device to read and write, in huge pages where the system has them: each tile of a
/// frame is in the rows of some twenty planes, which are as many small pages as processors find their way in. Throws
/// cl::Error.
cl::Buffer pagedMemory(const cl::Context& context, std::size_t bytes);

} // namespace wedge::device
