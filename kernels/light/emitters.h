// Meshes that emit as lights, and area lights that share a term: points on them, chosen by power, and the density of
// those where a ray meets them. Both sides of a triangle emit.
#ifndef WEDGE_EMITTERS_H
#define WEDGE_EMITTERS_H

#include "light/sums.h"
#include "shared/emitter.h"
#include "shared/light.h"
#include "trace/cutouts.h"
#include "trace/surface.h"

typedef struct {
    SurfaceData surfaces;
    __global const AreaLight* quads; ///< which WEDGE_PAIR_QUAD numbers
    __global const Emitter* list;
    __global const float* picks; ///< of each triangle of the scene: the probability that it is chosen, or
                                 ///< WEDGE_PICK_ELSEWHERE: it is part of another term, or WEDGE_PICK_TABLE
    uint count; ///< of the list
    float share; ///< probability that a path's vertex samples them and not other lights
#ifdef WEDGE_CUTOUTS
    __global const uint* cutouts; ///< as in TraversalRay
#endif
} EmitterData;

/// The scene's emitters among a kernel's parameters.
#define WEDGE_EMITTER_PARAMETERS __global const Emitter *restrict emitters, __global const float *restrict emitterPicks

/// A point on one of them.
typedef struct {
    Vec3 point; ///< metres
    Vec3 normal; ///< unit, of the triangle, on either side; of a quad on the side that emits
    Vec3 radiance;
    float density; ///< of the point, 1/m^2
    float extent; ///< metres, of the emitter
    float error; ///< metres: rounding of the point and of tests of rays that end at it
    float end; ///< of such rays, in their lengths
    bool oneSided;
} EmitterPoint;

/// Twice the area of a triangle times its unit normal, at a time.
WEDGE_FN Vec3 triangleNormal(SurfaceData data, uint triangle, float time)
{
    const Vec3 a = positionAt(data, data.indices[3u * triangle], time);
    const Vec3 ab = vecSub(positionAt(data, data.indices[3u * triangle + 1u], time), a);
    return vecCross(ab, vecSub(positionAt(data, data.indices[3u * triangle + 2u], time), a));
}

/// The first of the list whose numbers reach beyond `number`: between where its stripe of numbers begins and the next.
WEDGE_FN uint findEmitter(EmitterData e, float number)
{
    const uint last = e.count - 1u, stripe = min((uint)(number * (float)e.count), last);
    uint low = e.list[stripe].guide, high = stripe < last ? e.list[stripe + 1u].guide : last;
    while (low < high) {
        const uint middle = (low + high) / 2u;
        const bool below = e.list[middle].upTo <= number;
        low = below ? middle + 1u : low;
        high = below ? high : middle;
    }
    return low;
}

#ifdef WEDGE_EMITTER_TABLES
/// Where numbers that are even over the square are, spread as a table says, and in *density how much denser there.
WEDGE_FN Vec2 spreadByTable(__global const float* table, Vec2 u, float* density)
{
    const uint columns = as_uint(table[0]), rows = as_uint(table[1]);
    __global const float* ofRows = table + 2u;
    const float below1 = 0.99999994f;
    const Vec2 number = vec2(fmin(u.x, below1), fmin(u.y, below1));
    const uint y = findSum(ofRows, 0u, rows - 1u, number.y);
    __global const float* ofColumns = ofRows + rows + y * columns;
    const uint x = findSum(ofColumns, 0u, columns - 1u, number.x);
    const float fromX = x > 0u ? ofColumns[x - 1u] : 0.0f, fromY = y > 0u ? ofRows[y - 1u] : 0.0f;
    const float partX = ofColumns[x] - fromX, partY = ofRows[y] - fromY;
    *density = partX * (float)columns * (partY * (float)rows);
    return vec2(((float)x + clamp((number.x - fromX) / fmax(partX, 1e-30f), 0.0f, 1.0f)) / (float)columns,
        ((float)y + clamp((number.y - fromY) / fmax(partY, 1e-30f), 0.0f, 1.0f)) / (float)rows);
}

