// Where paths meet glass in scenes whose bodies of glass touch, overlap or lie in one another: the faces that lie in
// one another within rounding are one interface, between the media before and behind all of them. An interface between
// equal media is none, and the ray goes on behind it. docs/materials.md, "Bodies that touch"
#ifndef WEDGE_INTERFACES_H
#define WEDGE_INTERFACES_H

#include "paths/path_vertices.h"

#ifdef WEDGE_TOUCHING_GLASS
/// Of distances along a ray, in units of the last place: faces nearer to each other are in no order.
#define WEDGE_DISTANCE_ULPS 4.0f
/// Rays count as no flatter than this cosine.
#define WEDGE_FLATTEST 1e-3f

/// What a ray meets at one place.
typedef struct {
    Crossing media;
    Hit glass, last; ///< the first face of glass, and the last one
    Hit surface; ///< the first that is no glass; WEDGE_NO_TRIANGLE: there is none
    float gap; ///< metres from the plane of the last face to the next one; +inf: it is far
    bool leaves; ///< some of the faces are left
} Place;

/// The interfaces that lanes are at, where they are at glass.
typedef struct {
    Media behind[WEDGE_PACKET_SIZE]; ///< what the path is inside of where it passes
    float index[WEDGE_PACKET_SIZE]; ///< refractive index behind over that before
    VecLanes reflects, transmits; ///< colours
    VecLanes start; ///< of rays that pass
    float lift[WEDGE_PACKET_SIZE]; ///< of those that are reflected, off the face, metres
    uint passed[WEDGE_PACKET_SIZE]; ///< 1: the ray has gone through interfaces that are none
    uint contact[WEDGE_PACKET_SIZE]; ///< WEDGE_CONTACT_*
} Interfaces;

WEDGE_FN Vec3 windingOf(Corners k) { return vecNormalize(vecCross(vecSub(k.b, k.a), vecSub(k.c, k.a))); }

WEDGE_FN bool isGlass(SurfaceData surfaces, uint triangle)
{
    return surfaces.materials[surfaces.materialIds[triangle]].kind == WEDGE_GLASS;
}

/// Follows a lane's ray from a hit through all that lies in the same place. inside: what it comes from.
WEDGE_FN void crossFaces(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    SurfaceData surfaces, float touching, const RayPacket* rays, uint lane, Hit first, const Media* inside,
    Place* place)
{
    const Vec3 origin = rayStart(rays, lane), direction = rayDirection(rays, lane);
    const float time = timeOf(rays, lane);
    beginCrossing(inside, &place->media);
    place->surface.triangle = place->glass.triangle = WEDGE_NO_TRIANGLE;
    place->leaves = false;
    float cosine = 0.0f;
    for (Hit at = first;;) {
        const float along = vecDot(windingOf(cornersOf(surfaces, at.triangle, time)), direction);
        cosine = cosine > 0.0f ? cosine : fmax(fabs(along), WEDGE_FLATTEST);
        if (isGlass(surfaces, at.triangle)) {
            const uint body = surfaces.materials[surfaces.materialIds[at.triangle]].medium;
            if (along > 0.0f) {
                leaveBody(body, &place->media);
                place->leaves = true;
            } else {
                enterBody(surfaces.materials, body, &place->media);
            }
            place->last = at;
            place->glass = place->glass.triangle == WEDGE_NO_TRIANGLE ? at : place->glass;
        } else if (place->surface.triangle == WEDGE_NO_TRIANGLE) {
            place->surface = at;
        }
        const float window = touching / cosine + WEDGE_DISTANCE_ULPS * WEDGE_ULP * at.t;
        const float end = fmin(at.t + 3.0f * window, rays->tMax[lane]);
        const Hit next = closestHitAfter(nodes, blocks, origin, direction, at.t, at.triangle, end, time);
        const bool none = next.triangle == WEDGE_NO_TRIANGLE;
        if (none || next.t - at.t > window) {
            place->gap = none ? INFINITY : (next.t - at.t) * cosine;
            return;
        }
        at = next;
    }
}

/// Where rays start behind a face, at most half of the way to the next one.
WEDGE_FN Vec3 startBehind(SurfaceData surfaces, Hit hit, Vec3 direction, float time, float gap)
{
    const Corners k = cornersOf(surfaces, hit.triangle, time);
    Facet f = facetOf(k, hit.u, hit.v, direction);
    uint kind = WEDGE_GLASS;
    mirrorFacet(k, hit.u, hit.v, direction, &f, &kind);
    const float off = vecDot(vecSub(f.origin, f.position), f.geometric);
    return vecMad(f.origin, f.geometric, -(off + fmin(off, 0.5f * gap)));
}

