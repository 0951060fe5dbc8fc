// CIELAB, in which distances between colours are near to what eyes tell apart.
#ifndef WEDGE_SHARED_LAB_H
#define WEDGE_SHARED_LAB_H

#include "maths.h"
#include "vec.h"

WEDGE_SHARED_BEGIN

/// The curve of CIE 15: the cube root, and a line below 0.008856.
WEDGE_FN float labCurve(float t)
{
    const float root = powPositive(t > 1e-3f ? t : 1e-3f, 0.333333333f);
    return t > 0.00885645168f ? root : 7.78703704f * t + 0.137931034f;
}

/// L*, a*, b* of linear radiance in the primaries of sRGB, of which 1 is white (D65). Not below 0.
WEDGE_FN Vec3 labOf(Vec3 c)
{
    const float x = labCurve(0.433950f * c.x + 0.376210f * c.y + 0.189840f * c.z);
    const float y = labCurve(0.212673f * c.x + 0.715152f * c.y + 0.072175f * c.z);
    const float z = labCurve(0.017757f * c.x + 0.109470f * c.y + 0.872773f * c.z);
    return vec3(116.0f * y - 16.0f, 500.0f * (x - y), 200.0f * (y - z));
}

WEDGE_SHARED_END

#endif
