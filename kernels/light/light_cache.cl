// All of a map's light by the normal alone, as if every surface were seen from where the camera is far along the
// middle of its view: tables of it, made once a frame, and pixels that look up theirs (chapter 4 of the DeCoro thesis).
#include "core/pixel.h"
#include "light/light_packet.h"
#include "light/light_tree.h"
#include "shared/filter_params.h"
#include "shared/shadow_lights.h"

#define WEDGE_CACHE_TEXELS (WEDGE_CACHE_SIDE * WEDGE_CACHE_SIDE)

/// Where normals lie in a table: Lambert's azimuthal map of equal areas about the view. Normals as far off it as any
/// that a pixel may see lie in a disc around the table's middle; texels around that are for those that are between
/// four of them.
typedef struct {
    Vec3 towards, across, down; ///< unit: from the scene to the camera, and along the image's sides
    float farthest; ///< of that disc; 2 would be the normal that faces away
    float scale; ///< texels
} CacheMap;

WEDGE_FN CacheMap cacheMap(FrameParams frame)
{
    CacheMap m;
    m.towards = vecScale(frame.forward, -1.0f);
    m.across = vecNormalize(frame.right);
    m.down = vecNormalize(frame.down);
    // Of the pixel in a corner: the tangent of how far its view is from the middle one.
    const float x = 0.5f * (float)frame.width, y = 0.5f * (float)frame.height;
    const float squared = x * x * vecDot(frame.right, frame.right) + y * y * vecDot(frame.down, frame.down);
    m.farthest = sqrt(2.0f + 2.0f * sqrt(squared / (1.0f + squared)));
    m.scale = (0.5f * (float)WEDGE_CACHE_SIDE - 2.0f) / m.farthest;
    return m;
}

/// The normal in the middle of a texel; false of texels in the corners, which nothing reads.
WEDGE_FN bool cachedNormal(CacheMap m, uint x, uint y, Vec3* normal)
{
    const float middle = 0.5f * (float)WEDGE_CACHE_SIDE;
    const float right = (float)x + 0.5f - middle, below = (float)y + 0.5f - middle;
    const float a = right / m.scale, b = below / m.scale, squared = fmin(a * a + b * b, 4.0f);
    const float aside = sqrt(1.0f - 0.25f * squared);
    const Vec3 across = vecMad(vecScale(m.across, a * aside), m.down, b * aside);
    *normal = vecNormalize(vecMad(across, m.towards, 1.0f - 0.5f * squared));
    return right * right + below * below <= middle * middle;
}

/// Where a unit normal lies, in texels from the middle of the first one. What is beyond the disc counts as at its rim.
WEDGE_FN Vec2 texelOf(CacheMap m, Vec3 n)
{
    const float x = vecDot(n, m.across), y = vecDot(n, m.down), z = vecDot(n, m.towards);
    const float aside = sqrt(x * x + y * y);
    // Beside the view the first has no digits, and opposite of it the second.
    const float far = sqrt(fmax(2.0f - 2.0f * z, 0.0f)), near = aside * sqrt(2.0f / (1.0f + fmax(z, 0.0f)));
    const float off = m.scale * fmin(z < 0.0f ? far : near, m.farthest);
    const float middle = 0.5f * (float)WEDGE_CACHE_SIDE - 0.5f;
    const bool aims = aside > 0.0f;
    return vec2(middle + off * (aims ? x / aside : 1.0f), middle + off * (aims ? y / aside : 0.0f));
}

/// What a table holds at a place, between four texels. table: R G B of each
WEDGE_FN Vec3 cachedLight(__global const float* table, Vec2 at)
{
    // Of no place, in rehearsals, these are some texels.
    const float last = (float)(WEDGE_CACHE_SIDE - 2u);
    const float left = fmin(fmax(floor(at.x), 0.0f), last), top = fmin(fmax(floor(at.y), 0.0f), last);
    const float u = at.x - left, v = at.y - top;
    __global const float* first = table + 3u * ((uint)top * WEDGE_CACHE_SIDE + (uint)left);
    __global const float* second = first + 3u * WEDGE_CACHE_SIDE;
    float light[3];
    for (uint c = 0u; c < 3u; ++c) {
        const float above = first[c] + u * (first[3u + c] - first[c]);
        const float below = second[c] + u * (second[3u + c] - second[c]);
        light[c] = above + v * (below - above);
    }
    return vec3(light[0], light[1], light[2]);
}

#ifdef WEDGE_SPECULAR
/// The packet's receivers have that normal each, and that gloss, and are all seen from one direction.
WEDGE_FN void seeFrom(Vec3 towards, uint gloss, ReceiverPacket* r)
{
    const Lobe lobe = glossLobe(gloss);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        r->viewX[lane] = towards.x;
        r->viewY[lane] = towards.y;
        r->viewZ[lane] = towards.z;
        r->gloss[lane] = gloss;
        r->exponent[lane] = lobe.exponent;
        r->kind[lane] = lobe.kind;
        r->normalization[lane] = lobe.normalization;
        r->leastCosine[lane] = lobe.leastCosine;
    }
}
#endif

