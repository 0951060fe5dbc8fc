// Small kernels for the tests of host/device.
#include "shared/compat.h"

typedef struct {
    float scale;
    int offset;
} Linear;

__kernel void addOne(__global uint* data, uint count)
{
    const uint i = (uint)get_global_id(0);
    if (i < count) {
        data[i] += 1u;
    }
}

// Counts how often each item of each group runs; with `first` as launchTiled() sets it.
__kernel void visit(__global uint* visits, uint first)
{
    const uint group = first + (uint)get_group_id(0);
    atomic_inc(&visits[group * (uint)get_local_size(0) + (uint)get_local_id(0)]);
}

// A chain of dependent operations, so that its result has something to lose.
__kernel void chain(__global float* result, uint count, uint first)
{
    const uint i = (first + (uint)get_group_id(0)) * (uint)get_local_size(0) + (uint)get_local_id(0);
    if (i < count) {
        float x = (float)i * 0.001f;
        for (int k = 0; k < 50; ++k) {
            x = x * 3.7f * (1.0f - x * 0.25f) + 0.125f;
            x = x - floor(x);
        }
        result[i] = x;
    }
}

// Adds 1 to each pixel and to the count of items beyond the image.
__kernel void grid(__global uint* pixels, __global uint* outside, uint width, uint height)
{
    const uint x = (uint)get_global_id(0);
    const uint y = (uint)get_global_id(1);
    if (x < width && y < height) {
        pixels[y * width + x] += 1u + x + 1000u * y;
    } else {
        atomic_inc(outside);
    }
}

__kernel void linear(__global float* data, Linear l, uint count)
{
    const uint i = (uint)get_global_id(0);
    if (i < count) {
        data[i] = data[i] * l.scale + (float)l.offset;
    }
}

__kernel void reverseGroup(__global uint* data, __local uint* scratch)
{
    const uint lane = (uint)get_local_id(0);
    scratch[lane] = data[get_global_id(0)];
    barrier(CLK_LOCAL_MEM_FENCE);
    data[get_global_id(0)] = scratch[(uint)get_local_size(0) - 1u - lane];
}

#ifdef TEST_VALUE
__kernel void testValue(__global int* result) { result[0] = TEST_VALUE; }
#endif
