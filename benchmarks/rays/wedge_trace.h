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

    /// What the last call found.
    std::vector<shared::Hit> hits() const;
    std::vector<std::uint32_t> occluded() const { return occluded_.downloadAll(tracer_.queue()); }

private:
    WedgeTracer& tracer_;
    const RaySet& set_;
    std::size_t lanes_; ///< of a packet
    device::Buffer<float> rays_, packets_; ///< ray by ray, and in packets
    device::Buffer<shared::Hit> hits_;
    device::Buffer<std::uint32_t> packetHits_; ///< words of PacketHits
    bool tracedPackets_ = false;
    device::Buffer<std::uint32_t> occluded_;
};

} // namespace wedge::benchmark
