// Shadow rays to one area light: the first pass finds the nearest occluder along each ray and measures slopes, the
// second only asks whether there is one. Plain Monte Carlo, which has the second alone, also follows reflected
// directions that meet the light (met_light.h); so do ratios of lobes that are narrower than the light, in both passes,
// whose specular sums then have points on the light and directions, weighted by both densities.
//
// in      frame, BVH, the light, receivers; wanted: samples of each when the pass ends
// in out  sums (planes: diffuse weights, diffuse weights of visible samples, and the same for specular),
//         taken (samples so far), rays (rays traced for the pixel, all lights)
// out     value (planes: diffuse, specular; of frames with a first pass, then the same of the first of the samples' two
//         parts, firstPart()): what is filtered; slopes (planes: s_min, s_max; 0 where no ray was
//         occluded; where things move, then of the shadows' motions in the image, pixels while the shutter is open:
//         sums of x, y and squares, and how many)
#include "light/met_light.h"
#include "shared/camera.h"
#include "shared/wedge.h"
#include "trace/packet.h"
#include "trace/surface.h"

/// Occluders count as at least this part of the shadow ray's length away from the light.
#define WEDGE_LEAST_LIGHT_DISTANCE 0.02f

/// What the samples of a packet's pixels add up to.
typedef struct {
    float diffuse[WEDGE_PACKET_SIZE], diffuseVisible[WEDGE_PACKET_SIZE];
    float specular[WEDGE_PACKET_SIZE], specularVisible[WEDGE_PACKET_SIZE];
    uint rays[WEDGE_PACKET_SIZE];
} TermSums;

/// The sums when the first of two parts of the samples was complete.
typedef struct {
    float diffuse[WEDGE_PACKET_SIZE], diffuseVisible[WEDGE_PACKET_SIZE];
    float specular[WEDGE_PACKET_SIZE], specularVisible[WEDGE_PACKET_SIZE];
    uint samples[WEDGE_PACKET_SIZE]; ///< in that part; WEDGE_NO_PART: it is known already, or not wanted
    uint complete[WEDGE_PACKET_SIZE];
} PartSums;

#define WEDGE_NO_PART 0xffffffffu

WEDGE_FN void startPart(uint lane, uint samples, PartSums* part)
{
    part->diffuse[lane] = part->diffuseVisible[lane] = part->specular[lane] = part->specularVisible[lane] = 0.0f;
    part->samples[lane] = samples;
    part->complete[lane] = 0u;
}

/// Keeps the sums of lanes that have just as many samples.
WEDGE_FN void keepPart(const uint* index, const TermSums* sums, PartSums* part)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool now = index[lane] == part->samples[lane];
        part->complete[lane] = now ? 1u : part->complete[lane];
        part->diffuse[lane] = now ? sums->diffuse[lane] : part->diffuse[lane];
        part->diffuseVisible[lane] = now ? sums->diffuseVisible[lane] : part->diffuseVisible[lane];
        part->specular[lane] = now ? sums->specular[lane] : part->specular[lane];
        part->specularVisible[lane] = now ? sums->specularVisible[lane] : part->specularVisible[lane];
    }
}

/// Samples that a receiver's strata are made for, which is to have `wanted`.
WEDGE_FN uint strataCount(SampleParams params, uint wanted) { return params.strata > 0u ? params.strata : wanted; }

/// Counts a sample of each lane; receivers that have all theirs wait for the others, and theirs are void.
WEDGE_FN void takeSamples(const uint* last, uint* index, LightSamples* s)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        s->diffuse[lane] = index[lane] < last[lane] ? s->diffuse[lane] : 0.0f;
        s->specular[lane] = index[lane] < last[lane] ? s->specular[lane] : 0.0f;
        index[lane] += index[lane] < last[lane] ? 1u : 0u;
    }
}

/// Adds one sample a lane; visible: 1 or 0.
WEDGE_FN void addSamples(const LightSamples* s, const uint* occluded, TermSums* sums)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool visible = occluded[lane] == 0u;
        sums->diffuse[lane] += s->diffuse[lane];
        sums->diffuseVisible[lane] += visible ? s->diffuse[lane] : 0.0f;
        sums->specular[lane] += s->specular[lane];
        sums->specularVisible[lane] += visible ? s->specular[lane] : 0.0f;
        sums->rays[lane] += s->diffuse[lane] > 0.0f ? 1u : 0u;
    }
}

