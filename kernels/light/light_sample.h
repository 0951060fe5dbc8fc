// What is shaded, and how samples of lights count for it.
#ifndef WEDGE_LIGHT_SAMPLE_H
#define WEDGE_LIGHT_SAMPLE_H

#include "core/receivers.h"
#include "shared/bsdf.h"
#include "shared/light.h"

/// The point a sample is for.
typedef struct {
    Vec3 origin; ///< where its shadow rays start
    Vec3 position; ///< what is shaded
    Vec3 normal; ///< unit
    Vec3 view; ///< unit, to the eye
    Lobe lobe; ///< of the specular reflection
} Receiver;

/// The lobe of a gloss plane's value.
WEDGE_INLINE Lobe glossLobe(uint packed) { return lobeOf(unpackGloss(packed)); }

/// Seed of the samples of a pixel and light.
WEDGE_FN uint receiverSeed(FrameParams frame, uint light, uint x, uint y)
{
    return hashCombine(hashCombine(frame.seed, light), pixelNumber(frame, x, y));
}

WEDGE_FN Receiver loadReceiver(FrameParams frame, ReceiverData data, uint i)
{
    Receiver r;
    r.origin = loadVec(data.origin, frame.planeSize, i);
    r.position = loadVec(data.position, frame.planeSize, i);
    r.normal = loadVec(data.normal, frame.planeSize, i);
    r.view = viewOf(frame, data, i, r.position);
    r.lobe = glossLobe(data.gloss[i]);
    return r;
}

/// The quantity that is filtered: weighted mean visibility, or for WEDGE_SHADING_INSIDE the mean of the weights of
/// visible samples. Divides by what was taken, never by what was asked for; 0 where nothing was.
WEDGE_FN float termValue(uint shading, float weights, float visible, uint taken)
{
    if (shading == WEDGE_SHADING_INSIDE) {
        return taken > 0u ? visible / (float)taken : 0.0f;
    }
    return weights > 0.0f ? visible / weights : 0.0f;
}

#endif
