// Samples of an area light for the pixels of a packet, lane by lane. Loops over lanes are kept apart and simple, so
// that compilers turn them into vectors.
#ifndef WEDGE_LIGHT_PACKET_H
#define WEDGE_LIGHT_PACKET_H

#include "core/deal.h"
#include "core/receivers.h"
#include "light/light_sample.h"
#include "light/scene_light.h"
#include "trace/packet.h"

/// What the samples are for. Lanes without a pixel to shade have pixel = WEDGE_NO_PIXEL and a zero normal.
typedef struct {
    uint pixel[WEDGE_PACKET_SIZE]; ///< index in the planes of the receivers
    uint seed[WEDGE_PACKET_SIZE]; ///< of pixel and light
    float originX[WEDGE_PACKET_SIZE], originY[WEDGE_PACKET_SIZE], originZ[WEDGE_PACKET_SIZE];
    float positionX[WEDGE_PACKET_SIZE], positionY[WEDGE_PACKET_SIZE], positionZ[WEDGE_PACKET_SIZE];
    float normalX[WEDGE_PACKET_SIZE], normalY[WEDGE_PACKET_SIZE], normalZ[WEDGE_PACKET_SIZE];
    uint gloss[WEDGE_PACKET_SIZE]; ///< as in the plane of that name
    uint cut[WEDGE_PACKET_SIZE], turned[WEDGE_PACKET_SIZE]; ///< of the light's part that is sampled, see LightPart
    float first[WEDGE_PACKET_SIZE], range[WEDGE_PACKET_SIZE], height[WEDGE_PACKET_SIZE];
    float inner[WEDGE_PACKET_SIZE], outer[WEDGE_PACKET_SIZE];
    bool anyCut;
#ifdef WEDGE_MOTION
    float time[WEDGE_PACKET_SIZE]; ///< of the receiver's primary ray, and so of all its others
#endif
#ifdef WEDGE_SPECULAR
    float viewX[WEDGE_PACKET_SIZE], viewY[WEDGE_PACKET_SIZE], viewZ[WEDGE_PACKET_SIZE]; ///< unit, to the eye
    float exponent[WEDGE_PACKET_SIZE], normalization[WEDGE_PACKET_SIZE],
        leastCosine[WEDGE_PACKET_SIZE]; ///< of the lobe
    uint kind[WEDGE_PACKET_SIZE];
#endif
} ReceiverPacket;

#ifdef WEDGE_SPECULAR
WEDGE_INLINE Lobe laneLobe(const ReceiverPacket* r, uint lane)
{
    Lobe lobe;
    lobe.exponent = r->exponent[lane];
    lobe.kind = r->kind[lane];
    lobe.normalization = r->normalization[lane];
    lobe.leastCosine = r->leastCosine[lane];
    return lobe;
}

WEDGE_INLINE Vec3 laneView(const ReceiverPacket* r, uint lane)
{
    return vec3(r->viewX[lane], r->viewY[lane], r->viewZ[lane]);
}
#endif

/// Time of a lane's receiver; 0 where nothing moves.
WEDGE_FN float receiverTime(const ReceiverPacket* r, uint lane)
{
#ifdef WEDGE_MOTION
    return r->time[lane];
#else
    (void)r;
    (void)lane;
    return 0.0f;
#endif
}

/// One sample a lane.
typedef struct {
    float rayX[WEDGE_PACKET_SIZE], rayY[WEDGE_PACKET_SIZE],
        rayZ[WEDGE_PACKET_SIZE]; ///< from origin to the light's point
    float diffuse[WEDGE_PACKET_SIZE]; ///< weight of the sample's visibility in the diffuse term, 0: no ray is needed
    float specular[WEDGE_PACKET_SIZE]; ///< the same in the specular term
} LightSamples;

/// The receivers of this work-item, and what is to be shaded there.
WEDGE_FN void loadReceivers(
    FrameParams frame, uint light, uint firstGroup, ReceiverData data, ReceiverPacket* receivers)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        uint i = 0u, x = 0u, y = 0u;
        const bool inside = receiverOf(frame, data, firstGroup, lane, &i, &x, &y);
        const bool shaded = inside && data.objectId[i] != 0u;
        const Vec3 none = vec3(0.0f, 0.0f, 0.0f);
        const Vec3 o = shaded ? loadVec(data.origin, frame.planeSize, i) : none;
        const Vec3 p = shaded ? loadVec(data.position, frame.planeSize, i) : none;
        const Vec3 n = shaded ? loadVec(data.normal, frame.planeSize, i) : none;
        receivers->pixel[lane] = shaded ? i : WEDGE_NO_PIXEL;
        receivers->seed[lane] = inside ? receiverSeed(frame, light, x, y) : 0u;
        receivers->originX[lane] = o.x;
        receivers->originY[lane] = o.y;
        receivers->originZ[lane] = o.z;
        receivers->positionX[lane] = p.x;
        receivers->positionY[lane] = p.y;
        receivers->positionZ[lane] = p.z;
        receivers->normalX[lane] = n.x;
        receivers->normalY[lane] = n.y;
        receivers->normalZ[lane] = n.z;
        receivers->gloss[lane] = shaded ? data.gloss[i] : 0u;
