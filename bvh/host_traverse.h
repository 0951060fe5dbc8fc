#pragma once

#include "bvh/bvh.h"
#include "kernels/shared/hit.h"
#include "kernels/shared/vec.h"

namespace wedge::bvh {

/// The ray origin + t direction, tMin < t < tMax; the direction may have any length.
struct Ray {
    shared::Vec3 origin;
    float tMin;
    shared::Vec3 direction;
    float tMax;
};

/// What closestHit of kernels/trace/traverse.h finds, one box and one triangle at a time: the oracle of the device
/// code. The nearest hit on either face, of equal t the one of the smallest triangle; on a miss t is tMax.
shared::Hit closestHit(const Bvh& bvh, const Ray& ray);

/// Whether the ray hits anything.
bool anyHit(const Bvh& bvh, const Ray& ray);

} // namespace wedge::bvh
