// Surface descriptions as they lie in device memory.
#ifndef WEDGE_SHARED_MATERIAL_H
#define WEDGE_SHARED_MATERIAL_H

#include "vec.h"

#define WEDGE_NO_TEXTURE 0xffffffffu

WEDGE_SHARED_BEGIN

typedef struct {
    Vec3 diffuse;
    float exponent;
    Vec3 specular;
    uint specularModel; ///< WEDGE_SPECULAR_*
    Vec3 emission;
    uint diffuseTexture;
    uint specularTexture;
    uint exponentTexture;
    uint emissionTexture;
    uint padding;
} MaterialData;

/// Where a texture's texels start in the texel buffer. Row 0 is v = 0; texels are 8-bit sRGB, red in the low byte.
typedef struct {
    uint offset, width, height, padding;
} TextureData;

WEDGE_SHARED_END

#endif
