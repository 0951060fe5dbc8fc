#pragma once

#include "bvh/narrow_tree.h"
#include "bvh/packet_layout.h"
#include "host/device/buffer.h"
#include "host/device/program.h"
#include "host/device/queue.h"
#include "tests/bvh_rays.h"

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cstring>
#include <span>

/// Sends rays through hierarchies on OpenCL devices, by each family of traversals.
namespace wedge::test {

enum class Family { Wide, Scalar };

/// A hierarchy as both families walk it.
struct Tree {
    explicit Tree(const bvh::Bvh& hierarchy)
        : wide(hierarchy)
        , narrow(bvh::narrow(hierarchy))
    {
    }
    explicit Tree(const TestMesh& mesh, const bvh::Config& config = {})
        : Tree(bvh::build(mesh.view(), config))
    {
    }

    bvh::Bvh wide;
    std::vector<shared::BvhNode4> narrow;
};

/// A hierarchy over geometry that moves as both families walk it.
struct MovingTree {
    explicit MovingTree(bvh::MovingBvh hierarchy)
        : wide(std::move(hierarchy))
        , narrow(bvh::narrow(wide))
    {
    }

    bvh::MovingBvh wide;
    std::vector<shared::MovingNode4> narrow;
};

enum class Geometry { Still, Moving };

/// Runs the kernels of trace_test.cl on one device, over a Tree or, with Geometry::Moving, a MovingTree.
class Tracer {
public:
    /// cutouts: the trees have a table of cut-outs behind their blocks.
    explicit Tracer(const device::Device& device, Family family = Family::Wide, Geometry geometry = Geometry::Still,
        bool cutouts = false)
        : device_(device)
        , family_(family)
        , queue_(device)
        , library_(device, options(family, geometry, cutouts))
    {
    }

    /// times: one a ray.
    std::vector<Hit> closest(const MovingTree& tree, std::span<const Ray> rays, std::span<const float> times)
    {
        return run<Hit>("traceClosest", tree, std::span<const float>(withTimes(rays, times)), rays.size(), rays.size());
    }
    std::vector<std::uint32_t> any(const MovingTree& tree, std::span<const Ray> rays, std::span<const float> times)
    {
        return run<std::uint32_t>(
            "traceAny", tree, std::span<const float>(withTimes(rays, times)), rays.size(), rays.size());
    }
    std::vector<Hit> closestPackets(const MovingTree& tree, std::span<const Ray> rays, std::span<const float> times)
    {
        return closestPacked(tree, bvh::packRays(rays, packetSize(), times), rays.size());
    }
    std::vector<std::uint32_t> anyPackets(
        const MovingTree& tree, std::span<const Ray> rays, std::span<const float> times)
    {
        return anyPacked(tree, bvh::packRays(rays, packetSize(), times), rays.size());
    }

    std::vector<Hit> closest(const Tree& tree, std::span<const Ray> rays)
    {
        return run<Hit>("traceClosest", tree, rays, rays.size(), rays.size());
    }
    /// 1 for each ray that hits anything, else 0.
    std::vector<std::uint32_t> any(const Tree& tree, std::span<const Ray> rays)
    {
        return run<std::uint32_t>("traceAny", tree, rays, rays.size(), rays.size());
    }
    /// The same in packets of consecutive rays.
    std::vector<Hit> closestPackets(const Tree& tree, std::span<const Ray> rays)
    {
        return closestPacked(tree, bvh::packRays(rays, packetSize()), rays.size());
    }
    std::vector<std::uint32_t> anyPackets(const Tree& tree, std::span<const Ray> rays)
    {
        return anyPacked(tree, bvh::packRays(rays, packetSize()), rays.size());
    }

    /// Rays that a work-item of the packet kernels takes.
    std::size_t packetSize() const { return family_ == Family::Wide ? WEDGE_WIDE_PACKET_SIZE : 1; }

private:
    static device::BuildOptions options(Family family, Geometry geometry, bool cutouts)
    {
        device::BuildOptions out;
        if (geometry == Geometry::Moving)
            out.defines.emplace_back("WEDGE_MOTION", "1");
        if (cutouts)
            out.defines.emplace_back("WEDGE_CUTOUTS", "1");
        if (family == Family::Scalar)
            out.defines.emplace_back("WEDGE_TRAVERSAL_SCALAR", "1");
        return out;
    }