#ifdef WEDGE_MOTION
        receivers->time[lane] = shaded && frame.receivers > 0u ? data.time[i] : 0.0f;
#endif
#ifdef WEDGE_SPECULAR
        const Vec3 view = shaded ? viewOf(frame, data, i, p) : vecNormalize(vecSub(frame.eye, p));
        receivers->viewX[lane] = view.x;
        receivers->viewY[lane] = view.y;
        receivers->viewZ[lane] = view.z;
        const Lobe lobe = glossLobe(receivers->gloss[lane]);
        receivers->exponent[lane] = lobe.exponent;
        receivers->kind[lane] = lobe.kind;
        receivers->normalization[lane] = lobe.normalization;
        receivers->leastCosine[lane] = lobe.leastCosine;
#endif
    }
}

#define WEDGE_DEALT(field) out->field[lane] = r->field[from]

/// The receivers whose samples the lanes take.
WEDGE_FN void dealReceivers(const ReceiverPacket* r, const Deal* deal, ReceiverPacket* out)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint from = deal->receiver[lane];
        WEDGE_DEALT(pixel);
        WEDGE_DEALT(seed);
        WEDGE_DEALT(originX);
        WEDGE_DEALT(originY);
        WEDGE_DEALT(originZ);
        WEDGE_DEALT(positionX);
        WEDGE_DEALT(positionY);
        WEDGE_DEALT(positionZ);
        WEDGE_DEALT(normalX);
        WEDGE_DEALT(normalY);
        WEDGE_DEALT(normalZ);
        WEDGE_DEALT(gloss);
#ifdef WEDGE_MOTION
        WEDGE_DEALT(time);
#endif
#ifdef WEDGE_SPECULAR
        WEDGE_DEALT(viewX);
        WEDGE_DEALT(viewY);
        WEDGE_DEALT(viewZ);
        WEDGE_DEALT(exponent);
        WEDGE_DEALT(normalization);
        WEDGE_DEALT(leastCosine);
        WEDGE_DEALT(kind);
#endif
    }
}

/// The parts of the light that they sample, see takePart().
WEDGE_FN void dealParts(const ReceiverPacket* r, const Deal* deal, ReceiverPacket* out)
{
    out->anyCut = r->anyCut;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint from = deal->receiver[lane];
        WEDGE_DEALT(cut);
        WEDGE_DEALT(turned);
        WEDGE_DEALT(first);
        WEDGE_DEALT(range);
        WEDGE_DEALT(height);
        WEDGE_DEALT(inner);
        WEDGE_DEALT(outer);
    }
}
#undef WEDGE_DEALT

WEDGE_INLINE LightPart lanePart(const ReceiverPacket* r, uint lane)
{
    LightPart part;
    part.cut = r->cut[lane];
    part.turned = r->turned[lane];
    part.first = r->first[lane];
    part.range = r->range[lane];
    part.height = r->height[lane];
    part.inner = r->inner[lane];
    part.outer = r->outer[lane];
    return part;
}

/// Samples of the light are of its part above each lane's horizon; as published of all of it, and those below are void.
WEDGE_FN void takePart(SampleParams params, AreaLight light, ReceiverPacket* r)
{
    uint any = 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const LightPart part = partAboveHorizon(light, vec3(r->positionX[lane], r->positionY[lane], r->positionZ[lane]),
            vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]));
        r->cut[lane] = params.shading != WEDGE_SHADING_SEPARATE ? part.cut : 0u;
        r->turned[lane] = part.turned;
        r->first[lane] = part.first;
        r->range[lane] = part.range;
        r->height[lane] = part.height;
        r->inner[lane] = part.inner;
        r->outer[lane] = part.outer;
        any |= r->cut[lane];
    }
    r->anyCut = any != 0u;
}

WEDGE_INLINE Vec3 lanePosition(const ReceiverPacket* r, uint lane)
{
    return vec3(r->positionX[lane], r->positionY[lane], r->positionZ[lane]);
}

WEDGE_INLINE Vec3 laneNormal(const ReceiverPacket* r, uint lane)
{
    return vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
}

/// How far a lane's shadow rays start from the point that is shaded.
WEDGE_INLINE Vec3 laneLift(const ReceiverPacket* r, uint lane)
{
    return vecSub(vec3(r->originX[lane], r->originY[lane], r->originZ[lane]), lanePosition(r, lane));
}

/// From the point that is shaded to a lane's sample of the light.
WEDGE_INLINE Vec3 sampleVector(const ReceiverPacket* r, const LightSamples* s, uint lane)
{
    return vecAdd(vec3(s->rayX[lane], s->rayY[lane], s->rayZ[lane]), laneLift(r, lane));
}