/// A colour of an interface: those of the body that is left and of the one that is entered.
WEDGE_FN Vec3 interfaceColour(
    __global const MaterialData* materials, bool reflects, uint before, bool left, uint behind, bool entered)
{
    Vec3 colour = vec3(1.0f, 1.0f, 1.0f);
    if (left) {
        const MaterialData m = materials[WEDGE_MATERIAL_OF(before)];
        colour = reflects ? m.specular : m.diffuse;
    }
    if (entered) {
        const MaterialData m = materials[WEDGE_MATERIAL_OF(behind)];
        colour = vecMul(colour, reflects ? m.specular : m.diffuse);
    }
    return colour;
}

/// Sets a lane's interface from what it crosses; returns whether there is one.
WEDGE_FN bool setInterface(
    __global const MaterialData* materials, const Crossing* media, uint lane, PathPacket* paths, Interfaces* met)
{
    const uint before = mediumOf(&media->before), behind = mediumOf(&media->behind);
    const uint kept = media->behind.count - media->entered;
    const bool left = before != WEDGE_NO_MEDIUM
        && countMedium(&media->before, media->before.count, before) > countMedium(&media->behind, kept, before);
    bool entered = false;
    for (uint i = kept; i < media->behind.count; ++i) {
        entered |= media->behind.body[i] == behind;
    }
    const float index = indexOf(materials, behind) / indexOf(materials, before);
    const Vec3 through = interfaceColour(materials, false, before, left, behind, entered);
    paths->inside[lane] = media->before;
    met->behind[lane] = media->behind;
    met->index[lane] = index;
    setLaneVec(&met->transmits, lane, through);
    setLaneVec(&met->reflects, lane, interfaceColour(materials, true, before, left, behind, entered));
    const bool white = through.x == 1.0f && through.y == 1.0f && through.z == 1.0f;
    return before != behind && (index != 1.0f || !white);
}

/// Puts a hit in a lane's place.
WEDGE_INLINE void setHit(PacketHits* hits, uint lane, Hit hit)
{
    hits->t[lane] = hit.t;
    hits->u[lane] = hit.u;
    hits->v[lane] = hit.v;
    hits->triangle[lane] = hit.triangle;
}

/// A lane's ray goes on behind an interface that is none.
WEDGE_FN void passInterface(const Media* behind, uint lane, PathPacket* paths, Interfaces* met)
{
    paths->inside[lane] = *behind;
    met->passed[lane] = 1u;
}

/// What a lane's ray meets where it hits something; returns whether it goes on to be traced.
WEDGE_FN bool meetPlace(__global const TraversalNode* restrict nodes, __global const TriangleBlock* restrict blocks,
    SurfaceData surfaces, float touching, uint lane, RayPacket* rays, PacketHits* hits, PathPacket* paths,
    Interfaces* met)
{
    const Hit hit = packetHit(hits, lane);
    if (hit.triangle == WEDGE_NO_TRIANGLE || (paths->inside[lane].count == 0u && !isGlass(surfaces, hit.triangle))) {
        return false;
    }
    Place place;
    crossFaces(nodes, blocks, surfaces, touching, rays, lane, hit, &paths->inside[lane], &place);
    const bool stands = place.surface.triangle != WEDGE_NO_TRIANGLE;
    if (stands) {
        // What is entered lies behind the surface.
        place.media.behind.count -= place.media.entered;
        place.media.entered = 0u;
    }
    if (stands && !place.leaves) {
        setHit(hits, lane, place.surface);
        return false;
    }
    const bool is = setInterface(surfaces.materials, &place.media, lane, paths, met);
    if (stands) {
        paths->contact[lane].glass = place.last;
        paths->contact[lane].surface = place.surface;
        paths->contact[lane].above = place.media.before;
        met->contact[lane] = is ? WEDGE_CONTACT_ABOVE : WEDGE_CONTACT_ON;
    }
    if (!is) {
        passInterface(&place.media.behind, lane, paths, met);
        if (stands) {
            setHit(hits, lane, place.surface);
            return false;
        }
        beginBehind(rays, lane, place.last.t, place.last.triangle);
        return true;
    }
    setHit(hits, lane, place.glass);
    const float time = timeOf(rays, lane);
    const Vec3 direction = rayDirection(rays, lane);
    setLaneVec(&met->start, lane, startBehind(surfaces, place.last, direction, time, place.gap));
    const float along = vecDot(windingOf(cornersOf(surfaces, place.glass.triangle, time)), direction);
    met->lift[lane] = 0.5f * fabs(along) * (place.glass.t - rays->tMin[lane]);
    return false;
}

