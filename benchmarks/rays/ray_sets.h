#pragma once

#include "benchmarks/rays/surface.h"
#include "bvh/host_traverse.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// Rays of one class, in the order in which all contenders trace them. Their number is a multiple of packetRays.
struct RaySet {
    std::string name; ///< as in claims
    bool anyHit = false; ///< whether something is hit, not what
    bool coherent = false; ///< neighbours go together: what packets are for
    std::vector<bvh::Ray> rays; ///< those that are only there to fill a packet have tMax = 0
    std::size_t live = 0; ///< the others
};

inline constexpr std::size_t packetRays = 16;
inline constexpr int tileSide = 8;

inline bool isLive(const bvh::Ray& ray) { return ray.tMax > ray.tMin; }

/// The pixel that ray i of an image in tiles of 8x8 is for: tiles row by row, and within a tile Morton order, so that
/// 16 rays in a row are a 4x4 block.
struct Pixel {
    int x, y;
};
Pixel tiledPixel(std::size_t i, int width);

/// A pixel's first hit.
struct Receiver {
    SurfacePoint surface;
    bool hit = false;
    std::uint32_t seed = 0;
};

/// Through the centres of the pixels. Width and height are multiples of 8.
RaySet primaryRays(const scene::Scene& scene, int width, int height);

/// Of the primary rays and what they hit; as many, in the same order.
std::vector<Receiver> receiversOf(
    const scene::Scene& scene, const RaySet& primary, std::span<const shared::Hit> hits, int width);

/// To stratified points of the scene's first area light, distributed as its radiance. 16 rays in a row are one sample
/// of the receivers of one 4x4 block; blocks without a receiver are left out.
RaySet areaShadowRays(const scene::Scene& scene, std::span<const Receiver> receivers, int samples);

/// Of directions about the normal with density cos / pi, which end after a quarter of the scene's diagonal.
RaySet ambientRays(const scene::Scene& scene, std::span<const Receiver> receivers, int samples);

/// One a receiver, of the same distribution, without an end: the next vertex of a path.
RaySet diffuseRays(std::span<const Receiver> receivers);

} // namespace wedge::benchmark
