#pragma once

#include "benchmarks/rays/embree_scene.h"
#include "benchmarks/rays/ray_sets.h"
#include "benchmarks/rays/workers.h"
#include "kernels/shared/hit.h"

#include <cstdint>
#include <vector>

namespace wedge::benchmark {

/// Ways to hand rays to Embree.
enum class EmbreeWay {
    Single, ///< rtcIntersect1, rtcOccluded1
    Packets, ///< 16 at a time
    Stream, ///< rtcIntersect1M, rtcOccluded1M
};

/// A ray set as Embree takes it, laid out before anything is timed: its packets need no conversion, while the kernels
/// of ours make their packets as they go. And room for what it finds.
class EmbreeRays {
public:
    explicit EmbreeRays(const RaySet& set);

    /// Traces all rays; the results stay here until the next call.
    void trace(const EmbreeScene& scene, EmbreeWay way, Workers& workers);

    /// Of a set of closest hits, after trace().
    std::vector<shared::Hit> hits() const;
    /// Of a set of any hits: 1 where something was hit, 0 elsewhere.
    const std::vector<std::uint32_t>& occluded() const { return occluded_; }

private:
    /// Rays of a packet, in the order of RTCRay16's members.
    struct alignas(64) Packet {
        float originX[packetRays], originY[packetRays], originZ[packetRays], tMin[packetRays];
        float directionX[packetRays], directionY[packetRays], directionZ[packetRays], time[packetRays];
        float tMax[packetRays];
    };
    /// What a packet found.
    struct alignas(64) Found {
        float t[packetRays], u[packetRays], v[packetRays];
        std::uint32_t triangle[packetRays];
    };

    void single(RTCScene scene, std::size_t first, std::size_t last);
    void packets(RTCScene scene, std::size_t first, std::size_t last);
    void stream(RTCScene scene, std::size_t first, std::size_t last);
    void store(std::size_t ray, const RTCRayHit& from);

    const RaySet& set_;
    std::vector<Packet> packets_;
    std::vector<Found> found_; ///< of all ways
    std::vector<std::uint32_t> occluded_;
};

} // namespace wedge::benchmark
