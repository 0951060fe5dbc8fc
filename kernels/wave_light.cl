// The unshadowed shading of a wave's receivers by one light: their textures in its term.
#include "shared/wave.h"
#include "unshadowed.h"

#ifdef WEDGE_SPECULAR
/// Specular shading of the sixteen receivers from `first` on: -1 in lanes whose lobes are too sharp for a quadrature.
WEDGE_FN float16 specularShading16(WaveParams wave, AreaLight light, __global const float* nodes, uint first, Vec3x16 position,
                                   Vec3x16 normal, int16 surface, __global const float* specular,
                                   __global const float* gloss, __global const uint* view)
{
    Receivers16 r;
    r.position = position;
    r.normal = normal;
    float lanes[4][WEDGE_BLOCK_PIXELS];
    for (uint lane = 0u; lane < WEDGE_BLOCK_PIXELS; ++lane) {
        const uint i = first + lane;
        const Vec3 v = unpackDirection(view[i]);
        lanes[0][lane] = v.x;
        lanes[1][lane] = v.y;
        lanes[2][lane] = v.z;
        lanes[3][lane] = luminance(loadVec(specular, wave.planeSize, i));
    }
    r.view.x = vload16(0, lanes[0]);
    r.view.y = vload16(0, lanes[1]);
    r.view.z = vload16(0, lanes[2]);
    const float16 signedExponent = loadBlock(gloss, (int)first);
    r.exponent = fabs(signedExponent);
    r.phong = signedExponent < 0.0f;
    const Vec3x16 toLight = sub16(splat3(light.centre), position);
    const float16 across = lobesAcross(light, 1.0f, 1.0f) * max16(r.exponent, (float16)(1.0f)) / dot16(toLight, toLight);
    const int16 mirrors = surface & (vload16(0, lanes[3]) > 0.0f);
    const int16 sharp = across > WEDGE_SHARP_LOBE;
    if (!any(mirrors & !sharp)) {
        return sharp ? (float16)(-1.0f) : (float16)(0.0f);
    }
    float16 sum = unshadowedLobes(light, r, nodes, WEDGE_COARSE_NODES);
    const int16 fine = mirrors & !sharp & (across >= WEDGE_COARSE_LOBE);
    if (any(fine)) {
        sum = fine ? unshadowedLobes(light, r, nodes + 2u * WEDGE_COARSE_NODES, WEDGE_FINE_NODES) : sum;
    }
    const float16 m = r.exponent;
    const float16 phong = (m + 2.0f) * (0.5f * WEDGE_INV_PI);
    const float16 blinn = (m + 2.0f) * (m + 4.0f) * (0.125f * WEDGE_INV_PI) / (exp2Block(-0.5f * m) + m);
    return sharp ? (float16)(-1.0f) : sum * (r.phong ? phong : blinn);
}
#endif

/// in   nodes: as of unshadowed.h; wave's planes: position, normal, specular (3 each), objectId, gloss, view
/// out  unshadowed: mean geometry term over the light, 1/m^2, as the light's samples estimate it; 0 without a surface; in a
///      second plane, where something is specular, mean lobe times geometry term, 1/(sr m^2), -1 where only samples tell
__kernel void unshadowedReceivers(FrameParams frame, WaveParams wave, AreaLight light, __global const float* restrict nodes,
                                  __global const float* restrict position, __global const float* restrict normal,
                                  __global const uint* restrict objectId, __global const float* restrict specular,
                                  __global const float* restrict gloss, __global const uint* restrict view,
                                  __global float* restrict unshadowed)
{
    const uint first = get_global_id(0) * WEDGE_BLOCK_PIXELS;
    if (frame.tileCount == 0u || first >= wave.receivers) {
        return;
    }
    // Planes of a wave are whole blocks; what lies beyond the last receiver is of an earlier wave, and read by nobody.
    const int16 surface = loadIdBlock(objectId, (int)first) != 0u;
    const Vec3x16 at = loadVecBlock(position, wave.planeSize, (int)first);
    const Vec3x16 facing = loadVecBlock(normal, wave.planeSize, (int)first);
    const float16 shading = unshadowedWhere(light, at, facing, nodes, surface);
    vstore16(surface ? shading : (float16)(0.0f), 0, unshadowed + first);
#ifdef WEDGE_SPECULAR
    vstore16(specularShading16(wave, light, nodes, first, at, facing, surface, specular, gloss, view), 0,
             unshadowed + wave.planeSize + first);
#else
    (void)specular;
    (void)gloss;
    (void)view;
#endif
}
