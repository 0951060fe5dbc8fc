// Paths of a packet's pixels, all at the same vertex at a time: what arrives along each packet's first rays.
//
// Direct light of the pixels themselves is another effect's: the first rays count what surfaces reflect, not what they
// or lights send. From the first surface on, each vertex samples one light, or a mesh that emits, and the ray that goes
// on also counts what it meets of these; the two are combined by the power heuristic. What is seen beyond the scene,
// rays that go on meet alone.
#ifndef WEDGE_PATH_PACKET_H
#define WEDGE_PATH_PACKET_H

#include "light/light_packet.h"
#include "light/scene_light.h"
#include "trace/environment.h"
#include "trace/surface.h"

/// Throughput above which Russian roulette lets every path go on, and the vertex from which it plays: paths of one or
/// two bounces, which most frames are made of, are not worth its noise.
#define WEDGE_ROULETTE_THROUGHPUT 0.5f
#define WEDGE_ROULETTE_FIRST_VERTEX 3u
/// Least probability to go on.
#define WEDGE_ROULETTE_LEAST 0.05f

/// Dimensions of a path's random numbers: 0 for its first direction, then these for each vertex.
#define WEDGE_VERTEX_DIMENSIONS 3u
#define WEDGE_DIMENSION_LIGHT 1u ///< point on the light
#define WEDGE_DIMENSION_DIRECTION 2u ///< direction that the path goes on in
#define WEDGE_DIMENSION_CHOICE 3u ///< which light, which lobe

typedef struct {
    Vec3 throughput[WEDGE_PACKET_SIZE];
    Vec3 radiance[WEDGE_PACKET_SIZE]; ///< so far
    float pdf[WEDGE_PACKET_SIZE]; ///< of the current ray's direction, 1/sr
    float distance[WEDGE_PACKET_SIZE]; ///< to the first surface, metres; +inf where there is none
    uint seed[WEDGE_PACKET_SIZE];
    uint index[WEDGE_PACKET_SIZE], count[WEDGE_PACKET_SIZE]; ///< sample and number of samples, as samplePositions()
    uint rays[WEDGE_PACKET_SIZE], shadowRays[WEDGE_PACKET_SIZE];
} PathPacket;

/// The random pair of one dimension of a lane's path. Strata of different dimensions are paired at random in each
/// pixel.
WEDGE_FN Vec2 pathPair(SampleParams params, const PathPacket* paths, uint lane, uint vertex, uint dimension)
{
    const uint seed = hashCombine(paths->seed[lane], vertex * WEDGE_VERTEX_DIMENSIONS + dimension);
    return params.sampler == WEDGE_SAMPLER_SOBOL
        ? sobolOwen(paths->index[lane], seed)
        : stratifiedPosition(params, paths->index[lane], paths->count[lane], seed, hashUint(seed));
}

/// A vertex's scattering: Lambert and one specular lobe.
typedef struct {
    Vec3 view; ///< unit, to where the path came from
    Lobe lobe;
    bool glossy;
    float diffuseShare; ///< probability that the path goes on by the diffuse part
} Scattering;

WEDGE_FN Scattering scatteringOf(const Surface* s, Vec3 direction)
{
    Scattering out;
    out.view = vecScale(direction, -1.0f);
    const float d = luminance(s->diffuse);
    const float g = luminance(s->specular);
    out.glossy = g > 0.0f;
    out.diffuseShare = out.glossy ? d / (d + g) : 1.0f;
    out.lobe.kind = s->gloss.kind;
    out.lobe.exponent = out.lobe.normalization = out.lobe.leastCosine = 1.0f;
    if (out.glossy) {
        out.lobe = makeLobe(s->gloss.exponent, s->gloss.kind);
    }
    return out;
}

/// The reflectance in 1/sr from direction l, and in *pdf the density at which the path goes on in it. l is above the
/// horizons of both normals.
WEDGE_FN Vec3 scatter(const Surface* s, const Scattering* how, Vec3 l, float* pdf)
{
    Vec3 value = vecScale(s->diffuse, WEDGE_INV_PI);
    *pdf = how->diffuseShare * fmax(0.0f, vecDot(s->normal, l)) * WEDGE_INV_PI;
    if (how->glossy) {
        const LobeAt at = lobeAt(how->lobe, s->normal, how->view, l);
        value = vecMad(value, s->specular, at.value);
        *pdf += (1.0f - how->diffuseShare) * at.pdf;
    }
    return value;
}

