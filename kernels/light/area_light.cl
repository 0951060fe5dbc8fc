// Shadow rays to one area light, from points on it; its sinks (sinks/sums.h) say what becomes of the samples. Where one
// takes hits the nearest occluder along each ray is found, else only whether there is one. Plain Monte Carlo also
// follows reflected directions that meet the light (met_light.h) where these may help; so do ratios of lobes that
// are narrower than the light, whose specular sums then have points on it and directions, weighted by both densities.
//
// in      frame, BVH, the light, receivers; wanted: samples of each when the pass ends; lastSample: where this launch
//         ends
// in out  taken (samples so far), rays (rays traced for the pixel, all lights), and what the sinks have
#include "light/light_sampling.h"
#include "light/met_light.h"
#include "light/sink.h"
#include "trace/packet.h"

/// Samples that a receiver's strata are made for, which is to have `wanted`.
WEDGE_FN uint strataCount(SampleParams params, uint wanted) { return params.strata > 0u ? params.strata : wanted; }

/// A packet's samples while they are taken.
typedef struct {
    uint first[WEDGE_PACKET_SIZE], index[WEDGE_PACKET_SIZE], last[WEDGE_PACKET_SIZE]; ///< see Sampling
    uint count[WEDGE_PACKET_SIZE];
    uint rays[WEDGE_PACKET_SIZE]; ///< traced
} LightCounts;

/// Sets what each lane has and is to have; returns the most samples that one takes now.
WEDGE_FN uint prepareSamples(SampleParams params, uint lastSample, const ReceiverPacket* receivers,
    __global const uint* wanted, __global const uint* taken, LightCounts* counts)
{
    uint steps = 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool shaded = receivers->pixel[lane] != WEDGE_NO_PIXEL;
        const uint i = shaded ? receivers->pixel[lane] : 0u;
        const uint first = shaded ? taken[i] : 0u;
        const uint last = shaded ? min(wanted[i], lastSample) : 0u;
        counts->first[lane] = counts->index[lane] = first;
        counts->last[lane] = last;
        counts->count[lane] = strataCount(params, shaded ? wanted[i] : 0u);
        counts->rays[lane] = 0u;
        steps = max(steps, last > first ? last - first : 0u);
    }
    return steps;
}

WEDGE_FN void countRays(const RayPacket* packet, LightCounts* counts)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        counts->rays[lane] += packet->tMax[lane] > 0.0f ? 1u : 0u;
    }
}

/// Takes one direction of a part of each lane that follows them. Of it it is known what arrives: in plain Monte Carlo
/// it weighs nothing; in a ratio its estimate, with that of the points on the light, is of all that arrives and of what
/// is seen of it.
WEDGE_FN void takeDirections(SampleParams params, AreaLight light, __global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, uint part, const Directions* directions, const Sampling* at,
    LightCounts* counts, Sink* sink, WEDGE_SINK_PARAMETERS)
{
    RayPacket packet;
    float weight[WEDGE_PACKET_SIZE];
    uint occluded[WEDGE_PACKET_SIZE];
    meetDirections(params, light, at->receivers, part == 1u, directions->lane[part], at->index, at->last, at->count,
        &packet, weight);
    anyHits(nodes, blocks, &packet, occluded);
    const bool ratio = params.shading == WEDGE_SHADING_RATIO;
    float numbers[WEDGE_SUMS][WEDGE_PACKET_SIZE];
    for (uint k = 0u; k < WEDGE_SUMS; ++k) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const bool all = k == 2u * part && ratio, seen = k == 2u * part + 1u && occluded[lane] == 0u;
            numbers[k][lane] = all || seen ? weight[lane] : 0.0f;
        }
    }
    const Samples samples = { numbers, &packet, 0 };
    takeSamples(at, &samples, sink, WEDGE_SINK_ARGUMENTS);
    countRays(&packet, counts);
}

/// Takes the points on the light. Receivers that have all their samples wait for the others, and theirs are void.
WEDGE_FN void takePoints(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    LightSamples* s, const Sampling* at, LightCounts* counts, Sink* sink, WEDGE_SINK_PARAMETERS)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        s->diffuse[lane] = at->index[lane] < at->last[lane] ? s->diffuse[lane] : 0.0f;
        s->specular[lane] = at->index[lane] < at->last[lane] ? s->specular[lane] : 0.0f;
    }
    RayPacket packet;
    shadowRays(at->receivers, s, &packet);
    uint occluded[WEDGE_PACKET_SIZE];
#ifdef WEDGE_SINK_TAKES_HITS
    PacketHits nearest;
    closestHits(nodes, blocks, &packet, &nearest);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        occluded[lane] = nearest.triangle[lane] != WEDGE_NO_TRIANGLE ? 1u : 0u;
    }
    const PacketHits* hits = &nearest;
#else
    anyHits(nodes, blocks, &packet, occluded);
    const PacketHits* hits = 0;
#endif
    float numbers[WEDGE_SUMS][WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool visible = occluded[lane] == 0u;
        numbers[0][lane] = s->diffuse[lane];
        numbers[1][lane] = visible ? s->diffuse[lane] : 0.0f;
#ifdef WEDGE_SPECULAR
        numbers[2][lane] = s->specular[lane];
        numbers[3][lane] = visible ? s->specular[lane] : 0.0f;
#endif
    }
    const Samples samples = { numbers, &packet, hits };
    takeSamples(at, &samples, sink, WEDGE_SINK_ARGUMENTS);
    countRays(&packet, counts);
}

__kernel void sampleShadows(FrameParams frame, SampleParams params, AreaLight light,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    WEDGE_RECEIVER_PARAMETERS, __global const uint* restrict wanted, uint lastSample, __global uint* restrict taken,
    __global uint* restrict rays, WEDGE_SINK_PARAMETERS, uint firstGroup)
{
    ReceiverPacket receivers;
    loadReceivers(frame, params.light, firstGroup, WEDGE_RECEIVER_ARGUMENTS, &receivers);
    takePart(params, light, &receivers);
    Directions directions;
    chooseDirections(params, light, &receivers, &directions);
    LightCounts counts;
    const uint steps = prepareSamples(params, lastSample, &receivers, wanted, taken, &counts);
    const Sampling at = { frame.planeSize, params.shading, params.firstPass, &receivers, receivers.pixel, counts.first,
        counts.index, counts.last, counts.count };
    Sink sink;
    beginReceivers(&at, &sink, WEDGE_SINK_ARGUMENTS);
    for (uint step = 0u; step < steps; ++step) {
        LightSamples s;
        sampleLights(frame, params, light, &receivers, counts.index, counts.count, &s);
        weighPoints(params, light, &receivers, &directions, &s);
        for (uint part = 0u; part < WEDGE_VALUES; ++part) {
            if (directions.any[part]) {
                takeDirections(
                    params, light, nodes, blocks, part, &directions, &at, &counts, &sink, WEDGE_SINK_ARGUMENTS);
            }
        }
        takePoints(nodes, blocks, &s, &at, &counts, &sink, WEDGE_SINK_ARGUMENTS);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            counts.index[lane] += counts.index[lane] < counts.last[lane] ? 1u : 0u;
        }
    }
    finishReceivers(&at, &sink, WEDGE_SINK_ARGUMENTS);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (hasTaken(&at, lane)) {
            taken[receivers.pixel[lane]] = counts.index[lane];
            rays[receivers.pixel[lane]] += counts.rays[lane];
        }
    }
}