/// How much denser such numbers are at a place of the square.
WEDGE_FN float densityInTable(__global const float* table, Vec2 at)
{
    const uint columns = as_uint(table[0]), rows = as_uint(table[1]);
    const uint x = min((uint)(fmax(at.x, 0.0f) * (float)columns), columns - 1u);
    const uint y = min((uint)(fmax(at.y, 0.0f) * (float)rows), rows - 1u);
    __global const float* ofRows = table + 2u;
    __global const float* ofColumns = ofRows + rows + y * columns;
    const float partX = ofColumns[x] - (x > 0u ? ofColumns[x - 1u] : 0.0f);
    const float partY = ofRows[y] - (y > 0u ? ofRows[y - 1u] : 0.0f);
    return partX * (float)columns * (partY * (float)rows);
}

/// pickAt() of a triangle with a table: what stands for its probability, and the weights of its corners.
WEDGE_FN float pickInTable(EmitterData e, float pick, Vec2 weights)
{
    __global const float* header = e.picks + (as_uint(pick) - WEDGE_PICK_TABLE);
    const uint shape = as_uint(header[1]), pair = shape & 3u;
    const uint first = (shape >> WEDGE_HEADER_CORNERS) & 3u, second = (shape >> (WEDGE_HEADER_CORNERS + 2u)) & 3u;
    // The weights of the second and third corner of the entry's triangle, which this one need not begin as.
    const float own[3] = { 1.0f - weights.x - weights.y, weights.x, weights.y };
    const Vec2 ofEntry = vec2(own[second], own[3u - first - second]);
    const uint isSecond = (shape & WEDGE_HEADER_SECOND) != 0u ? 1u : 0u;
    const Vec2 at = pair != WEDGE_PAIR_NONE ? pairToSquare(pair, isSecond, ofEntry) : triangleToSquare(ofEntry);
    const float share = pair != WEDGE_PAIR_NONE ? 0.5f : 1.0f;
    return share * header[0] * densityInTable(e.picks + as_uint(header[2]), at);
}
#endif

/// The probability that a triangle is chosen, or 0, times how much denser than on average points are at the weights of
/// its second and third corner.
WEDGE_FN float pickAt(EmitterData e, uint triangle, Vec2 weights)
{
    const float pick = e.picks[triangle];
#ifdef WEDGE_EMITTER_TABLES
    if (pick >= 2.0f) {
        return pickInTable(e, pick, weights);
    }
#else
    (void)weights;
#endif
    return fmax(pick, 0.0f);
}

WEDGE_FN Vec3 emittedAt(SurfaceData data, uint triangle, Vec2 weights)
{
    const MaterialData material = data.materials[data.materialIds[triangle]];
    if (material.emissionTexture == WEDGE_NO_TEXTURE) {
        return material.emission;
    }
    __global const uint* corner = data.indices + 3u * triangle;
    const float first = 1.0f - weights.x - weights.y;
    const float u = data.texcoords[2u * corner[0]] * first + data.texcoords[2u * corner[1]] * weights.x
        + data.texcoords[2u * corner[2]] * weights.y;
    const float v = data.texcoords[2u * corner[0] + 1u] * first + data.texcoords[2u * corner[1] + 1u] * weights.x
        + data.texcoords[2u * corner[2] + 1u] * weights.y;
    return vecMul(material.emission,
        sampleTexture(data.textures, data.texels, data.srgbToLinear, material.emissionTexture, u, v));
}

/// The point of the numbers u of an area light that is chosen with the probability `pick`.
WEDGE_FN EmitterPoint sampleQuad(AreaLight light, Vec2 u, float pick)
{
    const float a = lightCoordinate(u.x, light.profile, light.cut, light.erfCut);
    const float b = lightCoordinate(u.y, light.profile, light.cut, light.erfCut);
    const float profile = lightProfile(a, b, light.profile, light.cut);
    EmitterPoint p;
    p.point = lightPoint(light.centre, light.halfU, light.halfV, a, b);
    p.normal = light.normal;
    p.radiance = vecScale(light.radiance, profile);
    p.density = pick * profile / light.profileArea;
    p.error = light.lift;
    p.end = shadowRayEnd(light);
    p.oneSided = light.twoSided == 0u;
    return p;
}

