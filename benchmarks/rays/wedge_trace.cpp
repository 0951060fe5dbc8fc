#include "benchmarks/rays/wedge_trace.h"

#include "bvh/packet_layout.h"

#include <cassert>
#include <span>

namespace wedge::benchmark {
namespace {

constexpr std::size_t groupRays = 64; ///< of a work-group, as the renderer launches them

device::BuildOptions programOptions(render::Traversal traversal)
{
    device::BuildOptions out;
    if (traversal == render::Traversal::Scalar)
        out.defines.emplace_back("WEDGE_TRAVERSAL_SCALAR", "1");
    return out;
}

static_assert(sizeof(bvh::Ray) == 8 * sizeof(float), "a ray is what the kernels read");

} // namespace

WedgeTracer::WedgeTracer(const device::Device& device, render::Traversal traversal)
    : device_(device)
    , traversal_(render::resolveTraversal(traversal, device.info()))
    , queue_(device)
    , library_(device, programOptions(traversal_))
{
    for (const char* name : { "traceClosest", "traceClosestPackets", "traceAny", "traceAnyPackets" })
        kernels_.push_back(library_.kernel("trace/trace_test.cl", name));
}

WedgeHierarchy::WedgeHierarchy(WedgeTracer& tracer, std::string modeName, bvh::Bvh built)
    : mode(std::move(modeName))
    , hierarchy(std::move(built), tracer.traversal())
    , nodes(device::Buffer<std::byte>::readOnly(tracer.device(), tracer.queue(), hierarchy.nodes(), "BVH nodes"))
    , blocks(device::Buffer<shared::TriangleBlock>::readOnly(
          tracer.device(), tracer.queue(), bvh().blocks, "triangle blocks"))
{
}

WedgeRays::WedgeRays(WedgeTracer& tracer, const RaySet& set)
    : tracer_(tracer)
    , set_(set)
    , lanes_(render::packetSize(tracer.traversal()))
    , rays_(tracer.device(), bvh::rayWords * set.rays.size(), "rays")
    , packets_(tracer.device(), bvh::rayWords * set.rays.size(), "packets")
    , hits_(tracer.device(), set.anyHit ? 0 : set.rays.size(), "hits")
    , packetHits_(tracer.device(), set.anyHit ? 0 : bvh::hitWords * set.rays.size(), "hits of packets")
    , occluded_(tracer.device(), set.anyHit ? set.rays.size() : 0, "occluded")
{
    assert(set.rays.size() % lanes_ == 0);
    const auto* floats = reinterpret_cast<const float*>(set.rays.data());
    rays_.upload(tracer.queue(), std::span<const float>(floats, bvh::rayWords * set.rays.size()));
    packets_.upload(tracer.queue(), bvh::packRays(set.rays, lanes_));
}

void WedgeRays::trace(const WedgeHierarchy& hierarchy, bool packets)
{
    device::Kernel& kernel = tracer_.kernel(set_.anyHit, packets);
    const std::size_t raysOfItem = packets ? lanes_ : 1;
    const std::size_t items = set_.rays.size() / raysOfItem;
    const device::Buffer<float>& rays = packets ? packets_ : rays_;
    const auto count = static_cast<std::uint32_t>(items);
    if (set_.anyHit)
        kernel.setArgs(rays, occluded_, hierarchy.nodes, hierarchy.blocks, count);
    else if (packets)
        kernel.setArgs(rays, packetHits_, hierarchy.nodes, hierarchy.blocks, count);
    else
        kernel.setArgs(rays, hits_, hierarchy.nodes, hierarchy.blocks, count);
    tracedPackets_ = packets;
    tracer_.queue().launch(set_.name, device::PassKind::Trace, kernel, items, groupRays / raysOfItem);
    tracer_.queue().finish();
}

std::vector<shared::Hit> WedgeRays::hits() const
{
    if (!tracedPackets_)
        return hits_.downloadAll(tracer_.queue());
    return bvh::unpackHits(packetHits_.downloadAll(tracer_.queue()), lanes_, set_.rays.size());
}

} // namespace wedge::benchmark
