#include "benchmarks/rays/wedge_trace.h"

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
        kernels_.push_back(library_.kernel("trace_test.cl", name));
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
    , rays_(tracer.device(), 8 * set.rays.size(), "rays")
    , hits_(tracer.device(), set.anyHit ? 0 : set.rays.size(), "hits")
    , occluded_(tracer.device(), set.anyHit ? set.rays.size() : 0, "occluded")
{
    const auto* floats = reinterpret_cast<const float*>(set.rays.data());
    rays_.upload(tracer.queue(), std::span<const float>(floats, 8 * set.rays.size()));
}

void WedgeRays::trace(const WedgeHierarchy& hierarchy, bool packets)
{
    device::Kernel& kernel = tracer_.kernel(set_.anyHit, packets);
    const auto count = static_cast<std::uint32_t>(set_.rays.size());
    if (set_.anyHit)
        kernel.setArgs(rays_, occluded_, hierarchy.nodes, hierarchy.blocks, count);
    else
        kernel.setArgs(rays_, hits_, hierarchy.nodes, hierarchy.blocks, count);
    const std::size_t raysOfItem = packets ? render::packetSize(tracer_.traversal()) : 1;
    tracer_.queue().launch(
        set_.name, device::PassKind::Trace, kernel, set_.rays.size() / raysOfItem, groupRays / raysOfItem);
    tracer_.queue().finish();
}

} // namespace wedge::benchmark