/// An entry, and where in its square a sample's point is.
typedef struct {
    Emitter entry;
    float pick; ///< the entry's probability, or that of its mesh
    Vec2 at;
} EmitterChoice;

#ifdef WEDGE_EMITTER_TREES
/// Goes on from a mesh to the entry of it that both numbers choose.
WEDGE_FN void chooseInMesh(EmitterData e, EmitterChoice* choice)
{
    const uint side = choice->entry.header;
    const uint column = min((uint)(choice->at.x * (float)side), side - 1u);
    const uint row = min((uint)(choice->at.y * (float)side), side - 1u);
    __global const Emitter* cell = e.list + choice->entry.triangle + row * side + column;
    float x = choice->at.x * cell->upTo + cell->extent;
    float y = choice->at.y * as_float(cell->guide) + as_float(cell->header);
    uint part = cell->triangle;
    while (part >= WEDGE_PART_SPLIT_X << WEDGE_PART_SHIFT) {
        __global const Emitter* parts = e.list + (part & WEDGE_PART_NUMBER);
        const bool byX = part < WEDGE_PART_SPLIT_Y << WEDGE_PART_SHIFT;
        const float split = parts->upTo, number = byX ? x : y;
        const bool first = number < split;
        const float within = first ? number * parts->extent : (number - split) * as_float(parts->header);
        x = byX ? within : x;
        y = byX ? y : within;
        part = first ? parts->triangle : parts->guide;
    }
    choice->at = vec2(clamp(x, 0.0f, 1.0f), clamp(y, 0.0f, 1.0f));
    choice->entry.pair = part >> WEDGE_PART_SHIFT;
    choice->entry.triangle = part & WEDGE_PART_NUMBER;
    choice->entry.header = 0u;
#ifdef WEDGE_EMITTER_TABLES
    if (choice->entry.pair == WEDGE_PART_TABLED) {
        choice->entry = e.list[choice->entry.triangle];
    }
#endif
}
#endif

/// The first number chooses in the list and goes on within the entry, both in a mesh: what is stratified over the
/// square is so over the list and over each mesh, too.
WEDGE_FN EmitterChoice chooseEmitter(EmitterData e, Vec2 u)
{
    const uint i = findEmitter(e, u.x);
    EmitterChoice out;
    out.entry = e.list[i];
    const float from = i > 0u ? e.list[i - 1u].upTo : 0.0f;
    out.pick = out.entry.upTo - from;
    out.at = vec2(clamp((u.x - from) / fmax(out.pick, 1e-30f), 0.0f, 1.0f), u.y);
#ifdef WEDGE_EMITTER_TREES
    if (out.entry.pair == WEDGE_PAIR_MESH) {
        chooseInMesh(e, &out);
    }
#endif
    return out;
}

/// A place on a triangle that emits.
typedef struct {
    uint triangle;
    Vec2 weights; ///< of its second and third corner
    float pick; ///< as pickAt()
} EmitterPlace;

/// Where on an entry's triangles the choice is.
WEDGE_FN EmitterPlace placeOf(EmitterData e, EmitterChoice choice)
{
    const Emitter emitter = choice.entry;
    const bool paired = emitter.pair != WEDGE_PAIR_NONE;
    Vec2 at = choice.at;
    uint second = 0u;
#ifdef WEDGE_EMITTER_TABLES
    float denser = 1.0f;
    if (emitter.header != 0u) {
        at = spreadByTable(e.picks + as_uint(e.picks[emitter.header + 2u]), at, &denser);
    }
#endif
    EmitterPlace place;
    place.weights = paired ? squareToPair(emitter.pair, at, &second) : squareToTriangle(at);
    place.triangle = emitter.triangle + second;
#ifdef WEDGE_EMITTER_TABLES
    if (emitter.header != 0u) {
        place.pick = (paired ? 0.5f : 1.0f) * e.picks[emitter.header] * denser;
        return place;
    }
#endif
    place.pick = e.picks[place.triangle];
    return place;
}