/// One reflected direction of the diffuse part and one of the specular part a lane, into the visible sums.
WEDGE_FN void addDirections(SampleParams params, AreaLight light, __global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, const ReceiverPacket* receivers, const uint* index, const uint* last,
    const uint* count, TermSums* sums)
{
#ifdef WEDGE_SPECULAR
    const uint parts = 2u;
#else
    const uint parts = 1u;
#endif
    for (uint part = 0u; part < parts; ++part) {
        RayPacket packet;
        float weight[WEDGE_PACKET_SIZE];
        uint occluded[WEDGE_PACKET_SIZE];
        meetDirections(params, light, receivers, part == 1u, index, last, count, &packet, weight);
        anyHits(nodes, blocks, &packet, occluded);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const float arrives = occluded[lane] == 0u ? weight[lane] : 0.0f;
            sums->diffuseVisible[lane] += part == 0u ? arrives : 0.0f;
            sums->specularVisible[lane] += part == 1u ? arrives : 0.0f;
            sums->rays[lane] += packet.tMax[lane] > 0.0f ? 1u : 0u;
        }
    }
}

#ifdef WEDGE_SPECULAR
/// One direction of the lobe of each lane that has a narrow one, into both sums of the specular term: with the points
/// on the light, weighted by both densities, its estimate of all that arrives and of what is seen of it.
WEDGE_FN void addLobes(SampleParams params, AreaLight light, __global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, const ReceiverPacket* receivers, const uint* narrow,
    const uint* index, const uint* last, const uint* count, TermSums* sums)
{
    RayPacket packet;
    float weight[WEDGE_PACKET_SIZE];
    uint occluded[WEDGE_PACKET_SIZE];
    meetDirections(params, light, receivers, true, index, last, count, &packet, weight);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        packet.tMax[lane] = narrow[lane] != 0u ? packet.tMax[lane] : 0.0f;
    }
    anyHits(nodes, blocks, &packet, occluded);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const float arrives = narrow[lane] != 0u ? weight[lane] : 0.0f;
        sums->specular[lane] += arrives;
        sums->specularVisible[lane] += occluded[lane] == 0u ? arrives : 0.0f;
        sums->rays[lane] += packet.tMax[lane] > 0.0f ? 1u : 0u;
    }
}
#endif

WEDGE_FN void storeTerm(SampleParams params, uint size, uint i, const TermSums* sums, uint lane, uint taken,
    __global float* sumPlanes, __global uint* takenPlane, __global float* value)
{
    const float weights = sums->diffuse[lane], visible = sums->diffuseVisible[lane];
    sumPlanes[i] = weights;
    sumPlanes[size + i] = visible;
    value[i] = termValue(params.shading, weights, visible, taken);
#ifdef WEDGE_SPECULAR
    const float specular = sums->specular[lane], specularVisible = sums->specularVisible[lane];
    sumPlanes[2u * size + i] = specular;
    sumPlanes[3u * size + i] = specularVisible;
    // A lobe that no sample reached says nothing: what is seen of the light at all stands for what it sees. 0 would
    // darken its highlight, and those of neighbours that gather it.
    const bool reached = specular > 0.0f || params.shading == WEDGE_SHADING_INSIDE;
    value[size + i] = reached ? termValue(params.shading, specular, specularVisible, taken) : value[i];
#endif
    takenPlane[i] = taken;
}

/// What the first part alone would be filtered as.
WEDGE_FN void storePart(SampleParams params, uint size, uint i, const PartSums* part, uint lane, __global float* value)
{
    if (part->complete[lane] == 0u) {
        return;
    }
    const uint n = part->samples[lane];
    const float diffuse = termValue(params.shading, part->diffuse[lane], part->diffuseVisible[lane], n);
#ifdef WEDGE_SPECULAR
    const bool reached = part->specular[lane] > 0.0f || params.shading == WEDGE_SHADING_INSIDE;
    value[2u * size + i] = diffuse;
    value[3u * size + i] =
        reached ? termValue(params.shading, part->specular[lane], part->specularVisible[lane], n) : diffuse;
#else
    value[size + i] = diffuse;
#endif
}

#ifdef WEDGE_MOTION
/// What moves of the shadows at a packet's receivers.
typedef struct {
    float x[WEDGE_PACKET_SIZE], y[WEDGE_PACKET_SIZE]; ///< sums of motions in pixels over the shutter
    float squared[WEDGE_PACKET_SIZE], count[WEDGE_PACKET_SIZE];
} ShadowMotion;

WEDGE_FN ShadowMotion noShadowMotion(void)
{
    ShadowMotion m;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        m.x[lane] = m.y[lane] = m.squared[lane] = m.count[lane] = 0.0f;
    }
    return m;
}