/// A shadow ray of the lane at its vertex into `shadow`, and in *light what it brings if nothing is in the way.
WEDGE_FN void chooseLight(LightData lights, SampleParams params, PathPacket* paths, uint lane, uint vertex,
    const Surface* s, const Scattering* how, RayPacket* shadow, Vec3* light)
{
    const Vec2 choice = pathPair(params, paths, lane, vertex, WEDGE_DIMENSION_CHOICE);
    const Vec2 point = pathPair(params, paths, lane, vertex, WEDGE_DIMENSION_LIGHT);
    const LightChoice c = sampleLight(lights, s->origin, s->normal, choice.x, point, timeOf(shadow, lane));
    const bool area = c.pdf > 0.0f;
    const bool above = vecDot(s->geometric, c.direction) > 0.0f;
    if (!above || !(luminance(c.irradiance) > 0.0f) || (area && lights.sampling == WEDGE_LIGHTS_MET)) {
        return;
    }
    float pdf;
    const Vec3 value = scatter(s, how, c.direction, &pdf);
    const float w = area && lights.sampling == WEDGE_LIGHTS_BOTH ? powerHeuristic(c.pdf, pdf) : 1.0f;
    *light = vecScale(vecMul(vecMul(value, c.irradiance), paths->throughput[lane]), w);
    setRay(shadow, lane, s->origin, c.ray, 0.0f, c.end);
    paths->shadowRays[lane] += 1u;
}

/// Sends the lane's path on from its vertex, or ends it: returns whether there is a next ray. last: the path has all
/// its bounces, and the ray is only for the lights it meets and what is beyond the scene.
WEDGE_FN bool goOn(LightData lights, SampleParams params, PathPacket* paths, uint lane, uint vertex, bool last,
    const Surface* s, const Scattering* how, RayPacket* rays)
{
    const Vec2 u = pathPair(params, paths, lane, vertex, WEDGE_DIMENSION_DIRECTION);
    const float choice = pathPair(params, paths, lane, vertex, WEDGE_DIMENSION_CHOICE).y;
    const Vec3 l =
        choice < how->diffuseShare ? cosineDirection(s->normal, u) : sampleLobe(how->lobe, s->normal, how->view, u);
    const float cosine = vecDot(s->normal, l);
    if (!(cosine > 0.0f) || !(vecDot(s->geometric, l) > 0.0f)) {
        return false;
    }
    float pdf;
    const Vec3 value = scatter(s, how, l, &pdf);
    if (!(pdf > 0.0f)) {
        return false;
    }
    Vec3 throughput = vecScale(vecMul(paths->throughput[lane], value), cosine / pdf);
    const float most = fmax(throughput.x, fmax(throughput.y, throughput.z));
    if (!(most > 0.0f)) {
        return false;
    }
    if (!last && vertex >= WEDGE_ROULETTE_FIRST_VERTEX && most < WEDGE_ROULETTE_THROUGHPUT) {
        const float survival = fmax(most / WEDGE_ROULETTE_THROUGHPUT, WEDGE_ROULETTE_LEAST);
        const uint game = hashCombine(hashCombine(paths->seed[lane], paths->index[lane]), vertex);
        if (toUnitFloat(game) >= survival) {
            return false;
        }
        throughput = vecScale(throughput, 1.0f / survival);
    }
    // What emits may be anywhere, and so is what lies beyond the scene.
    const bool open = WEDGE_ENVIRONMENT != 0, anywhere = open || lights.emitters.count > 0u;
    const float end = last && !anywhere ? farthestMeeting(lights, s->origin, l) : INFINITY;
    paths->throughput[lane] = throughput;
    paths->pdf[lane] = pdf;
    setRay(rays, lane, s->origin, l, 0.0f, end);
    paths->rays[lane] += end > 0.0f ? 1u : 0u;
    return end > 0.0f;
}

WEDGE_FN Vec3 rayOriginOf(const RayPacket* rays, uint lane)
{
    return vec3(rays->originX[lane], rays->originY[lane], rays->originZ[lane]);
}

WEDGE_FN Vec3 rayDirectionOf(const RayPacket* rays, uint lane)
{
    return vec3(rays->directionX[lane], rays->directionY[lane], rays->directionZ[lane]);
}

