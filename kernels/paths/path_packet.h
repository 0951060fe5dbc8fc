// Paths of a packet's pixels, all at the same vertex at a time: what arrives along each packet's first rays.
//
// Direct light of the pixels themselves is another effect's: the first rays count what surfaces reflect, not what they
// or lights send. From the first surface on, each vertex samples one light, or a mesh that emits, and the ray that goes
// on also counts what it meets of these; the two are combined by the power heuristic. What is seen beyond the scene,
// rays that go on meet alone.
#ifndef WEDGE_PATH_PACKET_H
#define WEDGE_PATH_PACKET_H

#include "paths/interfaces.h"
#include "paths/light_choices.h"
#include "trace/environment.h"

/// Throughput above which Russian roulette lets every path go on, and the vertex from which it plays: paths of one or
/// two bounces, which most frames are made of, are not worth its noise.
#define WEDGE_ROULETTE_THROUGHPUT 0.5f
#define WEDGE_ROULETTE_FIRST_VERTEX 3u
/// Least probability to go on.
#define WEDGE_ROULETTE_LEAST 0.05f

/// A shadow ray of each path at its vertex into `shadow`, and in `light` what it brings if nothing is in the way.
WEDGE_FN void sampleVertexLights(LightData lights, SampleParams params, PathPacket* paths, uint vertex,
    const VertexPacket* at, const RayPacket* rays, RayPacket* shadow, VecLanes* light)
{
    LightChoices chosen;
    chooseLights(lights, params, paths, vertex, at, rays, &chosen);
    VecLanes value;
    float pdf[WEDGE_PACKET_SIZE];
    scatter(at, &chosen.direction, &value, pdf);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool area = chosen.pdf[lane] > 0.0f;
        const bool above = vecDot(laneVec(&at->geometric, lane), laneVec(&chosen.direction, lane)) > 0.0f;
        const Vec3 irradiance = laneVec(&chosen.irradiance, lane);
        const bool unused = area && lights.sampling == WEDGE_LIGHTS_MET;
#ifdef WEDGE_MIRRORS
        const bool scatters = !WEDGE_IS_MIRROR(at->kind[lane]);
#else
        const bool scatters = true;
#endif
        const bool wanted = at->live[lane] != 0u && scatters && above && luminance(irradiance) > 0.0f && !unused;
        const float weight = powerHeuristic(chosen.pdf[lane], pdf[lane]);
        const float w = area && lights.sampling == WEDGE_LIGHTS_BOTH ? weight : 1.0f;
        setLaneVec(light, lane,
            vecScale(vecMul(vecMul(laneVec(&value, lane), irradiance), laneVec(&paths->throughput, lane)), w));
        setRay(shadow, lane, laneVec(&at->origin, lane), laneVec(&chosen.ray, lane), 0.0f,
            wanted ? chosen.end[lane] : 0.0f);
        setTime(shadow, lane, timeOf(rays, lane));
        paths->shadowRays[lane] += wanted ? 1u : 0u;
    }
}

/// Density of a ray's direction where no other technique finds what it meets.
#define WEDGE_ONE_DIRECTION INFINITY

/// What a ray whose direction has the density pdf counts of a light that the other technique has with `other`. After
/// mirrors and glass there is no other, whatever the light sampling is.
WEDGE_INLINE float metWeight(LightData lights, float pdf, float other)
{
    const float weight = lights.sampling == WEDGE_LIGHTS_MET ? 1.0f : powerHeuristic(pdf, other);
#ifdef WEDGE_MIRRORS
    return lights.sampling == WEDGE_LIGHTS_SAMPLED && pdf < WEDGE_ONE_DIRECTION ? 0.0f : weight;
#else
    return weight;
#endif
}

/// 1: rays that go on may count lights that they meet.
WEDGE_INLINE bool meetsLights(LightData lights)
{
#ifdef WEDGE_MIRRORS
    (void)lights;
    return true;
#else
    return lights.sampling != WEDGE_LIGHTS_SAMPLED;
#endif
}

/// Distances of the farthest lights that rays from the vertices meet; 0 where they meet none.
WEDGE_FN void farthestMeetings(LightData lights, const VertexPacket* at, const VecLanes* directions, float* farthest)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        farthest[lane] = 0.0f;
    }
    for (uint i = 0u; i < lights.areaCount; ++i) {
        const AreaLight light = lights.area[i];
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const float t = meetLight(light, laneVec(&at->origin, lane), laneVec(directions, lane)).t;
            farthest[lane] = t < INFINITY ? fmax(farthest[lane], t) : farthest[lane];
        }
    }
}

