#include "benchmarks/rays/ray_sets.h"

#include "host/render/frame.h"
#include "kernels/shared/light.h"
#include "kernels/shared/rng.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wedge::benchmark {
namespace {

using shared::Vec3;

constexpr bvh::Ray noRay { { 0, 0, 0 }, 0, { 0, 0, 1 }, 0 };
constexpr float infinity = std::numeric_limits<float>::infinity();

/// The bits of i at even places, moved together.
int evenBits(std::size_t i) { return static_cast<int>((i & 1u) | (i >> 1 & 2u) | (i >> 2 & 4u)); }

/// Fills the last packet, and counts.
RaySet finished(RaySet set)
{
    while (set.rays.size() % packetRays != 0)
        set.rays.push_back(noRay);
    set.live = static_cast<std::size_t>(std::ranges::count_if(set.rays, isLive));
    return set;
}

/// A direction with density cos / pi about the normal, from a point of [0, 1)^2; never below the horizon.
Vec3 cosineDirection(Vec3 normal, shared::Vec2 u)
{
    const float radius = std::sqrt(u.x), angle = 6.28318531f * u.y;
    const float height = std::sqrt(std::max(1e-4f, 1 - u.x));
    const Vec3 helper = std::fabs(normal.x) > 0.5f ? shared::vec3(0, 1, 0) : shared::vec3(1, 0, 0);
    const Vec3 tangent = vecNormalize(vecCross(helper, normal)), bitangent = vecCross(normal, tangent);
    const Vec3 flat = vecMad(vecScale(tangent, radius * std::cos(angle)), bitangent, radius * std::sin(angle));
    return vecMad(flat, normal, height);
}

RaySet hemisphereRays(RaySet set, std::span<const Receiver> receivers, int samples, float length, std::uint32_t salt)
{
    for (std::size_t first = 0; first < receivers.size(); first += packetRays)
        for (int k = 0; k < samples; ++k)
            for (const Receiver& r : receivers.subspan(first, std::min(packetRays, receivers.size() - first)))
                if (r.hit) {
                    const auto u = shared::sobolOwen(static_cast<std::uint32_t>(k), shared::hashCombine(r.seed, salt));
                    // About the geometric normal: none starts into the surface.
                    set.rays.push_back({ r.surface.origin, 0, cosineDirection(r.surface.geometric, u), length });
                }
    return finished(std::move(set));
}

} // namespace

Pixel tiledPixel(std::size_t i, int width)
{
    const std::size_t tile = i / (tileSide * tileSide), within = i % (tileSide * tileSide);
    const std::size_t across = static_cast<std::size_t>(width / tileSide);
    return { static_cast<int>(tile % across) * tileSide + evenBits(within),
        static_cast<int>(tile / across) * tileSide + evenBits(within >> 1) };
}

RaySet primaryRays(const scene::Scene& scene, int width, int height)
{
    const auto frame = render::frameParams(scene, render::PlaneLayout(width, height), { 0, 0, width, height }, 0);
    RaySet set { "primary", false, true, {}, 0 };
    for (std::size_t i = 0; i < static_cast<std::size_t>(width) * static_cast<std::size_t>(height); ++i) {
        const Pixel p = tiledPixel(i, width);
        const Vec3 d = shared::cameraDirection(frame.forward, frame.right, frame.down, static_cast<float>(width),
            static_cast<float>(height), static_cast<float>(p.x) + 0.5f, static_cast<float>(p.y) + 0.5f);
        set.rays.push_back({ frame.eye, 0, d, infinity });
    }
    return finished(std::move(set));
}

std::vector<Receiver> receiversOf(
    const scene::Scene& scene, const RaySet& primary, std::span<const shared::Hit> hits, int width)
{
    const HostSurfaces surfaces(scene);
    std::vector<Receiver> out(primary.rays.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Pixel p = tiledPixel(i, width);
        out[i].hit = hits[i].triangle != WEDGE_NO_TRIANGLE;
        out[i].seed = shared::hashUint(static_cast<std::uint32_t>(p.y * width + p.x));
        if (out[i].hit)
            out[i].surface = surfaces.at(hits[i], primary.rays[i].direction);
    }
    return out;
}

RaySet areaShadowRays(const scene::Scene& scene, std::span<const Receiver> receivers, int samples)
{
    const shared::AreaLight light = render::deviceLight(scene.areaLights.at(0));
    const auto ray = [&](const Receiver& r, int k) {
        const shared::Vec2 u =
            shared::stratified(static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(samples), 0, r.seed);
        const float a = shared::lightCoordinate(u.x, light.profile, light.cut, light.erfCut);
        const float b = shared::lightCoordinate(u.y, light.profile, light.cut, light.erfCut);
        const Vec3 point = shared::lightPoint(light.centre, light.halfU, light.halfV, a, b);
        const Vec3 d = vecSub(point, r.surface.position);
        if (!r.hit || !(shared::geometryTerm(r.surface.normal, d, light.normal, light.twoSided) > 0))
            return noRay;
        return bvh::Ray { r.surface.origin, 0, vecSub(point, r.surface.origin), WEDGE_SHADOW_RAY_END };
    };
    RaySet set { "area_shadow", true, true, {}, 0 };
    for (std::size_t first = 0; first < receivers.size(); first += packetRays) {
        const auto block = receivers.subspan(first, packetRays);
        if (std::ranges::any_of(block, &Receiver::hit))
            for (int k = 0; k < samples; ++k)
                for (const Receiver& r : block)
                    set.rays.push_back(ray(r, k));
    }
    return finished(std::move(set));
}

RaySet ambientRays(const scene::Scene& scene, std::span<const Receiver> receivers, int samples)
{
    const scene::Bounds bounds = scene::sceneBounds(scene);
    const float length = bounds.empty() ? 1.0f : 0.25f * glm::length(bounds.hi - bounds.lo);
    return hemisphereRays({ "ambient", true, false, {}, 0 }, receivers, samples, length, 1);
}

RaySet diffuseRays(std::span<const Receiver> receivers)
{
    return hemisphereRays({ "diffuse", false, false, {}, 0 }, receivers, 1, infinity, 2);
}

} // namespace wedge::benchmark