/// Adds the motion in the image of the shadow that hit, `along` of the way to the light's point, throws at the lane's
/// receiver: the occluder's, seen from that point, on the receiver's plane.
WEDGE_FN void addShadowMotion(
    CameraParams camera, SurfaceData surfaces, Hit hit, const ReceiverPacket* r, uint lane, Vec3 ray, ShadowMotion* m)
{
    const Vec3 p = vec3(r->positionX[lane], r->positionY[lane], r->positionZ[lane]);
    const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
    const Vec3 cast = vecScale(hitMotion(surfaces, hit), 1.0f / fmax(1.0f - hit.t, WEDGE_LEAST_LIGHT_DISTANCE));
    const float facing = vecDot(n, ray);
    const Vec3 moved = vecMad(cast, ray, -vecDot(n, cast) / fmax(facing, 1e-20f));
    const Vec2 before = projectPoint(camera, vecMad(p, moved, -0.5f), 0.5f);
    const Vec2 after = projectPoint(camera, vecMad(p, moved, 0.5f), 0.5f);
    const float x = after.x - before.x, y = after.y - before.y;
    m->x[lane] += x;
    m->y[lane] += y;
    m->squared[lane] += x * x + y * y;
    m->count[lane] += 1.0f;
}
#endif

__kernel void firstPass(FrameParams frame, SampleParams params, AreaLight light, CameraParams camera,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    WEDGE_SURFACE_PARAMETERS, WEDGE_RECEIVER_PARAMETERS, __global const uint* restrict wanted,
    __global float* restrict sums, __global uint* restrict taken, __global float* restrict value,
    __global float* restrict slopes, __global uint* restrict rays, uint firstGroup)
{
    const uint size = frame.planeSize;
    ReceiverPacket receivers;
    loadReceivers(frame, params.light, firstGroup, WEDGE_RECEIVER_ARGUMENTS, &receivers);
    takePart(params, light, &receivers);
    TermSums sum;
    PartSums part;
    const bool parts = params.firstPass > 0u;
#ifdef WEDGE_SPECULAR
    uint narrow[WEDGE_PACKET_SIZE];
    const bool lobes = narrowLobes(params, light, &receivers, narrow);
#endif
    const SurfaceData surfaces = WEDGE_SURFACE_ARGUMENTS;
    (void)surfaces;
    (void)camera;
#ifdef WEDGE_MOTION
    ShadowMotion shadows = noShadowMotion();
#endif
    float sMin[WEDGE_PACKET_SIZE], sMax[WEDGE_PACKET_SIZE];
    uint index[WEDGE_PACKET_SIZE], count[WEDGE_PACKET_SIZE], last[WEDGE_PACKET_SIZE], occluded[WEDGE_PACKET_SIZE];
    uint steps = 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool shaded = receivers.pixel[lane] != WEDGE_NO_PIXEL;
        const uint i = shaded ? receivers.pixel[lane] : 0u;
        sum.diffuse[lane] = sum.diffuseVisible[lane] = sum.specular[lane] = sum.specularVisible[lane] = 0.0f;
        sum.rays[lane] = 0u;
        sMin[lane] = WEDGE_SLOPE_MAX * 2.0f;
        sMax[lane] = 0.0f;
        index[lane] = shaded ? taken[i] : 0u;
        last[lane] = shaded ? wanted[i] : 0u;
        count[lane] = strataCount(params, last[lane]);
        steps = max(steps, last[lane] - min(index[lane], last[lane]));
        startPart(lane, parts ? params.firstPass / 2u : WEDGE_NO_PART, &part);
    }
    for (uint step = 0u; step < steps; ++step) {
        LightSamples s;
        sampleLights(frame, params, light, &receivers, index, count, &s);
#ifdef WEDGE_SPECULAR
        if (lobes) {
            weighLobePoints(light, &receivers, narrow, &s);
            addLobes(params, light, nodes, blocks, &receivers, narrow, index, last, count, &sum);
        }
#endif
        takeSamples(last, index, &s);
        RayPacket packet;
        shadowRays(&receivers, &s, &packet);
        PacketHits hits;
        closestHits(nodes, blocks, &packet, &hits);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            occluded[lane] = hits.triangle[lane] != WEDGE_NO_TRIANGLE ? 1u : 0u;
            const float slope = slopeOfHit(hits.t[lane]);
            sMin[lane] = occluded[lane] != 0u ? fmin(sMin[lane], slope) : sMin[lane];
            sMax[lane] = occluded[lane] != 0u ? fmax(sMax[lane], slope) : sMax[lane];
        }
