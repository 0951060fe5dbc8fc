// Normals of surfaces as they are without their maps, for passes that ask which way a surface faces.
#ifndef WEDGE_UNMAPPED_NORMALS_H
#define WEDGE_UNMAPPED_NORMALS_H

#include "core/formats.h"

/// Planes of a format of normals before those of the normals without their maps.
#define WEDGE_PLANES_BEFORE_float3 0u
#define WEDGE_PLANES_BEFORE_normal192 3u
/// Those normals, of a pass's plane `normal`.
#define WEDGE_UNMAPPED(size) (normal + WEDGE_OF_FORMAT(WEDGE_PLANES_BEFORE, FORMAT_normal) * (size))

#endif