/// The part of what the surface that a ray met emits that counts for the technique of reflected directions; pdf as for
/// radianceMet().
WEDGE_FN Vec3 emittedMet(LightData lights, Hit hit, Vec3 direction, float pdf, float time)
{
    const Vec3 emitted = emittedOf(lights.emitters, hit);
    if (!(luminance(emitted) > 0.0f) || lights.sampling == WEDGE_LIGHTS_SAMPLED) {
        return vec3(0.0f, 0.0f, 0.0f);
    }
    const float other = lights.emitters.share * emitterPdf(lights.emitters, hit, direction, time);
    return vecScale(emitted, lights.sampling == WEDGE_LIGHTS_BOTH ? powerHeuristic(pdf, other) : 1.0f);
}

/// Traces the paths whose first rays (unit directions; tMax 0: no path) are in `rays`, all rays of a path at the time
/// of its first: fills paths->radiance, distance and counts of rays. `bounces` surfaces a path, at least 1.
WEDGE_FN void tracePaths(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    SurfaceData surfaces, LightData lights, SampleParams params, uint bounces, RayPacket* rays, PathPacket* paths)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        paths->throughput[lane] = vec3(1.0f, 1.0f, 1.0f);
        paths->radiance[lane] = vec3(0.0f, 0.0f, 0.0f);
        paths->pdf[lane] = 0.0f;
        paths->distance[lane] = INFINITY;
        paths->rays[lane] = rays->tMax[lane] > 0.0f ? 1u : 0u;
        paths->shadowRays[lane] = 0u;
    }
    for (uint vertex = 1u;; ++vertex) {
        PacketHits hits;
        closestHits(nodes, blocks, rays, &hits);
        RayPacket shadow;
        Vec3 light[WEDGE_PACKET_SIZE];
        bool alive = false;
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const Vec3 origin = rayOriginOf(rays, lane);
            const Vec3 direction = rayDirectionOf(rays, lane);
            light[lane] = vec3(0.0f, 0.0f, 0.0f);
            setRay(&shadow, lane, origin, direction, 0.0f, 0.0f);
            setTime(&shadow, lane, timeOf(rays, lane));
            if (vertex > 1u && rays->tMax[lane] > 0.0f) {
                const Vec3 met = radianceMet(lights, origin, direction, paths->pdf[lane], hits.t[lane]);
                paths->radiance[lane] = vecAdd(paths->radiance[lane], vecMul(paths->throughput[lane], met));
            }
            const Hit hit = packetHit(&hits, lane);
            if (vertex > 1u) {
                const Vec3 met = emittedMet(lights, hit, direction, paths->pdf[lane], timeOf(rays, lane));
                paths->radiance[lane] = vecAdd(paths->radiance[lane], vecMul(paths->throughput[lane], met));
            }
            if (WEDGE_ENVIRONMENT != 0 && vertex > 1u && rays->tMax[lane] > 0.0f && hit.triangle == WEDGE_NO_TRIANGLE) {
                const Vec3 beyond = vecMul(paths->throughput[lane], environmentRadiance(direction));
                paths->radiance[lane] = vecAdd(paths->radiance[lane], beyond);
            }
            rays->tMax[lane] = 0.0f;
            if (vertex > bounces || hit.triangle == WEDGE_NO_TRIANGLE) {
                continue;
            }
            const Surface s = surfaceAt(surfaces, hit, direction, timeOf(rays, lane));
            const Scattering how = scatteringOf(&s, direction);
            paths->distance[lane] = vertex == 1u ? hit.t : paths->distance[lane];
            chooseLight(lights, params, paths, lane, vertex, &s, &how, &shadow, &light[lane]);
            const bool last = vertex == bounces;
            const bool meets = lights.sampling != WEDGE_LIGHTS_SAMPLED && lights.areaCount + lights.emitters.count > 0u;
            const bool open = WEDGE_ENVIRONMENT != 0;
            if (!last || open || meets) {
                alive |= goOn(lights, params, paths, lane, vertex, last, &s, &how, rays);
            }
        }
        uint occluded[WEDGE_PACKET_SIZE];
        anyHits(nodes, blocks, &shadow, occluded);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const bool lit = shadow.tMax[lane] > 0.0f && occluded[lane] == 0u;
            paths->radiance[lane] = lit ? vecAdd(paths->radiance[lane], light[lane]) : paths->radiance[lane];
        }
        if (!alive) {
            return;
        }
    }
}

#endif