/// Sends the paths on from their vertices, or ends them; returns whether any has a next ray. last: the paths have all
/// their bounces, and the rays are only for the lights they meet and what is beyond the scene.
WEDGE_FN bool goOn(LightData lights, SampleParams params, PathPacket* paths, uint vertex, bool last,
    const VertexPacket* at, WEDGE_MET_PARAMETER RayPacket* rays)
{
    float u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE], unused[WEDGE_PACKET_SIZE], choice[WEDGE_PACKET_SIZE];
    pathPairs(params, paths, at->live, vertex, WEDGE_DIMENSION_DIRECTION, u, v);
    pathPairs(params, paths, at->live, vertex, WEDGE_DIMENSION_CHOICE, unused, choice);
    VecLanes l, value, throughput;
    float pdf[WEDGE_PACKET_SIZE], end[WEDGE_PACKET_SIZE];
    sampleScattering(at, u, v, choice, &l);
    scatter(at, &l, &value, pdf);
    uint goes[WEDGE_PACKET_SIZE];
    const bool plays = !last && vertex >= WEDGE_ROULETTE_FIRST_VERTEX;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const float cosine = vecDot(laneVec(&at->normal, lane), laneVec(&l, lane));
        const bool above = cosine > 0.0f && vecDot(laneVec(&at->geometric, lane), laneVec(&l, lane)) > 0.0f;
        const Vec3 carried =
            vecScale(vecMul(laneVec(&paths->throughput, lane), laneVec(&value, lane)), cosine / pdf[lane]);
        const float most = fmax(carried.x, fmax(carried.y, carried.z));
        const float survival = fmax(most / WEDGE_ROULETTE_THROUGHPUT, WEDGE_ROULETTE_LEAST);
        const float game = toUnitFloat(hashCombine(hashCombine(paths->seed[lane], paths->index[lane]), vertex));
        const bool played = plays && most < WEDGE_ROULETTE_THROUGHPUT;
        const bool ends = !above || !(pdf[lane] > 0.0f) || !(most > 0.0f) || (played && game >= survival);
        setLaneVec(&throughput, lane, vecScale(carried, played ? 1.0f / survival : 1.0f));
        goes[lane] = at->live[lane] != 0u && !ends ? 1u : 0u;
        end[lane] = INFINITY;
    }
#ifdef WEDGE_MIRRORS
    VecLanes start = at->origin;
    for (uint lane = 0u; at->anyMirror && lane < WEDGE_PACKET_SIZE; ++lane) {
        if (at->live[lane] != 0u && WEDGE_IS_MIRROR(at->kind[lane])) {
            const MirrorRay ray =
                followDeflection(lights.emitters.surfaces.materials, at, WEDGE_MET_ARGUMENT lane, choice[lane], paths);
            setLaneVec(&start, lane, ray.start);
            setLaneVec(&l, lane, ray.to.direction);
            const Vec3 carried = vecMul(laneVec(&paths->throughput, lane), ray.to.weight);
            setLaneVec(&throughput, lane, carried);
            pdf[lane] = WEDGE_ONE_DIRECTION;
            goes[lane] = luminance(carried) > 0.0f ? 1u : 0u;
        }
    }
#endif
#ifdef WEDGE_TOUCHING_GLASS
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (at->live[lane] != 0u && !WEDGE_IS_MIRROR(at->kind[lane])) {
            leaveSurface(met, lane, paths);
        }
    }
#endif
    // What emits may be anywhere, and so is what lies beyond the scene.
    if (last && lights.emitters.count + WEDGE_OPEN == 0u) {
        farthestMeetings(lights, at, &l, end);
    }
    uint any = 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool on = goes[lane] != 0u;
        setLaneVecIf(&paths->throughput, lane, on, laneVec(&throughput, lane));
        paths->pdf[lane] = on ? pdf[lane] : paths->pdf[lane];
        const float until = on ? end[lane] : 0.0f;
#ifdef WEDGE_MIRRORS
        const Vec3 from = laneVec(&start, lane);
#else
        const Vec3 from = laneVec(&at->origin, lane);
#endif
        setRay(rays, lane, from, laneVec(&l, lane), 0.0f, until);
        paths->rays[lane] += until > 0.0f ? 1u : 0u;
        any |= until > 0.0f ? 1u : 0u;
    }
    return any != 0u;
}

