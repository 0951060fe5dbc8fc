#include "benchmarks/rays/embree_trace.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

namespace wedge::benchmark {
namespace {

constexpr std::size_t chunk = 1024; ///< rays that a thread takes at a time
constexpr std::size_t streamRays = 256; ///< rays of a stream: they stay within the nearest cache
static_assert(chunk % streamRays == 0 && streamRays % packetRays == 0);

void load(const bvh::Ray& ray, RTCRay& to)
{
    to.org_x = ray.origin.x;
    to.org_y = ray.origin.y;
    to.org_z = ray.origin.z;
    to.tnear = ray.tMin;
    to.dir_x = ray.direction.x;
    to.dir_y = ray.direction.y;
    to.dir_z = ray.direction.z;
    to.time = 0;
    to.tfar = ray.tMax;
    to.mask = ~0u;
    to.id = 0;
    to.flags = 0;
}

void load(const bvh::Ray& ray, RTCRayHit& to)
{
    load(ray, to.ray);
    to.hit.geomID = to.hit.primID = RTC_INVALID_GEOMETRY_ID;
    to.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    to.hit.u = to.hit.v = 0;
}

} // namespace

EmbreeRays::EmbreeRays(const RaySet& set)
    : set_(set)
    , packets_(set.rays.size() / packetRays)
    , found_(set.anyHit ? 0 : packets_.size())
    , occluded_(set.anyHit ? set.rays.size() : 0)
{
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        Packet& p = packets_[i / packetRays];
        const std::size_t lane = i % packetRays;
        const bvh::Ray& ray = set.rays[i];
        p.originX[lane] = ray.origin.x;
        p.originY[lane] = ray.origin.y;
        p.originZ[lane] = ray.origin.z;
        p.tMin[lane] = ray.tMin;
        p.directionX[lane] = ray.direction.x;
        p.directionY[lane] = ray.direction.y;
        p.directionZ[lane] = ray.direction.z;
        p.time[lane] = 0;
        p.tMax[lane] = ray.tMax;
    }
}

void EmbreeRays::trace(const EmbreeScene& scene, EmbreeWay way, Workers& workers)
{
    workers.run(set_.rays.size(), chunk, [&](std::size_t first, std::size_t last) {
        switch (way) {
        case EmbreeWay::Single:
            return single(scene.scene(), first, last);
        case EmbreeWay::Packets:
            return packets(scene.scene(), first, last);
        case EmbreeWay::Stream:
            return stream(scene.scene(), first, last);
        }
    });
}

void EmbreeRays::store(std::size_t ray, const RTCRayHit& from)
{
    Found& found = found_[ray / packetRays];
    const std::size_t lane = ray % packetRays;
    found.t[lane] = from.ray.tfar;
    found.u[lane] = from.hit.u;
    found.v[lane] = from.hit.v;
    found.triangle[lane] = from.hit.primID;
}

void EmbreeRays::single(RTCScene scene, std::size_t first, std::size_t last)
{
    EmbreeQuery query(set_.coherent);
    for (std::size_t i = first; i < last; ++i) {
        RTCRayHit rayHit;
        load(set_.rays[i], rayHit);
        const bool live = isLive(set_.rays[i]);
        if (set_.anyHit) {
            if (live)
                query.occluded(scene, rayHit.ray);
            occluded_[i] = rayHit.ray.tfar < 0 ? 1 : 0;
        } else {
            if (live)
                query.intersect(scene, rayHit);
            store(i, rayHit);
        }
    }
}

void EmbreeRays::packets(RTCScene scene, std::size_t first, std::size_t last)
{
    EmbreeQuery query(set_.coherent);
    RTCRayHit16 rayHit;
    std::fill_n(rayHit.ray.mask, packetRays, ~0u);
    std::fill_n(rayHit.ray.id, packetRays, 0u);
    std::fill_n(rayHit.ray.flags, packetRays, 0u);
    std::fill_n(rayHit.hit.instID[0], packetRays, RTC_INVALID_GEOMETRY_ID);
    static_assert(offsetof(RTCRay16, tfar) == offsetof(Packet, tMax));
    for (std::size_t p = first / packetRays; p < last / packetRays; ++p) {
        const Packet& packet = packets_[p];
        std::memcpy(&rayHit.ray, &packet, offsetof(Packet, tMax) + sizeof packet.tMax);
        alignas(64) int valid[packetRays];
        for (std::size_t lane = 0; lane < packetRays; ++lane)
            valid[lane] = packet.tMax[lane] > packet.tMin[lane] ? -1 : 0;
        if (set_.anyHit) {
            query.occluded(valid, scene, rayHit.ray);
            for (std::size_t lane = 0; lane < packetRays; ++lane)
                occluded_[p * packetRays + lane] = rayHit.ray.tfar[lane] < 0 ? 1 : 0;
        } else {
            std::fill_n(rayHit.hit.geomID, packetRays, RTC_INVALID_GEOMETRY_ID);
            std::fill_n(rayHit.hit.primID, packetRays, RTC_INVALID_GEOMETRY_ID);
            query.intersect(valid, scene, rayHit);
            Found& found = found_[p];
            std::memcpy(found.t, rayHit.ray.tfar, sizeof found.t);
            std::memcpy(found.u, rayHit.hit.u, sizeof found.u);
            std::memcpy(found.v, rayHit.hit.v, sizeof found.v);
            std::memcpy(found.triangle, rayHit.hit.primID, sizeof found.triangle);
        }
    }
}

#if WEDGE_EMBREE_MAJOR == 3
void EmbreeRays::stream(RTCScene scene, std::size_t first, std::size_t last)
{
    EmbreeQuery query(set_.coherent);
    std::array<RTCRayHit, streamRays> rays;
    for (std::size_t begin = first; begin < last; begin += streamRays) {
        const std::size_t count = std::min(streamRays, last - begin);
        for (std::size_t i = 0; i < count; ++i) {
            load(set_.rays[begin + i], rays[i]);
            if (!isLive(set_.rays[begin + i]))
                rays[i].ray.tnear = 1; // a stream takes no mask: an interval that ends before it begins
        }
        const auto n = static_cast<unsigned>(count);
        if (set_.anyHit) {
            query.occludedStream(scene, rays.data(), n);
            for (std::size_t i = 0; i < count; ++i)
                occluded_[begin + i] = rays[i].ray.tfar < 0 ? 1 : 0;
        } else {
            query.intersectStream(scene, rays.data(), n);
            for (std::size_t i = 0; i < count; ++i)
                store(begin + i, rays[i]);
        }
    }
}
#else
void EmbreeRays::stream(RTCScene, std::size_t, std::size_t) { assert(!"Embree 4 has no streams"); }
#endif

std::vector<shared::Hit> EmbreeRays::hits() const
{
    std::vector<shared::Hit> out(set_.rays.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Found& f = found_[i / packetRays];
        const std::size_t lane = i % packetRays;
        out[i] = { f.t[lane], f.u[lane], f.v[lane], f.triangle[lane] };
    }
    return out;
}

} // namespace wedge::benchmark
