#pragma once

/// Embree 3.13 or 4, whichever configuring found (WEDGE_EMBREE_MAJOR). The calls whose form changed between the two.
#if WEDGE_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

namespace wedge::benchmark {

#if WEDGE_EMBREE_MAJOR == 3

/// Whether rays can be handed over in streams; Embree 4 has them no more.
constexpr bool embreeHasStreams = true;

/// What goes with each call.
class EmbreeQuery {
public:
    explicit EmbreeQuery(bool coherent)
    {
        rtcInitIntersectContext(&context_);
        context_.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }
    void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context_, &ray); }
    void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &context_, &ray); }
    void intersect(const int* valid, RTCScene scene, RTCRayHit16& rays)
    {
        rtcIntersect16(valid, scene, &context_, &rays);
    }
    void occluded(const int* valid, RTCScene scene, RTCRay16& rays) { rtcOccluded16(valid, scene, &context_, &rays); }
    /// `count` rays that lie one behind the other.
    void intersectStream(RTCScene scene, RTCRayHit* rays, unsigned count)
    {
        rtcIntersect1M(scene, &context_, rays, count, sizeof *rays);
    }
    void occludedStream(RTCScene scene, RTCRayHit* rays, unsigned count)
    {
        rtcOccluded1M(scene, &context_, &rays->ray, count, sizeof *rays);
    }

private:
    RTCIntersectContext context_;
};

#else

constexpr bool embreeHasStreams = false;

class EmbreeQuery {
public:
    explicit EmbreeQuery(bool coherent)
    {
        rtcInitIntersectArguments(&intersect_);
        rtcInitOccludedArguments(&occluded_);
        intersect_.flags = occluded_.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    }
    void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &intersect_); }
    void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, &occluded_); }
    void intersect(const int* valid, RTCScene scene, RTCRayHit16& rays)
    {
        rtcIntersect16(valid, scene, &rays, &intersect_);
    }
    void occluded(const int* valid, RTCScene scene, RTCRay16& rays) { rtcOccluded16(valid, scene, &rays, &occluded_); }

private:
    RTCIntersectArguments intersect_;
    RTCOccludedArguments occluded_;
};

#endif

} // namespace wedge::benchmark