/// What surfaces of each normal reflect of all of the map, over their reflectances: of matt ones the first table, and
/// of lobes one each.
/// in      tree: `parts` of the map, see light_tree.h; least: see lobeLight(); tables: how many; glosses: packGloss()
///         of all but the first
/// in out  table: R G B of each texel, rows of one table after the other; set where pixels may look
#include "pass/fillLightCache.h"
#ifdef PASS_fillLightCache
__kernel void fillLightCache(PARAMETERS)
{
    const ulong item = (ulong)firstGroup * get_local_size(0) + get_global_id(0);
    const uint of = (uint)(item * WEDGE_PACKET_SIZE / WEDGE_CACHE_TEXELS);
    if (of >= tables) {
        return;
    }
    const CacheMap map = cacheMap(frame);
    ReceiverPacket receivers;
    uint texel[WEDGE_PACKET_SIZE], inside[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        // Squares of four by four: their parts of the map are alike.
        const uint i = (uint)(item * WEDGE_PACKET_SIZE + lane) % WEDGE_CACHE_TEXELS, block = i / 16u;
        const uint x = block % (WEDGE_CACHE_SIDE / 4u) * 4u + i % 4u;
        const uint y = block / (WEDGE_CACHE_SIDE / 4u) * 4u + i % 16u / 4u;
        Vec3 n;
        inside[lane] = cachedNormal(map, x, y, &n) ? 1u : 0u;
        texel[lane] = of * WEDGE_CACHE_TEXELS + y * WEDGE_CACHE_SIDE + x;
        receivers.normalX[lane] = n.x;
        receivers.normalY[lane] = n.y;
        receivers.normalZ[lane] = n.z;
    }
    MapLanes sum;
    clearLanes(&sum);
    float scale = 1.0f;
    if (of == 0u) {
        mattLight(tree, parts, &receivers, inside, &sum);
        scale = WEDGE_INV_PI;
    }
#ifdef WEDGE_SPECULAR
    if (of > 0u) {
        seeFrom(map.towards, glosses[of - 1u], &receivers);
        lobeLight(tree, parts, &receivers, inside, least, &sum);
    }
#else
    (void)glosses;
    (void)least;
#endif
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (inside[lane] != 0u) {
            for (uint c = 0u; c < 3u; ++c) {
                table[3u * texel[lane] + c] = scale * sum.light[c][lane];
            }
        }
    }
}
#endif

#ifdef WEDGE_SPECULAR
/// What the lobe of table k reflects at a place. rise: of microfacets, whose light is linear in it
WEDGE_FN Vec3 lightOfTable(__global const float* table, uint tables, uint k, bool microfacets, float rise, Vec2 at)
{
    const Vec3 light = cachedLight(table + 3u * WEDGE_CACHE_TEXELS * k, at);
    if (!microfacets) {
        return light;
    }
    const Vec3 risen = cachedLight(table + 3u * WEDGE_CACHE_TEXELS * min(k + 1u, tables - 1u), at);
    const Vec3 sum = vecMad(light, vecSub(risen, light), rise / WEDGE_CACHE_RISE);
    return vec3(fmax(sum.x, 0.0f), fmax(sum.y, 0.0f), fmax(sum.z, 0.0f));
}

/// What a lobe reflects by the tables of its kind: of its exponent, or between those of the next ones.
/// glosses: by kinds, of each from the smallest exponent to the largest
WEDGE_FN Vec3 lightOfLobe(__global const float* table, __global const uint* glosses, uint tables, Gloss gloss, Vec2 at)
{
    uint less = 0u, more = 0u; // 0: there is none
    float lessAt = 0.0f, moreAt = 0.0f;
    for (uint k = 1u; k < tables; ++k) {
        const Gloss own = unpackGloss(glosses[k - 1u]);
        if (own.kind == gloss.kind && !(own.rise > 0.0f)) {
            const bool isMore = own.exponent > gloss.exponent;
            more = isMore && more == 0u ? k : more;
            moreAt = more == k ? own.exponent : moreAt;
            less = isMore ? less : k;
            lessAt = isMore ? lessAt : own.exponent;
        }
    }
    if (less == 0u && more == 0u) {
        return vec3(0.0f, 0.0f, 0.0f);
    }
    const bool microfacets = gloss.kind == WEDGE_MICROFACETS;
    const Vec3 first = lightOfTable(table, tables, less != 0u ? less : more, microfacets, gloss.rise, at);
    if (less == 0u || more == 0u || !(gloss.exponent > lessAt)) {
        return first;
    }
    const Vec3 second = lightOfTable(table, tables, more, microfacets, gloss.rise, at);
    const float from = logPositive(1.0f + lessAt), to = logPositive(1.0f + moreAt);
    const float share = (logPositive(1.0f + gloss.exponent) - from) / fmax(to - from, 1e-6f);
    return vecMad(first, vecSub(second, first), fmin(share, 1.0f));
}
#endif

/// What surfaces reflect of all of the map if nothing hides it, over their reflectances, by their normals.
/// in   table, glosses, tables: as fillLightCache() has them; normal, specular: 3 planes each; objectId, gloss
/// out  wholeMatt, whole (of lobes; only in scenes that have some): 3 planes each; 0 where there is no surface
#include "pass/lookUpLight.h"
#ifdef PASS_lookUpLight
__kernel void lookUpLight(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const uint size = p.planeSize;
    const bool there = objectId[i] != 0u;
    const Vec3 none = vec3(0.0f, 0.0f, 0.0f);
    const Vec2 at = texelOf(cacheMap(frame), loadVec(normal, size, i));
    storeVec(wholeMatt, size, i, there ? cachedLight(table, at) : none);
#ifdef WEDGE_SPECULAR
    const bool reflects = there && luminance(loadVec(specular, size, i)) > 0.0f;
    storeVec(whole, size, i, reflects ? lightOfLobe(table, glosses, tables, unpackGloss(gloss[i]), at) : none);
#else
    (void)glosses;
    (void)tables;
    (void)specular;
    (void)gloss;
    (void)whole;
#endif
}
#endif
