// Lobes of the pixels of a packet, lane by lane.
#ifndef WEDGE_LOBE_LANES_H
#define WEDGE_LOBE_LANES_H

#include "light/light_packet.h"

#ifdef WEDGE_SPECULAR
/// Lobes of all lanes.
typedef struct {
    float exponent[WEDGE_PACKET_SIZE], normalization[WEDGE_PACKET_SIZE], leastCosine[WEDGE_PACKET_SIZE];
    uint kind[WEDGE_PACKET_SIZE];
} LobeLanes;

/// The lobe, at least as wide as Phong's of the exponent `widest`. Of microfacets what rises at grazing angles stays.
WEDGE_FN Lobe widenedLobe(Lobe lobe, float widest)
{
    const float most = lobe.kind == WEDGE_PHONG ? widest : 4.0f * widest; // as exponentAs() has it
    Lobe wide = makeLobe(fmin(lobe.exponent, most), lobe.kind);
#ifdef WEDGE_GGX
    wide.normalization = lobe.kind == WEDGE_MICROFACETS ? lobe.normalization : wide.normalization;
#endif
    return wide;
}

/// The lobes of receivers, or with widest above 0 widened.
WEDGE_FN void lobesOf(const ReceiverPacket* r, float widest, LobeLanes* lobes)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Lobe own = laneLobe(r, lane);
        const Lobe lobe = widest > 0.0f ? widenedLobe(own, widest) : own;
        lobes->exponent[lane] = lobe.exponent;
        lobes->normalization[lane] = lobe.normalization;
        lobes->leastCosine[lane] = lobe.leastCosine;
        lobes->kind[lane] = lobe.kind;
    }
}

/// What a lane's lobe reflects of a light into its view, 1/sr.
WEDGE_INLINE float lobeOfLane(const ReceiverPacket* r, const LobeLanes* lobes, Vec3 towards, uint lane)
{
    Lobe lobe;
    lobe.exponent = lobes->exponent[lane];
    lobe.normalization = lobes->normalization[lane];
    lobe.leastCosine = lobes->leastCosine[lane];
    lobe.kind = lobes->kind[lane];
    return lobeValue(lobe, laneNormal(r, lane), laneView(r, lane), towards);
}

/// What each lane's lobe reflects of a light's irradiance over its specular reflectance.
WEDGE_FN void lobeWeights(
    const ReceiverPacket* r, const LobeLanes* lobes, Vec3 towards, const float* cosine, float* weight)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const float value = lobeOfLane(r, lobes, towards, lane);
        weight[lane] = cosine[lane] > 0.0f ? value * cosine[lane] : 0.0f;
    }
}
#endif

#endif
