// The unshadowed shading of a wave's receivers by one light: their textures in its term.
#include "light/unshadowed.h"
#include "shared/wave.h"

#ifdef WEDGE_SPECULAR
/// unpackDirection() of sixteen.
WEDGE_FN Vec3x16 unpackDirection16(uint16 packed)
{
    const float16 a = convert_float16(packed & 65535u) * (2.0f / 65535.0f) - 1.0f;
    const float16 b = convert_float16(packed >> 16) * (2.0f / 65535.0f) - 1.0f;
    Vec3x16 v;
    v.z = 1.0f - fabs(a) - fabs(b);
    v.x = v.z >= 0.0f ? a : copysign(1.0f - fabs(b), a);
    v.y = v.z >= 0.0f ? b : copysign(1.0f - fabs(a), b);
    return unit16(v);
}

/// Directions of a lobe for each receiver: its pixel has many, which take them in turn.
#define WEDGE_LOBE_DIRECTIONS 24u
#endif

/// in   nodes: as of unshadowed.h; wave's planes: pixelOf, sampleOf (waves.cl), position, normal, specular (3 each),
///      objectId, gloss, view
/// out  unshadowed: mean geometry term over the light, 1/m^2, as the light's samples estimate it; 0 without a surface;
/// in a
///      second plane, where something is specular, mean lobe times geometry term, 1/(sr m^2)
#include "pass/unshadowedReceivers.h"
#ifdef PASS_unshadowedReceivers
__kernel void unshadowedReceivers(PARAMETERS)
{
    const uint first = get_global_id(0) * WEDGE_BLOCK_PIXELS;
    if (frame.tileCount == 0u || first >= wave.receivers) {
        return;
    }
    // Planes of a wave are whole blocks; what lies beyond the last receiver is of an earlier wave, and read by nobody.
    const int16 surface = loadIdBlock(objectId, (int)first) != 0u;
    const Vec3x16 at = loadVecBlock(position, wave.planeSize, (int)first);
    const Vec3x16 facing = loadVecBlock(normal, wave.planeSize, (int)first);
    vstore16(unshadowedDiffuse(light, mattReceivers(at, facing), nodes, surface), 0, unshadowed + first);
#ifdef WEDGE_SPECULAR
    const Vec3x16 ks = loadVecBlock(specular, wave.planeSize, (int)first);
    const int16 mirrors = surface & (ks.x + ks.y + ks.z > 0.0f);
    float16 lobes = (float16)(0.0f);
    if (any(mirrors)) {
        const Receivers16 r = glossyReceivers(
            at, facing, unpackDirection16(loadIdBlock(view, (int)first)), loadIdBlock(gloss, (int)first));
        LobeDirections directions;
        directions.pixel = loadIdBlock(pixelOf, (int)first);
        directions.first = loadIdBlock(sampleOf, (int)first) * WEDGE_LOBE_DIRECTIONS;
        directions.count = WEDGE_LOBE_DIRECTIONS;
        directions.seed = frame.seed;
        lobes = unshadowedSpecular(light, r, nodes, mirrors, directions);
    }
    vstore16(lobes, 0, unshadowed + wave.planeSize + first);
#else
    (void)pixelOf;
    (void)sampleOf;
    (void)specular;
    (void)gloss;
    (void)view;
#endif
}
#endif