#ifdef WEDGE_MOTION
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            if (occluded[lane] != 0u) {
                addShadowMotion(camera, surfaces, packetHit(&hits, lane), &receivers, lane,
                    vec3(s.rayX[lane], s.rayY[lane], s.rayZ[lane]), &shadows);
            }
        }
#endif
        addSamples(&s, occluded, &sum);
        if (parts) {
            keepPart(index, &sum, &part);
        }
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i == WEDGE_NO_PIXEL) {
            continue;
        }
        storeTerm(params, size, i, &sum, lane, index[lane], sums, taken, value);
        storePart(params, size, i, &part, lane, value);
        slopes[i] = sMax[lane] > 0.0f ? sMin[lane] : 0.0f;
        slopes[size + i] = sMax[lane];
#ifdef WEDGE_MOTION
        slopes[2u * size + i] = shadows.x[lane];
        slopes[3u * size + i] = shadows.y[lane];
        slopes[4u * size + i] = shadows.squared[lane];
        slopes[5u * size + i] = shadows.count[lane];
#endif
        rays[i] += sum.rays[lane];
    }
}

__kernel void secondPass(FrameParams frame, SampleParams params, AreaLight light,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    WEDGE_RECEIVER_PARAMETERS, __global const uint* restrict wanted, uint lastSample, __global float* restrict sums,
    __global uint* restrict taken, __global float* restrict value, __global uint* restrict rays, uint firstGroup)
{
    const uint size = frame.planeSize;
    ReceiverPacket receivers;
    loadReceivers(frame, params.light, firstGroup, WEDGE_RECEIVER_ARGUMENTS, &receivers);
    takePart(params, light, &receivers);
    TermSums sum;
    PartSums part;
    const bool parts = params.firstPass > 0u;
#ifdef WEDGE_SPECULAR
    uint narrow[WEDGE_PACKET_SIZE];
    const bool lobes = narrowLobes(params, light, &receivers, narrow);
#endif
    uint index[WEDGE_PACKET_SIZE], count[WEDGE_PACKET_SIZE], last[WEDGE_PACKET_SIZE], occluded[WEDGE_PACKET_SIZE];
    const bool directions = params.lightSampling != WEDGE_LIGHTS_SAMPLED && params.shading == WEDGE_SHADING_INSIDE;
    uint steps = 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool shaded = receivers.pixel[lane] != WEDGE_NO_PIXEL;
        const uint i = shaded ? receivers.pixel[lane] : 0u;
        index[lane] = shaded ? taken[i] : 0u;
        count[lane] = strataCount(params, shaded ? wanted[i] : 0u);
        last[lane] = shaded ? min(wanted[i], lastSample) : 0u;
        steps = max(steps, last[lane] > index[lane] ? last[lane] - index[lane] : 0u);
        // The first pass kept its own half for those that stay below twice its count.
        const uint all = shaded ? wanted[i] : 0u;
        startPart(
            lane, parts && all >= 2u * params.firstPass ? firstPart(all, params.firstPass) : WEDGE_NO_PART, &part);
        sum.diffuse[lane] = shaded ? sums[i] : 0.0f;
        sum.diffuseVisible[lane] = shaded ? sums[size + i] : 0.0f;
        sum.specular[lane] = sum.specularVisible[lane] = 0.0f;
#ifdef WEDGE_SPECULAR
        sum.specular[lane] = shaded ? sums[2u * size + i] : 0.0f;
        sum.specularVisible[lane] = shaded ? sums[3u * size + i] : 0.0f;
#endif
        sum.rays[lane] = 0u;
    }
    if (parts) {
        keepPart(index, &sum, &part);
    }
    for (uint step = 0u; step < steps; ++step) {
        LightSamples s;
        sampleLights(frame, params, light, &receivers, index, count, &s);
        if (directions) {
            weighPoints(params, light, &receivers, &s);
            addDirections(params, light, nodes, blocks, &receivers, index, last, count, &sum);
        }
#ifdef WEDGE_SPECULAR
        if (lobes) {
            weighLobePoints(light, &receivers, narrow, &s);
            addLobes(params, light, nodes, blocks, &receivers, narrow, index, last, count, &sum);
        }
#endif
        takeSamples(last, index, &s);
        RayPacket packet;
        shadowRays(&receivers, &s, &packet);
        anyHits(nodes, blocks, &packet, occluded);
        addSamples(&s, occluded, &sum);
        if (parts) {
            keepPart(index, &sum, &part);
        }
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i != WEDGE_NO_PIXEL && index[lane] > taken[i]) {
            storeTerm(params, size, i, &sum, lane, index[lane], sums, taken, value);
            storePart(params, size, i, &part, lane, value);
            rays[i] += sum.rays[lane];
        }
    }
}
