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
#include "trace/packet.h"

#include "pass/sampleShadows.h"

/// Samples that a receiver's strata are made for, which is to have `wanted`.
WEDGE_FN uint strataCount(SampleParams params, uint wanted) { return params.strata > 0u ? params.strata : wanted; }

/// A packet's samples while they are taken.
typedef struct {
    Wanted wanted; ///< of the receivers
    Deal deal;
    uint rays[WEDGE_PACKET_SIZE]; ///< traced for each receiver
    uint laneRays[WEDGE_PACKET_SIZE]; ///< and of those, in the lanes of this deal
} LightCounts;

/// The receivers of the lanes, and what they follow.
typedef struct {
    ReceiverPacket receivers;
    Directions directions;
} LightLanes;

/// Sets what each receiver has and is to have.
WEDGE_FN void prepareSamples(SampleParams params, uint lastSample, const ReceiverPacket* receivers,
    __global const uint* wanted, __global const uint* taken, LightCounts* counts)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool shaded = receivers->pixel[lane] != WEDGE_NO_PIXEL;
        const uint i = shaded ? receivers->pixel[lane] : 0u;
        counts->wanted.first[lane] = counts->wanted.next[lane] = shaded ? taken[i] : 0u;
        counts->wanted.last[lane] = shaded ? min(wanted[i], lastSample) : 0u;
        counts->wanted.strata[lane] = strataCount(params, shaded ? wanted[i] : 0u);
        counts->rays[lane] = counts->laneRays[lane] = 0u;
    }
}

WEDGE_FN void countRays(const RayPacket* packet, LightCounts* counts)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        counts->laneRays[lane] += packet->tMax[lane] > 0.0f ? 1u : 0u;
    }
}

/// Adds one direction of a part of each lane that follows them. Of it it is known what arrives: in plain Monte Carlo
/// it weighs nothing; in a ratio its estimate, with that of the points on the light, is of all that arrives and of what
/// is seen of it.
WEDGE_FN void addDirections(SampleParams params, AreaLight light, __global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, uint part, const LightLanes* lanes, LightCounts* counts,
    float (*numbers)[WEDGE_PACKET_SIZE])
{
    RayPacket packet;
    float weight[WEDGE_PACKET_SIZE];
    uint occluded[WEDGE_PACKET_SIZE];
    meetDirections(params, light, &lanes->receivers, part == 1u, lanes->directions.lane[part], counts->deal.index,
        counts->deal.last, counts->deal.count, &packet, weight);
    anyHits(nodes, blocks, &packet, occluded);
    const bool ratio = params.shading == WEDGE_SHADING_RATIO;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        numbers[2u * part][lane] += ratio ? weight[lane] : 0.0f;
        numbers[2u * part + 1u][lane] += occluded[lane] == 0u ? weight[lane] : 0.0f;
    }
    countRays(&packet, counts);
}

/// Takes the points on the light, with what `numbers` have of directions. Receivers that have all their samples wait
/// for the others, and theirs are void. This and takeStep() are inlined by order: where they are calls, NVIDIA's
/// compiler for GPUs has the sinks read what these are handed by value from beyond all memory (docs/porting.md).
WEDGE_INLINE void takePoints(AreaLight light, __global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, LightSamples* s, float (*numbers)[WEDGE_PACKET_SIZE],
    const Sampling* at, LightCounts* counts, Sink* sink, WEDGE_SINK_PARAMETERS)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        s->diffuse[lane] = takesSample(at, lane) ? s->diffuse[lane] : 0.0f;
        s->specular[lane] = takesSample(at, lane) ? s->specular[lane] : 0.0f;
    }
    RayPacket packet;
    shadowRays(light, at->dealt, s, &packet);
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
    float points[WEDGE_SUMS][WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool visible = occluded[lane] == 0u;
        points[0][lane] = s->diffuse[lane];
        points[1][lane] = visible ? s->diffuse[lane] : 0.0f;
#ifdef WEDGE_SPECULAR
        points[2][lane] = s->specular[lane];
        points[3][lane] = visible ? s->specular[lane] : 0.0f;
#endif
    }
    for (uint k = 0u; k < WEDGE_SUMS; ++k) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            numbers[k][lane] += points[k][lane];
        }
    }
    const Samples samples = { (const float(*)[WEDGE_PACKET_SIZE])numbers, (const float(*)[WEDGE_PACKET_SIZE])points,
        &packet, hits };
    takeSamples(at, &samples, sink, WEDGE_SINK_ARGUMENTS);
    countRays(&packet, counts);
}

