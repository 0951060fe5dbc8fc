#include "host/render/sample_memory.h"

#include "host/device/buffer.h"

#include <cassert>

namespace wedge::render {

cl::Buffer SampleMemory::next(const std::string& name, std::uint64_t bytes)
{
    if (next_ == planes_.size()) {
        const cl::Buffer memory =
            device_ != nullptr ? device::Buffer<std::uint8_t>(*device_, bytes, name).cl() : cl::Buffer();
        planes_.push_back({ name, bytes, memory });
    }
    const Plane& plane = planes_[next_++];
    assert(plane.name == name && plane.bytes == bytes);
    return plane.memory;
}

void SampleMemory::addTo(device::MemoryPlan& plan) const
{
    for (const Plane& plane : planes_) {
        plan.add(plane.name, plane.bytes);
    }
}

} // namespace wedge::render
