// What rays see that leave the scene. Where effects have something there, this file is written anew when programs are
// built (host/render/effect.h).
#ifndef WEDGE_ENVIRONMENT_H
#define WEDGE_ENVIRONMENT_H

#include "shared/vec.h"

/// 1: there is something to see, besides a map.
#define WEDGE_ENVIRONMENT 0

/// Radiance that arrives against a unit direction.
WEDGE_INLINE Vec3 environmentRadiance(Vec3 direction)
{
    (void)direction;
    return vec3(0.0f, 0.0f, 0.0f);
}

#endif