/// Position in [0,1)^2 of sample `index` of `count`.
WEDGE_FN Vec2 stratifiedPosition(SampleParams params, uint index, uint count, uint order, uint seed)
{
    // Each pass has strata of its own: the count of the second is not known during the first.
    return index < params.firstPass
        ? stratified(index, params.firstPass, order, seed)
        : stratified(index - params.firstPass, count - params.firstPass, order, hashUint(seed));
}

/// stratifiedPosition() of all lanes, which are at the same sample of as many: the stratum is found once.
WEDGE_FN void samplePositionsTogether(
    SampleParams params, uint order, const uint* seed, uint index, uint count, float* u, float* v)
{
    const bool first = index < params.firstPass;
    const uint i = first ? index : index - params.firstPass;
    const uint n = first ? params.firstPass : count - params.firstPass;
    const Strata strata = strataOf(n);
    const uint stratum = permuteIndex(i % n, n, order ^ (i / n));
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec2 p = stratumPoint(strata, stratum, hashCombine(first ? seed[lane] : hashUint(seed[lane]), i));
        u[lane] = p.x;
        v[lane] = p.y;
    }
}

/// Position in [0,1)^2 of sample `index` of `count` of each lane; those of lanes that have taken all theirs do not
/// matter. order: of the strata, the same in all pixels of a light.
WEDGE_FN void samplePositions(
    SampleParams params, uint order, const uint* seed, const uint* index, const uint* count, float* u, float* v)
{
    if (params.sampler == WEDGE_SAMPLER_SOBOL) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const Vec2 p = sobolOwen(index[lane], seed[lane]);
            u[lane] = p.x;
            v[lane] = p.y;
        }
        return;
    }
    uint active = 0u;
    bool together = true;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        active = index[lane] < count[lane] ? lane : active;
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        together &= index[lane] >= count[lane] || (index[lane] == index[active] && count[lane] == count[active]);
    }
    if (together && index[active] < count[active]) {
        samplePositionsTogether(params, order, seed, index[active], count[active], u, v);
        return;
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec2 p = index[lane] < count[lane]
            ? stratifiedPosition(params, index[lane], count[lane], order, seed[lane])
            : vec2(0.5f, 0.5f);
        u[lane] = p.x;
        v[lane] = p.y;
    }
}

/// Sample index[lane] of count[lane] for each receiver. Weights are 0 in lanes without a pixel and below its horizon.
WEDGE_FN void sampleLights(FrameParams frame, SampleParams params, AreaLight light, const ReceiverPacket* r,
    const uint* index, const uint* count, LightSamples* s)
{
    float u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE];
    samplePositions(params, hashCombine(frame.seed, params.light), r->seed, index, count, u, v);
    const bool separate = params.shading == WEDGE_SHADING_SEPARATE;
    float mass[WEDGE_PACKET_SIZE];
    if (r->anyCut) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const PartSample p = samplePart(light, lanePart(r, lane), vec2(u[lane], v[lane]));
            u[lane] = p.a;
            v[lane] = p.b;
            mass[lane] = r->cut[lane] != 0u ? p.mass : 1.0f;
        }
    } else {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            u[lane] = lightCoordinate(u[lane], light.profile, light.cut, light.erfCut);
            v[lane] = lightCoordinate(v[lane], light.profile, light.cut, light.erfCut);
            mass[lane] = 1.0f;
        }
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 point = lightPoint(light.centre, light.halfU, light.halfV, u[lane], v[lane]);
        const Vec3 position = vec3(r->positionX[lane], r->positionY[lane], r->positionZ[lane]);
        const Vec3 normal = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
        const Vec3 d = vecSub(point, position);
        const float own = isInLight(light, position) ? 0.0f : mass[lane];
        const float geometry = own * geometryTerm(normal, d, light.normal, light.twoSided);
        s->rayX[lane] = point.x - r->originX[lane];
        s->rayY[lane] = point.y - r->originY[lane];
        s->rayZ[lane] = point.z - r->originZ[lane];
        s->diffuse[lane] = separate && geometry > 0.0f ? 1.0f : geometry;
        s->specular[lane] = separate && geometry > 0.0f ? 1.0f : 0.0f;
    }
#ifdef WEDGE_SPECULAR
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 normal = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
        const Vec3 l = vecNormalize(sampleVector(r, s, lane));
        const float value = s->diffuse[lane] * lobeValue(laneLobe(r, lane), normal, laneView(r, lane), l);
        s->specular[lane] = separate ? s->specular[lane] : value;
    }
#endif
}

/// The shadow rays of samples whose weight is not 0.
WEDGE_FN void shadowRays(AreaLight light, const ReceiverPacket* r, const LightSamples* s, RayPacket* packet)
{
    const float end = shadowRayEnd(light);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setRay(packet, lane, vec3(r->originX[lane], r->originY[lane], r->originZ[lane]),
            liftedRay(light, vec3(s->rayX[lane], s->rayY[lane], s->rayZ[lane])), 0.0f,
            s->diffuse[lane] > 0.0f ? end : 0.0f);
        setTime(packet, lane, receiverTime(r, lane));
    }
}

#endif