/// A lane whose next hit is known, as its path is between glass and the surface that it stands on.
WEDGE_FN bool meetContact(
    SurfaceData surfaces, uint lane, RayPacket* rays, PacketHits* hits, PathPacket* paths, Interfaces* met)
{
    const Contact contact = paths->contact[lane];
    paths->contact[lane].next = WEDGE_CONTACT_NONE;
    met->contact[lane] = contact.next;
    if (contact.next == WEDGE_CONTACT_ON) {
        setHit(hits, lane, contact.surface);
        return false;
    }
    Crossing media;
    media.before = paths->inside[lane];
    media.behind = contact.above;
    media.entered = contact.above.count - min(contact.above.count, media.before.count);
    const Vec3 start = startBehind(surfaces, contact.glass, rayDirection(rays, lane), timeOf(rays, lane), INFINITY);
    if (setInterface(surfaces.materials, &media, lane, paths, met)) {
        setHit(hits, lane, contact.glass);
        setLaneVec(&met->start, lane, start);
        met->lift[lane] = INFINITY;
        return false;
    }
    met->contact[lane] = WEDGE_CONTACT_NONE;
    passInterface(&contact.above, lane, paths, met);
    setRay(rays, lane, start, rayDirection(rays, lane), 0.0f, rays->tMax[lane]);
    return true;
}

/// closestHits() of paths' rays, beyond interfaces that are none; what is left of the rays goes on in `rays`.
WEDGE_FN void meetInterfaces(__global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, SurfaceData surfaces, float touching, RayPacket* rays,
    PacketHits* hits, PathPacket* paths, Interfaces* met)
{
    uint traces[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        met->passed[lane] = 0u;
        met->contact[lane] = WEDGE_CONTACT_NONE;
        const bool known = rays->tMax[lane] > 0.0f && paths->contact[lane].next != WEDGE_CONTACT_NONE;
        traces[lane] = known && !meetContact(surfaces, lane, rays, hits, paths, met) ? 0u : 1u;
    }
    for (bool any = true; any;) {
        RayPacket left = *rays;
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            left.tMax[lane] = traces[lane] != 0u ? rays->tMax[lane] : 0.0f;
        }
        PacketHits found;
        closestHits(nodes, blocks, &left, &found);
        any = false;
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            if (traces[lane] != 0u) {
                setHit(hits, lane, packetHit(&found, lane));
                traces[lane] = meetPlace(nodes, blocks, surfaces, touching, lane, rays, hits, paths, met) ? 1u : 0u;
                paths->rays[lane] += traces[lane];
                any |= traces[lane] != 0u;
            }
        }
    }
}

/// Follows a lane's vertex at a mirror or an interface, as vertexMirrorRay() does.
WEDGE_FN MirrorRay followDeflection(__global const MaterialData* materials, const VertexPacket* at,
    const Interfaces* met, uint lane, float choice, PathPacket* paths)
{
    if ((at->kind[lane] & 7u) != WEDGE_GLASS) {
        const MirrorRay ray = vertexMirrorRay(materials, at, lane, choice);
        leaveContact(met->contact[lane], false, &paths->contact[lane]);
        return ray;
    }
    const Vec3 geometric = laneVec(&at->geometric, lane), origin = laneVec(&at->origin, lane);
    MirrorRay ray;
    ray.to = deflect(laneVec(&at->normal, lane), geometric, laneVec(&at->view, lane), met->index[lane],
        laneVec(&met->reflects, lane), laneVec(&met->transmits, lane), choice);
    const float off = vecDot(vecSub(origin, laneVec(&at->position, lane)), geometric);
    ray.start = vecMad(origin, geometric, fmin(met->lift[lane] - off, 0.0f));
    const bool through = ray.to.through != 0u;
    if (through) {
        ray.start = laneVec(&met->start, lane);
        paths->inside[lane] = met->behind[lane];
    }
    leaveContact(met->contact[lane], through, &paths->contact[lane]);
    return ray;
}

/// A lane's path goes on from a surface that glass may stand on.
WEDGE_INLINE void leaveSurface(const Interfaces* met, uint lane, PathPacket* paths)
{
    leaveContact(met->contact[lane], false, &paths->contact[lane]);
}

/// A lane's ray will be followed anew to the surface that it was found to meet.
WEDGE_INLINE void reachSurface(const Interfaces* met, uint lane, Hit hit, PathPacket* paths)
{
    if (met->contact[lane] == WEDGE_CONTACT_ON) {
        paths->contact[lane].surface = hit;
        paths->contact[lane].next = WEDGE_CONTACT_ON;
    }
}

/// The packet's interfaces among a function's parameters, and as an argument; in other programs there are none.
#define WEDGE_MET_PARAMETER const Interfaces *met,
#define WEDGE_MET_ARGUMENT met,
#define WEDGE_MEETS_PARAMETER Interfaces *met,

#else
#define WEDGE_MEETS_PARAMETER
#define WEDGE_MET_PARAMETER
#define WEDGE_MET_ARGUMENT

#ifdef WEDGE_MIRRORS
/// Follows a lane's vertex at a mirror or glass.
WEDGE_INLINE MirrorRay followDeflection(
    __global const MaterialData* materials, const VertexPacket* at, uint lane, float choice, PathPacket* paths)
{
    (void)paths;
    return vertexMirrorRay(materials, at, lane, choice);
}
#endif
#endif

#endif