/// One sample of each lane.
WEDGE_INLINE void takeStep(FrameParams frame, SampleParams params, AreaLight light,
    __global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    const LightLanes* lanes, const Sampling* at, LightCounts* counts, Sink* sink, WEDGE_SINK_PARAMETERS)
{
    LightSamples s;
    sampleLights(frame, params, light, &lanes->receivers, counts->deal.index, counts->deal.count, &s);
    weighPoints(params, light, &lanes->receivers, &lanes->directions, &s);
    float numbers[WEDGE_SUMS][WEDGE_PACKET_SIZE];
    for (uint k = 0u; k < WEDGE_SUMS; ++k) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            numbers[k][lane] = 0.0f;
        }
    }
    for (uint part = 0u; part < WEDGE_VALUES; ++part) {
        if (lanes->directions.any[part]) {
            addDirections(params, light, nodes, blocks, part, lanes, counts, numbers);
        }
    }
    takePoints(light, nodes, blocks, &s, numbers, at, counts, sink, WEDGE_SINK_ARGUMENTS);
}

/// The lanes of a deal that does not keep the receivers' own.
WEDGE_FN void dealLanes(const LightLanes* own, const Deal* deal, LightLanes* dealt)
{
    dealReceivers(&own->receivers, deal, &dealt->receivers);
    dealParts(&own->receivers, deal, &dealt->receivers);
    for (uint part = 0u; part < WEDGE_VALUES; ++part) {
        dealt->directions.any[part] = own->directions.any[part];
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            dealt->directions.lane[part][lane] = own->directions.lane[part][deal->receiver[lane]];
        }
    }
}

__kernel void sampleShadows(PARAMETERS)
{
    LightLanes own, dealt;
    loadReceivers(frame, params.light, firstGroup, WEDGE_RECEIVER_ARGUMENTS, &own.receivers);
    takePart(params, light, &own.receivers);
    chooseDirections(params, light, &own.receivers, &own.directions);
    const uint* pixel = own.receivers.pixel;
    LightCounts counts;
    prepareSamples(params, lastSample, &own.receivers, wanted, taken, &counts);
    Sampling at = { frame.planeSize, params.shading, params.firstPass, &own.receivers, pixel, &counts.wanted,
        &counts.deal };
    Sink sink;
    beginReceivers(&at, &sink, WEDGE_SINK_ARGUMENTS);
    while (dealSamples(&counts.wanted, &counts.deal)) {
        if (!counts.deal.own) {
            dealLanes(&own, &counts.deal, &dealt);
        }
        const LightLanes* lanes = counts.deal.own ? &own : &dealt;
        at.dealt = &lanes->receivers;
        for (uint step = 0u; step < counts.deal.steps; ++step) {
            takeStep(frame, params, light, nodes, blocks, lanes, &at, &counts, &sink, WEDGE_SINK_ARGUMENTS);
            nextStep(&counts.deal);
        }
        moveToReceivers(&counts.deal, counts.laneRays, counts.rays);
    }
    finishReceivers(&at, &sink, WEDGE_SINK_ARGUMENTS);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (hasTaken(&at, lane)) {
            taken[pixel[lane]] = counts.wanted.next[lane];
            rays[pixel[lane]] += counts.rays[lane];
        }
    }
}
