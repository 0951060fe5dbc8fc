#include "benchmarks/rays/embree_frame.h"

#include "benchmarks/rays/ray_sets.h"
#include "host/render/frame.h"
#include "kernels/shared/bsdf.h"
#include "kernels/shared/rng.h"

#include <array>
#include <limits>

namespace wedge::benchmark {
namespace {

using shared::Vec3;

constexpr std::size_t tilePixels = tileSide * tileSide;
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Fills one lane of a packet.
void setLane(RTCRay16& rays, std::size_t lane, Vec3 origin, Vec3 direction, float tMax)
{
    rays.org_x[lane] = origin.x;
    rays.org_y[lane] = origin.y;
    rays.org_z[lane] = origin.z;
    rays.dir_x[lane] = direction.x;
    rays.dir_y[lane] = direction.y;
    rays.dir_z[lane] = direction.z;
    rays.tnear[lane] = rays.time[lane] = 0;
    rays.tfar[lane] = tMax;
    rays.mask[lane] = ~0u;
    rays.id[lane] = rays.flags[lane] = 0;
}

RTCRay rayOf(Vec3 origin, Vec3 direction, float tMax)
{
    return { origin.x, origin.y, origin.z, 0, direction.x, direction.y, direction.z, 0, tMax, ~0u, 0, 0 };
}

} // namespace

EmbreeFrame::EmbreeFrame(const scene::Scene& scene, int width, int height, int samples, std::uint32_t seed)
    : scene_(scene)
    , surfaces_(scene)
    , frame_(render::frameParams(scene, render::PlaneLayout(width, height), { 0, 0, width, height }, seed))
    , width_(width)
    , samples_(samples)
    , rgb_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
{
    for (const scene::AreaLight& light : scene.areaLights)
        lights_.push_back(render::deviceLight(light));
}

void EmbreeFrame::render(const EmbreeScene& embree, bool packets, Workers& workers)
{
    workers.run(rgb_.size() / 3, tilePixels, [&](std::size_t first, std::size_t last) {
        if (packets)
            for (std::size_t i = first; i < last; i += packetRays)
                renderBlock(embree.scene(), i);
        else
            for (std::size_t i = first; i < last; ++i)
                renderPixel(embree.scene(), i);
    });
}

EmbreeFrame::Shaded EmbreeFrame::startPixel(std::size_t i) const
{
    const Pixel p = tiledPixel(i, width_);
    return { p.x, p.y, {}, shared::vec3(0, 0, 0), 0, false };
}

Vec3 EmbreeFrame::direction(const Shaded& pixel) const
{
    return shared::cameraDirection(frame_.forward, frame_.right, frame_.down, static_cast<float>(frame_.width),
        static_cast<float>(frame_.height), static_cast<float>(pixel.x) + 0.5f, static_cast<float>(pixel.y) + 0.5f);
}

EmbreeFrame::Sample EmbreeFrame::sample(const Shaded& pixel, std::size_t index, int k) const
{
    const shared::AreaLight& light = lights_[index];
    const auto number = static_cast<std::uint32_t>(pixel.y * width_ + pixel.x);
    const std::uint32_t seed =
        shared::hashCombine(shared::hashCombine(frame_.seed, static_cast<std::uint32_t>(index)), number);
    const shared::Vec2 u = shared::sobolOwen(static_cast<std::uint32_t>(k), seed);
    const shared::LightPart part = shared::partAboveHorizon(light, pixel.surface.position, pixel.surface.normal);
    const shared::PartSample s = shared::samplePart(light, part, u);
    const Vec3 point = shared::lightPoint(light.centre, light.halfU, light.halfV, s.a, s.b);
    const Vec3 d = vecSub(point, pixel.surface.position);
    return { vecSub(point, pixel.surface.origin),
        s.mass * shared::geometryTerm(pixel.surface.normal, d, light.normal, light.twoSided) };
}

void EmbreeFrame::endLight(Shaded& pixel, std::size_t light) const
{
    const float value = pixel.visible / static_cast<float>(samples_) * WEDGE_INV_PI;
    pixel.reflected = vecMad(pixel.reflected, lights_[light].power, value);
    pixel.visible = 0;
}

void EmbreeFrame::store(const Shaded& pixel)
{
    const Vec3 colour =
        pixel.hit ? vecAdd(pixel.surface.emission, vecMul(pixel.surface.diffuse, pixel.reflected)) : frame_.background;
    float* out = rgb_.data() + 3 * static_cast<std::size_t>(pixel.y * width_ + pixel.x);
    out[0] = colour.x;
    out[1] = colour.y;
    out[2] = colour.z;
}

void EmbreeFrame::renderPixel(RTCScene scene, std::size_t i)
{
    EmbreeQuery query(false);
    Shaded pixel = startPixel(i);
    const Vec3 d = direction(pixel);
    RTCRayHit rayHit {};
    rayHit.ray = rayOf(frame_.eye, d, infinity);
    rayHit.hit.geomID = rayHit.hit.primID = rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.intersect(scene, rayHit);
    pixel.hit = rayHit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    if (pixel.hit) {
        pixel.surface = surfaces_.at({ rayHit.ray.tfar, rayHit.hit.u, rayHit.hit.v, rayHit.hit.primID }, d);
        for (std::size_t light = 0; light < lights_.size(); ++light) {
            for (int k = 0; k < samples_; ++k) {
                const Sample s = sample(pixel, light, k);
                if (!(s.weight > 0))
                    continue;
                RTCRay shadow = rayOf(pixel.surface.origin, s.ray, WEDGE_SHADOW_RAY_END);
                query.occluded(scene, shadow);
                pixel.visible += shadow.tfar >= 0 ? s.weight : 0.0f;
            }
            endLight(pixel, light);
        }
    }
    store(pixel);
}

void EmbreeFrame::renderBlock(RTCScene scene, std::size_t first)
{
    EmbreeQuery query(true);
    std::array<Shaded, packetRays> pixels;
    alignas(64) int valid[packetRays];
    RTCRayHit16 hits;
    bool any = false;
    for (std::size_t lane = 0; lane < packetRays; ++lane) {
        pixels[lane] = startPixel(first + lane);
        setLane(hits.ray, lane, frame_.eye, direction(pixels[lane]), infinity);
        hits.hit.geomID[lane] = hits.hit.primID[lane] = hits.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        valid[lane] = -1;
    }
    query.intersect(valid, scene, hits);
    for (std::size_t lane = 0; lane < packetRays; ++lane) {
        Shaded& pixel = pixels[lane];
        pixel.hit = hits.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
        any = any || pixel.hit;
        if (pixel.hit)
            pixel.surface = surfaces_.at(
                { hits.ray.tfar[lane], hits.hit.u[lane], hits.hit.v[lane], hits.hit.primID[lane] }, direction(pixel));
    }
    for (std::size_t light = 0; any && light < lights_.size(); ++light) {
        for (int k = 0; k < samples_; ++k) {
            RTCRay16 shadows;
            float weights[packetRays];
            for (std::size_t lane = 0; lane < packetRays; ++lane) {
                const Shaded& pixel = pixels[lane];
                const Sample s = pixel.hit ? sample(pixel, light, k) : Sample { shared::vec3(0, 0, 1), 0 };
                weights[lane] = s.weight;
                valid[lane] = s.weight > 0 ? -1 : 0;
                setLane(shadows, lane, pixel.surface.origin, s.ray, WEDGE_SHADOW_RAY_END);
            }
            query.occluded(valid, scene, shadows);
            for (std::size_t lane = 0; lane < packetRays; ++lane)
                pixels[lane].visible += valid[lane] != 0 && shadows.tfar[lane] >= 0 ? weights[lane] : 0.0f;
        }
        for (Shaded& pixel : pixels)
            endLight(pixel, light);
    }
    for (const Shaded& pixel : pixels)
        store(pixel);
}

} // namespace wedge::benchmark
