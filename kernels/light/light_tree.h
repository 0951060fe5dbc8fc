// What a map of what is beyond the scene brings to surfaces if nothing hides it, by sums over parts of it: large ones
// where it does not matter from where in the part light comes, small ones where it does.
#ifndef WEDGE_LIGHT_TREE_H
#define WEDGE_LIGHT_TREE_H

#include "light/lobe_lanes.h"
#include "shared/shadow_lights.h"

/// Of matt light: parts that the horizon comes nearer to than so many deviations, squared, ...
#define WEDGE_MATT_HORIZON 9.0f
/// ... are split as long as they are wider than this variance, radians squared.
#define WEDGE_MATT_VARIANCE 0.002f
/// Wider ones are split whatever they bring.
#define WEDGE_WIDE_PART 0.1f
/// A single place varies by 1/12 of its side's square. Lobes over it vary by 1/4 of that at least: they leave no gaps.
#define WEDGE_PLACE_VARIANCE 3.0f

/// A part of the map, see WEDGE_TREE_FLOATS.
typedef struct {
    Vec3 irradiance, towards;
    float brightest; ///< channel of irradiance
    float variance, length; ///< of the mean of its directions
    uint count;
    float radius; ///< radians
} MapPart;

WEDGE_INLINE MapPart mapPart(__global const float* tree, uint index)
{
    __global const float* of = tree + WEDGE_TREE_FLOATS * index;
    const float8 v = vload8(0, of);
    MapPart part;
    part.irradiance = vec3(v.s0, v.s1, v.s2);
    part.towards = vec3(v.s3, v.s4, v.s5);
    part.brightest = fmax(v.s0, fmax(v.s1, v.s2));
    part.variance = v.s6;
    part.length = fmax(1.0f - v.s6, 0.0f);
    part.count = (uint)v.s7;
    part.radius = of[8];
    return part;
}

/// Light of each lane, R G B.
typedef struct {
    float light[3][WEDGE_PACKET_SIZE];
} MapLanes;

WEDGE_FN void clearLanes(MapLanes* sum)
{
    for (uint channel = 0u; channel < 3u; ++channel) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            sum->light[channel][lane] = 0.0f;
        }
    }
}

WEDGE_INLINE Vec3 lightOf(const MapLanes* sum, uint lane)
{
    return vec3(sum->light[0][lane], sum->light[1][lane], sum->light[2][lane]);
}

WEDGE_FN void addPart(Vec3 irradiance, const float* weight, MapLanes* sum)
{
    const float colour[3] = { irradiance.x, irradiance.y, irradiance.z };
    for (uint channel = 0u; channel < 3u; ++channel) {
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            sum->light[channel][lane] += colour[channel] * weight[lane];
        }
    }
}

/// The mean of max(c + deviation z, 0) over a normal z, to 0.001 of the deviation: of a part of the map that the
/// horizon cuts, what is above it.
WEDGE_INLINE float cosineAbove(float c, float variance)
{
    const float deviation = sqrt(variance), z = fmin(fmax(c / deviation, -6.0f), 6.0f);
    // The normal distribution, as 1 / (1 + exp(-1.5957691 z - 0.07056 z^3)) (Page, 1977).
    const float above = 1.0f / (1.0f + exp2Bounded(-z * (2.30220824f + 0.10179657f * z * z)));
    const float density = 0.398942280f * exp2Bounded(-0.721347520f * z * z);
    return fmax(c * above + deviation * density, 0.0f);
}

/// Parts of the map that each lane has taken: all before `until`.
typedef struct {
    uint until[WEDGE_PACKET_SIZE];
} Walk;

/// Lanes of `of` that are not 0 begin, others are done.
WEDGE_FN void beginWalk(const uint* of, uint parts, Walk* walk)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        walk->until[lane] = of[lane] != 0u ? 0u : parts;
    }
}

/// Lanes that are at part i and for which it is to be split, if it can be, go on below it.
/// splits: 1 or 0
/// out  takes: 1 of lanes that take it as a whole; any: whether one does
/// Returns the part that is next.
WEDGE_FN uint walkOn(uint i, uint count, const uint* splits, float* takes, bool* any, Walk* walk)
{
    uint below = 0u, taken = 0u;
    const uint can = count > 1u ? 1u : 0u;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint open = walk->until[lane] <= i ? 1u : 0u;
        const uint split = open & splits[lane] & can;
        const uint own = open & (1u - split);
        takes[lane] = (float)own;
        walk->until[lane] = own != 0u ? i + count : walk->until[lane];
        below |= split;
        taken |= own;
    }
    *any = taken != 0u;
    return i + (below != 0u ? 1u : count);
}

/// Irradiance of each lane's surface by the map. Above the horizon the mean direction of a part is all that matters.
WEDGE_FN void mattLight(
    __global const float* tree, uint parts, const ReceiverPacket* r, const uint* shaded, MapLanes* sum)
{
    Walk walk;
    beginWalk(shaded, parts, &walk);
    for (uint i = 0u; i < parts;) {
        const MapPart part = mapPart(tree, i);
        if (!(part.brightest > 0.0f)) {
            i += part.count;
            continue;
        }
        const uint wide = part.variance > WEDGE_MATT_VARIANCE ? 1u : 0u,
                   widest = part.variance > WEDGE_WIDE_PART ? 1u : 0u;
        float cosine[WEDGE_PACKET_SIZE], takes[WEDGE_PACKET_SIZE];
        uint splits[WEDGE_PACKET_SIZE];
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const float c = vecDot(vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]), part.towards);
            const uint cut = c * c < WEDGE_MATT_HORIZON * part.variance ? wide : 0u;
            splits[lane] = cut | widest;
            cosine[lane] = c * part.length;
        }
        bool any;
        i = walkOn(i, part.count, splits, takes, &any, &walk);
        if (any) {
            for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
                takes[lane] *= cosineAbove(cosine[lane], part.variance);
            }
            addPart(part.irradiance, takes, sum);
        }
    }
}