/// Adds what the rays met of `sum`, times what the paths carry.
WEDGE_FN void addCarried(PathPacket* paths, const VecLanes* sum)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 carried = vecMul(laneVec(&paths->throughput, lane), laneVec(sum, lane));
        setLaneVec(&paths->radiance, lane, vecAdd(laneVec(&paths->radiance, lane), carried));
    }
}

/// The part of the lights' radiance along the rays that counts for the technique of reflected directions, up to what
/// they hit. Lights hide nothing, as for shadow rays.
WEDGE_FN void addLightsMet(LightData lights, const RayPacket* rays, const PacketHits* hits, PathPacket* paths)
{
    VecLanes sum;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(&sum, lane, vec3(0.0f, 0.0f, 0.0f));
    }
    for (uint i = 0u; i < lights.areaCount; ++i) {
        const AreaLight light = lights.area[i];
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const LightMeeting m = meetLight(light, rayStart(rays, lane), rayDirection(rays, lane));
            const bool meets = rays->tMax[lane] > 0.0f && isMetBefore(light, m, rayStart(rays, lane), hits->t[lane]);
            const float other = lightPdf(light, m.a, m.b, m.t, m.facing);
            const float w = metWeight(lights, paths->pdf[lane], other);
            setLaneVecIf(&sum, lane, meets, vecMad(laneVec(&sum, lane), light.radiance, w * metProfile(light, m)));
        }
    }
    addCarried(paths, &sum);
}

/// The same of what the surfaces emit that rays hit.
WEDGE_FN void addEmittedMet(LightData lights, const RayPacket* rays, const PacketHits* hits, PathPacket* paths)
{
    VecLanes sum;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Hit hit = packetHit(hits, lane);
        Vec3 emitted = emittedOf(lights.emitters, hit);
        if (lights.sampling != WEDGE_LIGHTS_MET && luminance(emitted) > 0.0f) {
            const float other =
                lights.emitters.share * emitterPdf(lights.emitters, hit, rayDirection(rays, lane), timeOf(rays, lane));
            emitted = vecScale(emitted, metWeight(lights, paths->pdf[lane], other));
        }
        setLaneVec(&sum, lane, emitted);
    }
    addCarried(paths, &sum);
}

/// What rays that hit nothing see beyond the scene; of a map, what counts for the technique of reflected directions.
WEDGE_FN void addBeyond(LightData lights, const RayPacket* rays, const PacketHits* hits, PathPacket* paths)
{
    VecLanes sum;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool beyond = rays->tMax[lane] > 0.0f && hits->triangle[lane] == WEDGE_NO_TRIANGLE;
        // Rays that there are not need not be of length 1.
        const Vec3 direction = vecChoose(beyond, rayDirection(rays, lane), vec3(0.0f, 0.0f, 1.0f));
        Vec3 radiance = environmentRadiance(direction);
        if (WEDGE_ENVIRONMENT_MAP != 0 && beyond && meetsLights(lights)) {
            const BeyondSample seen = seenBeyond(lights.beyond, direction);
            const float w = metWeight(lights, paths->pdf[lane], lights.beyond.share * seen.pdf);
            radiance = vecMad(radiance, seen.radiance, w);
        }
        setLaneVec(&sum, lane, vec3(0.0f, 0.0f, 0.0f));
        setLaneVecIf(&sum, lane, beyond, radiance);
    }
    addCarried(paths, &sum);
}

/// Adds what is seen along the rays that went on from a vertex.
WEDGE_FN void addMet(LightData lights, const RayPacket* rays, const PacketHits* hits, PathPacket* paths)
{
    if (meetsLights(lights)) {
        addLightsMet(lights, rays, hits, paths);
        if (lights.emitters.count > 0u) {
            addEmittedMet(lights, rays, hits, paths);
        }
    }
    if (WEDGE_OPEN != 0u) {
        addBeyond(lights, rays, hits, paths);
    }
}

#ifdef WEDGE_TOUCHING_GLASS
/// What light sampling does not find as there are faces of glass in the way, though they are no interfaces, rays that
/// went through these find alone; of first rays (vertex 1) nothing else was to be counted.
WEDGE_FN void addMetThrough(LightData lights, const Interfaces* met, uint vertex, const RayPacket* rays,
    const PacketHits* hits, PathPacket* paths)
{
    RayPacket counted = *rays;
    PacketHits seen = *hits;
    bool any = false;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const bool passed = met->passed[lane] != 0u;
        paths->pdf[lane] = passed ? WEDGE_ONE_DIRECTION : paths->pdf[lane];
        if (vertex == 1u && !passed) {
            counted.tMax[lane] = 0.0f;
            seen.triangle[lane] = WEDGE_NO_TRIANGLE;
        }
        any |= vertex > 1u || passed;
    }
    if (any) {
        addMet(lights, &counted, &seen, paths);
    }
}
#endif