/// The point of the numbers u at a time.
WEDGE_FN EmitterPoint sampleEmitter(EmitterData e, Vec2 u, float time)
{
    const EmitterChoice choice = chooseEmitter(e, u);
    if (choice.entry.pair == WEDGE_PAIR_QUAD) {
        EmitterPoint p = sampleQuad(e.quads[choice.entry.triangle], choice.at, choice.pick);
        p.extent = choice.entry.extent;
        return p;
    }
    const EmitterPlace place = placeOf(e, choice);
    const uint triangle = place.triangle;
    const Vec2 weights = place.weights;
    const SurfaceData data = e.surfaces;
    const Vec3 a = positionAt(data, data.indices[3u * triangle], time);
    const Vec3 ab = vecSub(positionAt(data, data.indices[3u * triangle + 1u], time), a);
    const Vec3 ac = vecSub(positionAt(data, data.indices[3u * triangle + 2u], time), a);
    const Vec3 normal = vecCross(ab, ac);
    const float twice = vecLength(normal);
    EmitterPoint p;
    p.point = vecMad(vecMad(a, ab, weights.x), ac, weights.y);
    p.normal = vecScale(normal, 1.0f / fmax(twice, 1e-30f));
    p.radiance = emittedAt(data, triangle, weights);
#ifdef WEDGE_CUTOUTS
    // Rays end before the emitter; as many as would pass through it find no light.
    p.radiance = vecScale(p.radiance, opacityAt(e.cutouts, triangle, weights.x, weights.y) * (1.0f / 255.0f));
#endif
    p.density = 2.0f * place.pick / fmax(twice, 1e-30f);
    p.extent = choice.entry.extent;
    const Vec3 far = vec3(
        fabs(a.x) + fabs(ab.x) + fabs(ac.x), fabs(a.y) + fabs(ab.y) + fabs(ac.y), fabs(a.z) + fabs(ab.z) + fabs(ac.z));
    p.error = WEDGE_ORIGIN_ULPS * WEDGE_ULP * (far.x + far.y + far.z);
    p.end = 1.0f;
    p.oneSided = false;
    return p;
}

/// Whether the point sends light against the direction l.
WEDGE_INLINE bool emitsAgainst(const EmitterPoint* p, Vec3 l) { return !p->oneSided || vecDot(p->normal, l) < 0.0f; }

/// From there to the point, lifted off the emitter: the ray meets what is before it, be it ever so near, but not the
/// emitter itself.
WEDGE_FN Vec3 emitterShadowRay(const EmitterPoint* p, Vec3 origin)
{
    const Vec3 ray = vecSub(p->point, origin);
    return vecMad(ray, p->normal, vecDot(p->normal, ray) > 0.0f ? -p->error : p->error);
}

/// Density in 1/sr of a point of that density on a surface of that unit normal, `distance` metres away in direction l.
WEDGE_INLINE float densityOfDirection(float density, Vec3 normal, Vec3 l, float distance)
{
    return density * distance * distance / fmax(fabs(vecDot(normal, l)), 1e-12f);
}

/// Density in 1/sr at which sampleEmitter() finds what a ray of unit direction l met.
WEDGE_FN float emitterPdf(EmitterData e, Hit hit, Vec3 l, float time)
{
    const float pick = pickAt(e, hit.triangle, vec2(hit.u, hit.v));
    if (!(pick > 0.0f)) {
        return 0.0f;
    }
    const Vec3 normal = triangleNormal(e.surfaces, hit.triangle, time);
    const float twice = fmax(vecLength(normal), 1e-30f);
    return densityOfDirection(2.0f * pick / twice, vecScale(normal, 1.0f / twice), l, hit.t);
}

/// What a ray meets that emits; 0 of all else.
WEDGE_FN Vec3 emittedOf(EmitterData e, Hit hit)
{
    return hit.triangle != WEDGE_NO_TRIANGLE && e.count > 0u ? emittedAt(e.surfaces, hit.triangle, vec2(hit.u, hit.v))
                                                             : vec3(0.0f, 0.0f, 0.0f);
}

#endif
