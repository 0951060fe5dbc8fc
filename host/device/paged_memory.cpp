#include "host/device/paged_memory.h"

#include "bvh/memory.h"

#include <memory>

namespace wedge::device {
namespace {

struct Free {
    void operator()(void* memory) const noexcept { bvh::freeMemory(memory); }
};

void CL_CALLBACK freeOf(cl_mem, void* memory) { bvh::freeMemory(memory); }

} // namespace

cl::Buffer pagedMemory(const cl::Context& context, std::size_t bytes)
{
    std::unique_ptr<void, Free> memory;
    try {
        memory.reset(bvh::allocateMemory(bytes));
    } catch (const std::bad_alloc&) {
        throw cl::Error(CL_MEM_OBJECT_ALLOCATION_FAILURE, "clCreateBuffer");
    }
    cl::Buffer buffer(context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, memory.get());
    // Called when the last of the buffer, its parts and what is launched on them is gone.
    buffer.setDestructorCallback(freeOf, memory.get());
    (void)memory.release();
    return buffer;
}

} // namespace wedge::device
