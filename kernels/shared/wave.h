// Waves: lists of receivers, many to a pixel, that are traced together (kernels/waves/waves.cl).
#ifndef WEDGE_SHARED_WAVE_H
#define WEDGE_SHARED_WAVE_H

#include "compat.h"

/// Object id of a pixel that sees several.
#define WEDGE_MIXED 0xffffffffu

/// Receivers of a wave at most: enough to fill a large device, few enough to stay in a CPU's caches.
#define WEDGE_WAVE_RECEIVERS (1u << 17)

WEDGE_SHARED_BEGIN

/// One wave: the receivers of some tiles' pixels, pixel by pixel.
typedef struct {
    uint firstTile, tiles; ///< of the frame's rectangle, in the order in which tiles are taken
    uint receivers;
    uint planeSize; ///< elements of a plane of the wave's
    uint lastSample; ///< primary samples that a pixel has at most when the wave is done
    uint sampler; ///< WEDGE_SAMPLER_*
    uint firstPass; ///< primary samples of a first pass with strata of its own; 0: none
    uint published; ///< 1: terms are kept as the thesis has them, see accumulate.h
    uint alike; ///< 1: every pixel takes samples up to lastSample, whatever it wants
    float oneVelocity; ///< largest difference of motions that lean frames take for one, as a fraction of the motion
} WaveParams;

/// Samples that a pixel that wants so many has when the wave is done.
WEDGE_FN uint wantedSamples(WaveParams wave, uint wanted)
{
    return wave.alike != 0u ? wave.lastSample : min(wanted, wave.lastSample);
}

/// Of `total` samples that `count` receivers of a pixel share evenly, those that the first `index` of them have.
WEDGE_FN uint sharedSamples(uint index, uint count, uint total)
{
    // Those left over go to the first ones: the first points of a sequence are spread as evenly as all of them.
    const uint left = total % count;
    return index * (total / count) + (index < left ? index : left);
}

WEDGE_SHARED_END

#endif