WEDGE_FN void beginPaths(const RayPacket* rays, PathPacket* paths)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        setLaneVec(&paths->throughput, lane, vec3(1.0f, 1.0f, 1.0f));
        setLaneVec(&paths->radiance, lane, vec3(0.0f, 0.0f, 0.0f));
        paths->pdf[lane] = 0.0f;
        paths->distance[lane] = INFINITY;
        paths->rays[lane] = rays->tMax[lane] > 0.0f ? 1u : 0u;
        paths->shadowRays[lane] = 0u;
    }
}

/// Goes on with paths that have begun (beginPaths()) and whose rays (unit directions; tMax 0: no path) are in `rays`,
/// all rays of a path at the time of that: adds to paths->radiance and counts of rays, and fills distance. `bounces`
/// more surfaces a path, at least 1.
WEDGE_FN void followPaths(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    SurfaceData surfaces, LightData lights, SampleParams params, uint bounces, RayPacket* rays, PathPacket* paths)
{
    const bool meets = meetsLights(lights) && lights.areaCount + lights.emitters.count + WEDGE_ENVIRONMENT_MAP > 0u;
    for (uint vertex = 1u;; ++vertex) {
        PacketHits hits;
#ifdef WEDGE_TOUCHING_GLASS
        Interfaces interfaces;
        const Interfaces* met = &interfaces;
        meetInterfaces(nodes, blocks, surfaces, lights.touching, rays, &hits, paths, &interfaces);
        addMetThrough(lights, met, vertex, rays, &hits, paths);
#else
        closestHits(nodes, blocks, rays, &hits);
        if (vertex > 1u) {
            addMet(lights, rays, &hits, paths);
        }
#endif
        if (vertex > bounces) {
            return;
        }
        VertexPacket at;
        loadVertices(surfaces, rays, &hits, &at);
        if (!at.any) {
            return;
        }
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const bool first = vertex == 1u && at.live[lane] != 0u;
            paths->distance[lane] = first ? hits.t[lane] : paths->distance[lane];
        }
        RayPacket shadow;
        VecLanes light;
        sampleVertexLights(lights, params, paths, vertex, &at, rays, &shadow, &light);
        uint occluded[WEDGE_PACKET_SIZE];
        anyHits(nodes, blocks, &shadow, occluded);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const bool lit = shadow.tMax[lane] > 0.0f && occluded[lane] == 0u;
            setLaneVecIf(&paths->radiance, lane, lit, vecAdd(laneVec(&paths->radiance, lane), laneVec(&light, lane)));
        }
        const bool last = vertex == bounces, open = WEDGE_OPEN != 0u;
        if ((last && !open && !meets) || !goOn(lights, params, paths, vertex, last, &at, WEDGE_MET_ARGUMENT rays)) {
            return;
        }
    }
}

/// Traces the paths whose first rays are in `rays`: fills paths->radiance, distance and counts of rays.
WEDGE_FN void tracePaths(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    SurfaceData surfaces, LightData lights, SampleParams params, uint bounces, RayPacket* rays, PathPacket* paths)
{
    beginPaths(rays, paths);
    followPaths(nodes, blocks, surfaces, lights, params, bounces, rays, paths);
}

/// The scene's lights, as paths take them.
WEDGE_FN LightData lightData(PathParams params, __global const AreaLight* area, __global const DeltaLight* delta,
    SurfaceData surfaces, __global const Emitter* emitters, __global const float* emitterPicks,
    __global const EnvironmentMap* environment, __global const float* environmentTable,
    __global const float* environmentSamples)
{
    LightData lights;
    lights.emitters.surfaces = surfaces;
    lights.emitters.quads = area;
    lights.emitters.list = emitters;
    lights.emitters.picks = emitterPicks;
    lights.emitters.count = params.emitters;
    lights.emitters.share = params.emitterShare;
    lights.beyond = beyondData(environment, environmentTable, params.environmentShare);
    lights.beyond.precomputed = params.precomputed;
    lights.beyond.samples = environmentSamples;
    lights.area = area;
    lights.delta = delta;
    lights.areaCount = params.areaLights;
    lights.deltaCount = params.deltaLights;
    lights.sceneDiameter = params.sceneDiameter;
    lights.sampling = params.lightSampling;
    lights.touching = params.touching;
    return lights;
}

#endif
