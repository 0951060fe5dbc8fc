// Reports how the device lays out the structs that it shares with the host.
#include "shared/bvh_types.h"
#include "shared/camera.h"
#include "shared/curvature.h"
#include "shared/cutout.h"
#include "shared/distributed.h"
#include "shared/environment.h"
#include "shared/filter_params.h"
#include "shared/frame.h"
#include "shared/hit.h"
#include "shared/light.h"
#include "shared/material.h"
#include "shared/path.h"
#include "shared/pixel_grid.h"
#include "shared/styled_shadows.h"
#include "shared/temporal.h"
#include "shared/wave.h"

#define STRUCT(S)                                                                                                      \
    {                                                                                                                  \
        S s;
#define FIELD(S, f)                                                                                                    \
    out[n++] = (uint)((__private char*)&s.f - (__private char*)&s);                                                    \
    out[n++] = (uint)sizeof(s.f);
#define END(S)                                                                                                         \
    out[n++] = (uint)sizeof(S);                                                                                        \
    }

/// Offset and size of each field, then the struct's size. count[0]: how many numbers that are.
__kernel void layout(__global uint* restrict out, __global uint* restrict count)
{
    uint n = 0u;
#include "layout_fields.h"
    count[0] = n;
}
