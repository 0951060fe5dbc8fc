// How bright the samples of a term are, before they are stored as colours: the median luminance of a few pixels of the
// whole frame is shown as middle grey, whatever part of it is rendered.
#include "core/formats.h"
#include "core/pixel.h"
#include "shared/bsdf.h"
#include "shared/filter_params.h"
#include "shared/sample_filter.h"

/// Samples of the pixels that are looked at.
/// in   objectId: where it is known
/// out  wanted
#include "pass/probeCounts.h"
#ifdef PASS_probeCounts
__kernel void probeCounts(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    bool probe = x % WEDGE_PROBE_STEP == 0u && y % WEDGE_PROBE_STEP == 0u;
#if HAS_objectId
    probe = probe && objectId[i] != 0u;
#endif
    wanted[i] = probe ? WEDGE_PROBE_SAMPLES : 0u;
}
#endif

/// The exposure of their median, over pixels that any light reaches; 1 where there are none. One work-item. Bins are an
/// eighth of an octave, by the bits of floats: twice the light has half the exposure, exactly.
/// in   p: of the whole image; sums: R, G, B of a pixel's samples; taken
/// out  bins: WEDGE_PROBE_BINS; exposure: one number
#include "pass/exposureOfProbes.h"
#ifdef PASS_exposureOfProbes
__kernel void exposureOfProbes(PARAMETERS)
{
    if (get_global_id(0) != 0u) {
        return;
    }
    for (uint bin = 0u; bin < WEDGE_PROBE_BINS; ++bin) {
        bins[bin] = 0u;
    }
    uint count = 0u;
    for (uint y = p.y0; y < p.y1; y += WEDGE_PROBE_STEP) {
        for (uint x = p.x0; x < p.x1; x += WEDGE_PROBE_STEP) {
            const uint i = pixelIndex(x, y, p.stride);
            const float l = taken[i] > 0u ? luminance(loadVec(sums, p.planeSize, i)) / (float)taken[i] : 0.0f;
            // Neither what is no number nor what some devices take for 0: by its bits, since fast maths lets compilers
            // take any number for finite.
            const uint bits = as_uint(l);
            if (bits >= as_uint(1e-30f) && bits <= as_uint(1e30f)) {
                bins[bits >> 20] += 1u;
                ++count;
            }
        }
    }
    uint bin = 0u, below = 0u;
    while (count > 0u && below + bins[bin] <= count / 2u) {
        below += bins[bin++];
    }
    exposure[0] = count > 0u ? WEDGE_MIDDLE_GREY / as_float(bin << 20 | 1u << 19) : 1.0f;
}
#endif
