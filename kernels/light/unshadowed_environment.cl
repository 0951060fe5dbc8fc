// Reflectance times what would light a surface from beyond the scene if nothing hid it. Of the diffuse term of an
// environment that is what the image is lit by but for what is hidden: samples are divided by it, filters share what
// remains, which depends little on where a surface faces, and the composite multiplies by it again.
#include "core/pixel.h"
#include "light/unshadowed_environment.h"
#include "shared/filter_params.h"
#include "shared/frame.h"
#include "shared/wave.h"

WEDGE_INLINE void storeUnshadowed(uint size, int i, WEDGE_BEYOND_PARAMETERS, __global const float* restrict normal,
    __global const float* restrict diffuse, __global float* restrict unshadowed)
{
    const Vec3x16 light = unshadowedLight(environment, environmentTable, loadVecBlock(normal, size, i));
    const Vec3x16 k = mul16(loadVecBlock(diffuse, size, i), light);
    vstore16(k.x, 0, unshadowed + i);
    vstore16(k.y, 0, unshadowed + size + i);
    vstore16(k.z, 0, unshadowed + 2u * size + i);
}

/// in   normal, diffuse: 3 planes each, of pixels
/// out  unshadowed: 3 planes
__kernel void environmentOfPixels(AnalysisParams p, WEDGE_BEYOND_PARAMETERS, __global const float* restrict normal,
    __global const float* restrict diffuse, __global float* restrict unshadowed)
{
    const uint x = p.x0 + get_global_id(0) * WEDGE_BLOCK_PIXELS;
    const uint y = p.y0 + get_global_id(1);
    if (x < p.x1 && y < p.y1) {
        storeUnshadowed(
            p.planeSize, (int)pixelIndex(x, y, p.stride), environment, environmentTable, normal, diffuse, unshadowed);
    }
}

/// The same of a wave's receivers.
__kernel void environmentOfReceivers(FrameParams frame, WaveParams wave, WEDGE_BEYOND_PARAMETERS,
    __global const float* restrict normal, __global const float* restrict diffuse, __global float* restrict unshadowed)
{
    const uint first = get_global_id(0) * WEDGE_BLOCK_PIXELS;
    if (frame.tileCount > 0u && first < wave.receivers) {
        storeUnshadowed(wave.planeSize, (int)first, environment, environmentTable, normal, diffuse, unshadowed);
    }
}
