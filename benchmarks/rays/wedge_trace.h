#pragma once

#include "benchmarks/rays/ray_sets.h"
#include "bvh/bvh.h"
#include "host/device/buffer.h"
#include "host/device/program.h"
#include "host/device/queue.h"
#include "host/render/hierarchy.h"

#include <memory>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// A device with the kernels that trace rays from buffers.
class WedgeTracer {
public:
    WedgeTracer(const device::Device& device, render::Traversal traversal);

    device::TimedQueue& queue() { return queue_; }
    const device::Device& device() const { return device_; }
    /// The family of traversals, never Automatic.
    render::Traversal traversal() const { return traversal_; }
    device::Kernel& kernel(bool anyHit, bool packets) { return kernels_[(anyHit ? 2u : 0u) + (packets ? 1u : 0u)]; }

private:
    device::Device device_;
    render::Traversal traversal_;
    device::TimedQueue queue_;
    device::ProgramLibrary library_;
    std::vector<device::Kernel> kernels_;
};

/// A hierarchy on the device.
struct WedgeHierarchy {
    WedgeHierarchy(WedgeTracer& tracer, std::string mode, bvh::Bvh built);

    const bvh::Bvh& bvh() const { return hierarchy.bvh; }

    std::string mode; ///< "" for the default, or what --bvh calls it
    render::Hierarchy hierarchy;
    device::Buffer<std::byte> nodes;
    device::Buffer<shared::TriangleBlock> blocks;
};

/// A ray set on the device, and room for what is found.
class WedgeRays {
public:
    WedgeRays(WedgeTracer& tracer, const RaySet& set);

    /// Traces all rays and waits; the results stay on the device until the next call.
    void trace(const WedgeHierarchy& hierarchy, bool packets);

    std::vector<shared::Hit> hits() const { return hits_.downloadAll(tracer_.queue()); }
    std::vector<std::uint32_t> occluded() const { return occluded_.downloadAll(tracer_.queue()); }

private:
    WedgeTracer& tracer_;
    const RaySet& set_;
    device::Buffer<float> rays_;
    device::Buffer<shared::Hit> hits_;
    device::Buffer<std::uint32_t> occluded_;
};

} // namespace wedge::benchmark
