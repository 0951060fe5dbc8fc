#pragma once

#include "host/device/device.h"
#include "host/device/memory_plan.h"
#include "host/device/opencl.h"

#include <cstdint>
#include <string>
#include <vector>

namespace wedge::render {

/// Device memory of planes that outlive graphs: each graph asks for the same ones in the same order.
class SampleMemory {
public:
    /// device: null where nothing is allocated, but only planned.
    explicit SampleMemory(const device::Device* device)
        : device_(device)
    {
    }

    /// Of the next graph's planes the first one is asked for next.
    void rewind() { next_ = 0; }
    /// The next plane, allocated when first asked for. Throws Error where the device refuses.
    cl::Buffer next(const std::string& name, std::uint64_t bytes);
    void addTo(device::MemoryPlan& plan) const;

private:
    struct Plane {
        std::string name;
        std::uint64_t bytes;
        cl::Buffer memory;
    };

    const device::Device* device_;
    std::vector<Plane> planes_;
    std::size_t next_ = 0;
};

} // namespace wedge::render
