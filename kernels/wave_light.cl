// The unshadowed shading of a wave's receivers by one light: their textures in its term.
#include "shared/wave.h"
#include "unshadowed.h"

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

/// Specular shading of the sixteen receivers from `first` on: -1 in lanes whose lobes are too sharp for a quadrature,
/// 0 where nothing is specular.
WEDGE_FN float16 specularShading16(WaveParams wave, AreaLight light, __global const float* nodes, uint first, Vec3x16 position,
                                   Vec3x16 normal, int16 surface, __global const float* specular,
                                   __global const float* gloss, __global const uint* view)
{
    const Vec3x16 reflected = loadVecBlock(specular, wave.planeSize, (int)first);
    const int16 mirrors = surface & (reflected.x + reflected.y + reflected.z > 0.0f);
    if (!any(mirrors)) {
        return (float16)(0.0f);
    }
    Receivers16 r;
    r.position = position;
    r.normal = normal;
    r.view = unpackDirection16(loadIdBlock(view, (int)first));
    r.cosine = dot16(normal, r.view);
    const float16 signedExponent = loadBlock(gloss, (int)first);
    r.exponent = fabs(signedExponent);
    r.phong = signedExponent < 0.0f;
    const Vec3x16 toLight = sub16(splat3(light.centre), position);
    const float16 squared = dot16(toLight, toLight);
    const float extent = squaredExtent(light);
    const float16 across = lobesAcross16(light, toLight, r);
    const int16 sharp = across > WEDGE_SHARP_LOBE, horizon = horizonAcross(light, toLight, normal);
    const int16 fine = (across >= WEDGE_COARSE_LOBE) | (squared < extent * WEDGE_NEAR_LIGHT * WEDGE_NEAR_LIGHT);
    const int16 few = !horizon & (across < WEDGE_FEW_LOBE) & (squared >= extent * WEDGE_FAR_LIGHT * WEDGE_FAR_LIGHT);
    const int16 wanted = mirrors & !sharp;
    float16 sum = (float16)(0.0f);
    if (any(wanted & few)) {
        sum = unshadowedLobes(light, r, nodes + WEDGE_FEW_OFFSET, WEDGE_FEW_NODES);
    }
    if (any(wanted & !few & !fine)) {
        sum = (!few & !fine) ? unshadowedLobes(light, r, nodes, WEDGE_COARSE_NODES) : sum;
    }
    if (any(wanted & fine)) {
        sum = fine ? unshadowedLobes(light, r, nodes + WEDGE_FINE_OFFSET, WEDGE_FINE_NODES) : sum;
    }
    const float16 m = r.exponent;
    const float16 phong = (m + 2.0f) * (0.5f * WEDGE_INV_PI);
    const float16 blinn = (m + 2.0f) * (m + 4.0f) * (0.125f * WEDGE_INV_PI) / (exp2Block(-0.5f * m) + m);
    const float16 value = sharp ? (float16)(-1.0f) : sum * (r.phong ? phong : blinn);
    return mirrors ? value : (float16)(0.0f);
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
    const float16 shading = unshadowedOfFew(light, at, facing, nodes, surface);
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