    /// The rays' floats, then their times.
    static std::vector<float> withTimes(std::span<const Ray> rays, std::span<const float> times)
    {
        std::vector<float> out(bvh::rayWords * rays.size());
        if (!rays.empty())
            std::memcpy(out.data(), rays.data(), rays.size_bytes());
        out.insert(out.end(), times.begin(), times.end());
        return out;
    }

    template <typename AnyTree>
    std::vector<Hit> closestPacked(const AnyTree& tree, const std::vector<float>& packed, std::size_t rays)
    {
        const std::size_t packets = (rays + packetSize() - 1) / packetSize();
        const auto words = run<std::uint32_t>(
            "traceClosestPackets", tree, std::span(packed), packets, packets * packetSize() * bvh::hitWords);
        return bvh::unpackHits(words, packetSize(), rays);
    }

    template <typename AnyTree>
    std::vector<std::uint32_t> anyPacked(const AnyTree& tree, const std::vector<float>& packed, std::size_t rays)
    {
        const std::size_t packets = (rays + packetSize() - 1) / packetSize();
        auto found = run<std::uint32_t>("traceAnyPackets", tree, std::span(packed), packets, packets * packetSize());
        found.resize(rays);
        return found;
    }

    /// Launches `items` work-items over the input, which leave `count` results.
    template <typename Result, typename AnyTree, typename Input>
    std::vector<Result> run(
        const char* name, const AnyTree& tree, std::span<const Input> input, std::size_t items, std::size_t count)
    {
        const auto bytes =
            family_ == Family::Wide ? std::as_bytes(std::span(tree.wide.nodes)) : std::as_bytes(std::span(tree.narrow));
        device::Buffer<Input> rayBuffer(device_, input.size(), "rays");
        device::Buffer<Result> results(device_, count, "results");
        device::Buffer<std::byte> nodes(device_, bytes.size(), "nodes");
        const auto blockBytes = std::as_bytes(std::span(tree.wide.blocks));
        device::Buffer<std::byte> blocks(device_, blockBytes.size(), "blocks");
        rayBuffer.upload(queue_, input);
        nodes.upload(queue_, bytes);
        if (!blockBytes.empty())
            blocks.upload(queue_, blockBytes);
        std::vector<Result> untouched(count);
        std::memset(static_cast<void*>(untouched.data()), 0x5a, untouched.size() * sizeof(Result));
        results.upload(queue_, untouched);
        device::Kernel kernel = library_.kernel("trace/trace_test.cl", name);
        kernel.setArgs(rayBuffer, results, nodes, blocks, static_cast<std::uint32_t>(items));
        const std::size_t local = std::min<std::size_t>(64, kernel.workGroupLimit());
        queue_.launch(name, device::PassKind::Trace, kernel, items, local);
        return results.downloadAll(queue_);
    }

    device::Device device_;
    Family family_;
    device::TimedQueue queue_;
    device::ProgramLibrary library_;
};

/// Calls test(device) for each usable device here.
template <typename Test>
void onDevices(const Test& test)
{
    unsigned used = 0;
    for (const device::DeviceInfo& info : device::listDevices()) {
        if (!info.unusable.empty())
            continue;
        CAPTURE(info.name);
        test(device::Device::open(std::to_string(info.index)));
        used++;
    }
    REQUIRE(used > 0);
}

/// Calls test(tracer) for each family of traversals on each usable device.
template <typename Test>
void onEveryTracer(const Test& test)
{
    onDevices([&](const device::Device& device) {
        for (const Family family : { Family::Wide, Family::Scalar }) {
            CAPTURE((family == Family::Wide ? "wide" : "scalar"));
            Tracer tracer(device, family);
            test(tracer);
        }
    });
}

inline bool sameBits(const Hit& a, const Hit& b)
{
    using Words = std::array<std::uint32_t, 4>;
    return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
}

inline bool sameBits(const std::vector<Hit>& a, const std::vector<Hit>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Hit)) == 0;
}

} // namespace wedge::test