#ifdef WEDGE_SPECULAR
/// Views mirrored by the surfaces of lanes, which lobes have their peaks at, about.
typedef struct {
    float x[WEDGE_PACKET_SIZE], y[WEDGE_PACKET_SIZE], z[WEDGE_PACKET_SIZE];
} MirroredViews;

WEDGE_FN void mirroredViews(const ReceiverPacket* r, MirroredViews* m)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]), v = laneView(r, lane);
        const Vec3 mirrored = vecMad(vecScale(v, -1.0f), n, 2.0f * vecDot(n, v));
        m->x[lane] = mirrored.x;
        m->y[lane] = mirrored.y;
        m->z[lane] = mirrored.z;
    }
}

/// Lobes that are spread by the variance of a part's directions, or to that of single places, and reflect as much.
/// Tails of microfacets do not widen: there they are even.
WEDGE_FN void spreadLobes(const LobeLanes* own, const MirroredViews* m, MapPart part, LobeLanes* spread)
{
    const float least = part.count == 1u ? WEDGE_PLACE_VARIANCE * part.variance : 0.0f;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const float exponent = own->exponent[lane];
        const bool microfacets = own->kind[lane] == WEDGE_MICROFACETS;
        const float as = own->kind[lane] == WEDGE_PHONG ? exponent : 0.25f * exponent;
        const float c = vecDot(vec3(m->x[lane], m->y[lane], m->z[lane]), part.towards);
        const float tail = microfacets ? 1.0f + 2.0f * as * fmax(1.0f - c, 0.0f) : 1.0f;
        const float wider = fmax(1.0f + as * part.variance / tail, as * least);
        const Lobe lobe = makeLobe(exponent / wider, own->kind[lane]);
        const float kept = own->normalization[lane], scaled = kept * (lobe.exponent + 1.0f) / (exponent + 1.0f);
        spread->exponent[lane] = lobe.exponent;
        spread->normalization[lane] = microfacets ? kept : scaled;
        spread->leastCosine[lane] = lobe.leastCosine;
        spread->kind[lane] = own->kind[lane];
    }
}

/// The most that lobes reflect of light from anywhere in a part, about, and by how much a part as large widens them, at
/// most 1.
WEDGE_FN void lobeBounds(
    const ReceiverPacket* r, const LobeLanes* own, const MirroredViews* m, MapPart part, float* bound)
{
    float sine, cosine;
    sinCosTurn(fmin(part.radius, 3.14159f) * 0.159154943f, &sine, &cosine);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const Vec3 n = vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]);
        const Vec3 axis = vec3(m->x[lane], m->y[lane], m->z[lane]);
        // From the part's middle to the lobe's by the part's radius.
        const float c = vecDot(axis, part.towards), s = sqrt(fmax(1.0f - c * c, 1e-12f));
        const Vec3 nearest = vecMad(vecScale(part.towards, cosine - c * sine / s), axis, sine / s);
        const Vec3 at = vecChoose(c < cosine, nearest, axis);
        Lobe lobe;
        lobe.exponent = own->exponent[lane];
        lobe.normalization = own->normalization[lane];
        lobe.leastCosine = own->leastCosine[lane];
        lobe.kind = own->kind[lane];
        const float as = lobe.kind == WEDGE_PHONG ? lobe.exponent : 0.25f * lobe.exponent;
        bound[lane] = fmin(0.25f * as * part.radius * part.radius, 1.0f) * lobeValue(lobe, n, laneView(r, lane), at);
    }
}

/// What each lane's lobe reflects of the map, over its specular reflectance. Parts are split of which it might reflect
/// more than `least`, W/(sr m^2), unless they are small beside it.
WEDGE_FN void lobeLight(
    __global const float* tree, uint parts, const ReceiverPacket* r, const uint* reflects, float least, MapLanes* sum)
{
    Walk walk;
    beginWalk(reflects, parts, &walk);
    LobeLanes own, spread;
    lobesOf(r, 0.0f, &own);
    MirroredViews mirrored;
    mirroredViews(r, &mirrored);
    for (uint i = 0u; i < parts;) {
        const MapPart part = mapPart(tree, i);
        if (!(part.brightest > 0.0f)) {
            i += part.count;
            continue;
        }
        float takes[WEDGE_PACKET_SIZE], cosine[WEDGE_PACKET_SIZE], weight[WEDGE_PACKET_SIZE];
        uint splits[WEDGE_PACKET_SIZE];
        if (part.variance > WEDGE_WIDE_PART) {
            for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
                splits[lane] = 1u;
            }
        } else {
            lobeBounds(r, &own, &mirrored, part, weight);
            for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
                splits[lane] = weight[lane] * part.brightest > least ? 1u : 0u;
            }
        }
        bool any;
        i = walkOn(i, part.count, splits, takes, &any, &walk);
        if (any) {
            for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
                const float c = vecDot(vec3(r->normalX[lane], r->normalY[lane], r->normalZ[lane]), part.towards);
                cosine[lane] = cosineAbove(c * part.length, part.variance) * takes[lane];
            }
            spreadLobes(&own, &mirrored, part, &spread);
            lobeWeights(r, &spread, part.towards, cosine, weight);
            addPart(part.irradiance, weight, sum);
        }
    }
}
#endif

#endif
