// The radiance that pixels receive from the lights that they see, where that is known without sampling: where nothing
// is before a light, it is that of the light times the share of the pixel, and of the lens, that it covers. Primary
// samples then add what they see besides (wave_primary.cl): the edge of a bright light has no noise.
#include "core/pixel.h"
#include "light/seen_light.h"
#include "shared/camera.h"
#include "shared/coverage.h"

/// Primary rays that try whether anything is before the lights of a pixel.
#define WEDGE_TRIED_RAYS 32u
#define WEDGE_TRIED_SEED 0x74727972u

/// How the share that a light covers is known: not at all; as a mean of pixelCoverage() over points of the lens; as one
/// of discCoverage() over points of the pixel. Without a lens, or with rays through the pixels' centres alone, it is
/// that of one point, which is exact, and else of so many.
#define WEDGE_SHARE_UNKNOWN 0u
#define WEDGE_SHARE_OF_PIXEL 1u
#define WEDGE_SHARE_OF_LENS 2u
#define WEDGE_LENS_POINTS 256u
#define WEDGE_PIXEL_POINTS 16u
/// Radii of circles of confusion in pixels, from which on the latter is the better one, up to which the former will do,
/// and beyond which edges have little noise.
#define WEDGE_TINY_CONFUSION 0.1f ///< below which corners are too many radii of the lens away
#define WEDGE_LEAST_CONFUSION 1.0f
#define WEDGE_FEW_CONFUSION 3.0f
#define WEDGE_MOST_CONFUSION 16.0f
/// Widest light in pixels of a profile that is not uniform, and its cells an axis and points of each.
#define WEDGE_SMALL_LIGHT 8.0f
#define WEDGE_LIGHT_CELLS 24u
#define WEDGE_CELL_POINTS 16u
/// Pixels from the image's middle within which corners are known well enough.
#define WEDGE_FAR_CORNER 1e4f
/// Lights near a pixel, at most.
#define WEDGE_MOST_SEEN 4u

/// A point of a light in the image: where the lens' centre sees it, pixels from the middle, and by how much the lens'
/// points move it, pixels for the lens' radius.
typedef struct {
    Vec2 at;
    float shift;
} SeenPoint;

WEDGE_FN SeenPoint seenPoint(CameraParams camera, Vec3 point)
{
    SeenPoint p;
    p.at = projectPoint(camera, point, 0.0f);
    const float depth = fmax(vecDot(vecSub(point, camera.eye), camera.forward), WEDGE_LEAST_DEPTH);
    p.shift = camera.apertureRadius * (1.0f / camera.focusDistance - 1.0f / depth) / camera.pixelStep;
    return p;
}

/// Corner k, around it, of the light, or of a part of it: of local coordinates from low to high.
WEDGE_FN Vec3 lightCorner(AreaLight light, uint k, Vec2 low, Vec2 high)
{
    return lightPoint(
        light.centre, light.halfU, light.halfV, k == 1u || k == 2u ? high.x : low.x, k >= 2u ? high.y : low.y);
}

/// Whether all of a light is behind the camera, or beyond one side of what it sees.
WEDGE_FN bool outOfView(FrameParams frame, CameraParams camera, AreaLight light)
{
    uint beyond[5] = { 0u, 0u, 0u, 0u, 0u };
    for (uint k = 0u; k < 4u; ++k) {
        const Vec3 d = vecSub(lightCorner(light, k, vec2(-1.0f, -1.0f), vec2(1.0f, 1.0f)), camera.eye);
        const float x = vecDot(d, camera.right) / vecDot(camera.right, camera.right);
        const float y = vecDot(d, camera.down) / vecDot(camera.down, camera.down);
        const float z = vecDot(d, camera.forward);
        // Of pixels at distance 1, with the filter's reach, and how far the lens' points lie apart there.
        const float lens = camera.apertureRadius / camera.pixelStep * (1.0f + fabs(z) / camera.focusDistance);
        const float halfX = z * (0.5f * (float)frame.width + 2.0f), halfY = z * (0.5f * (float)frame.height + 2.0f);
        beyond[0] += x > halfX + lens ? 1u : 0u;
        beyond[1] += -x > halfX + lens ? 1u : 0u;
        beyond[2] += y > halfY + lens ? 1u : 0u;
        beyond[3] += -y > halfY + lens ? 1u : 0u;
        beyond[4] += z <= 0.0f ? 1u : 0u;
    }
    return beyond[0] == 4u || beyond[1] == 4u || beyond[2] == 4u || beyond[3] == 4u || beyond[4] == 4u;
}

/// in   frame, camera, lights; approximate: 1: shares that are known to 1e-3 will do
/// out  windows: of each light, 6 numbers: the rectangle x0, y0, x1, y1 of the image that rays which meet it go
///      through, pixels from the image's corner, empty if the camera does not see it; WEDGE_SHARE_*; the radius of the
///      largest circle of confusion, pixels
#include "pass/windowsOfLights.h"
#ifdef PASS_windowsOfLights
__kernel void windowsOfLights(PARAMETERS)
{
    const uint i = get_global_id(0);
    if (i >= lightCount) {
        return;
    }
    const AreaLight light = lights[i];
    Vec2 low = vec2(INFINITY, INFINITY), high = vec2(-INFINITY, -INFINITY);
    bool before = true;
    float leastShift = INFINITY, mostShift = -INFINITY;
    for (uint k = 0u; k < 4u; ++k) {
        const Vec3 corner = lightCorner(light, k, vec2(-1.0f, -1.0f), vec2(1.0f, 1.0f));
        const SeenPoint p = seenPoint(camera, corner);
        const float x = p.at.x + 0.5f * (float)frame.width, y = p.at.y + 0.5f * (float)frame.height;
        const float reach = fabs(p.shift);
        before = before && vecDot(vecSub(corner, camera.eye), camera.forward) > WEDGE_LEAST_DEPTH
            && fmax(fabs(p.at.x), fabs(p.at.y)) <= WEDGE_FAR_CORNER;
        leastShift = fmin(leastShift, p.shift);
        mostShift = fmax(mostShift, p.shift);
        low = vec2(fmin(low.x, x - reach), fmin(low.y, y - reach));
        high = vec2(fmax(high.x, x + reach), fmax(high.y, y + reach));
    }
    const bool centre = camera.pixelFilter == WEDGE_PIXEL_CENTRE, pinhole = !(camera.apertureRadius > 0.0f);
    // least < 0: it is in focus somewhere.
    const float least = fmax(leastShift, -mostShift), most = fmax(-leastShift, mostShift);
    const bool ofLens = camera.gaussianAperture == 0u && most <= WEDGE_MOST_CONFUSION
        && least > (centre ? WEDGE_TINY_CONFUSION : WEDGE_LEAST_CONFUSION);
    const bool ofPixel = !centre && most <= WEDGE_FEW_CONFUSION;
    const bool uniform = light.profile == WEDGE_PROFILE_UNIFORM;
    const bool small =
        most <= WEDGE_FEW_CONFUSION && fmax(high.x - low.x, high.y - low.y) <= WEDGE_SMALL_LIGHT + 2.0f * most;
    // Of lights with two sides, or one that all of the lens, or none of it, sees.
    const bool oneSide =
        light.twoSided != 0u || fabs(vecDot(light.normal, vecSub(camera.eye, light.centre))) > camera.apertureRadius;
    const bool exact = uniform && (pinhole || centre);
    const bool known = before && oneSide && (exact || (approximate != 0u && (uniform || small)));
    const uint way = ofLens ? WEDGE_SHARE_OF_LENS : ofPixel ? WEDGE_SHARE_OF_PIXEL : WEDGE_SHARE_UNKNOWN;
    // In part beside or behind the camera, or far beyond the image, it may be seen anywhere.
    __global float* w = windows + 6u * i;
    w[0] = light.visible == 0u || outOfView(frame, camera, light) ? INFINITY : before ? low.x : -INFINITY;
    w[1] = before ? low.y : -INFINITY;
    w[2] = before ? high.x : INFINITY;
    w[3] = before ? high.y : INFINITY;
    w[4] = (float)(known ? way : WEDGE_SHARE_UNKNOWN);
    w[5] = most;
}
#endif

/// The camera and one of its pixels.
typedef struct {
    CameraParams camera;
    float width, height; ///< of the image
    float x, y; ///< of the pixel's centre
    uint seed;
} SeeingPixel;

/// A part of a light in the image, of which the lens' point moves each corner.
WEDGE_FN ImageQuad partInImage(SeeingPixel from, AreaLight light, Vec2 low, Vec2 high, Vec2 lens)
{
    ImageQuad quad;
    for (uint k = 0u; k < 4u; ++k) {
        const SeenPoint p = seenPoint(from.camera, lightCorner(light, k, low, high));
        quad.corners[k] = vec2(p.at.x + p.shift * lens.x + 0.5f * from.width - from.x,
            p.at.y + p.shift * lens.y + 0.5f * from.height - from.y);
    }
    return quad;
}

/// The same in units of the lens' radius: which points of it see that part through the pixel's point, and that at an
/// offset from its centre. The rays of one point of the image all go through one of the plane in focus.
WEDGE_FN ImageQuad partInLens(SeeingPixel from, AreaLight light, Vec2 low, Vec2 high, Vec2 offset)
{
    ImageQuad quad;
    for (uint k = 0u; k < 4u; ++k) {
        const SeenPoint p = seenPoint(from.camera, lightCorner(light, k, low, high));
        quad.corners[k] = vec2((from.x + offset.x - 0.5f * from.width - p.at.x) / p.shift,
            (from.y + offset.y - 0.5f * from.height - p.at.y) / p.shift);
    }
    return quad;
}

/// The share of a pixel, and of the lens, that part of a light covers. share: WEDGE_SHARE_*.
WEDGE_FN float shareOfPart(SeeingPixel from, AreaLight light, Vec2 low, Vec2 high, uint share)
{
    const CameraParams camera = from.camera;
    const bool ofLens = share == WEDGE_SHARE_OF_LENS;
    const bool one = ofLens ? camera.pixelFilter == WEDGE_PIXEL_CENTRE : !(camera.apertureRadius > 0.0f);
    const bool cell = light.profile != WEDGE_PROFILE_UNIFORM;
    const uint points = one ? 1u : cell ? WEDGE_CELL_POINTS : ofLens ? WEDGE_PIXEL_POINTS : WEDGE_LENS_POINTS;
    float sum = 0.0f;
    for (uint k = 0u; k < points; ++k) {
        const Vec2 u = one ? vec2(0.5f, 0.5f) : sobolOwen(k, hashUint(from.seed ^ 0x33333333u));
        if (ofLens) {
            sum += discCoverage(partInLens(from, light, low, high, vec2(u.x - 0.5f, u.y - 0.5f)));
        } else {
            const Vec2 lens = one ? vec2(0.0f, 0.0f) : aperturePoint(camera.gaussianAperture, u);
            sum += pixelCoverage(partInImage(from, light, low, high, lens));
        }
    }
    return sum / (float)points;
}

/// How far from a pixel's centre, in pixels, rays go through the plane of a light, at most.
WEDGE_FN float reachOf(SeeingPixel from, float confusion)
{
    return (from.camera.pixelFilter == WEDGE_PIXEL_CENTRE ? 0.0f : 0.5f) + confusion;
}

/// Mean of one axis' part of a light's profile from one local coordinate to another.
WEDGE_FN float meanProfile(AreaLight light, float low, float high)
{
    const float scale = 0.70710678f * light.cut, wide = scale * (high - low);
    // Of a narrow part the difference of error functions is mostly rounding.
    if (wide < 0.02f) {
        return lightProfile(0.5f * (low + high), 0.0f, light.profile, light.cut);
    }
    return 0.886226925f * (errorFunction(scale * high) - errorFunction(scale * low)) / wide;
}

/// Part of a light, in local coordinates.
typedef struct {
    Vec2 low, high;
} LightArea;

/// A part of the light beside which rays through the pixel do not meet it.
WEDGE_FN LightArea seenArea(SeeingPixel from, AreaLight light, float confusion)
{
    const CameraParams camera = from.camera;
    const float reach = reachOf(from, confusion);
    LightArea area;
    area.low = vec2(1.0f, 1.0f);
    area.high = vec2(-1.0f, -1.0f);
    bool before = true;
    for (uint k = 0u; k < 4u; ++k) {
        const CameraRay ray = cameraRay(camera, from.width, from.height, from.x + (k % 2u == 0u ? -reach : reach),
            from.y + (k / 2u == 0u ? -reach : reach), vec2(0.0f, 0.0f), 0.0f);
        const LightMeeting m = meetLight(light, ray.origin, ray.direction);
        before = before && vecDot(light.normal, vecSub(light.centre, ray.origin)) / m.facing > 0.0f;
        area.low = vec2(fmin(area.low.x, m.a), fmin(area.low.y, m.b));
        area.high = vec2(fmax(area.high.x, m.a), fmax(area.high.y, m.b));
    }
    // Through the pixel's corners the light's plane may lie behind the camera.
    area.low = vec2(before ? fmax(area.low.x, -1.0f) : -1.0f, before ? fmax(area.low.y, -1.0f) : -1.0f);
    area.high = vec2(before ? fmin(area.high.x, 1.0f) : 1.0f, before ? fmin(area.high.y, 1.0f) : 1.0f);
    return area;
}

/// The mean over a pixel of the profile of a light, 0 beside it. share: WEDGE_SHARE_*; area: seenArea().
WEDGE_FN float shareOfLight(SeeingPixel from, AreaLight light, uint share, LightArea area)
{
    if (light.profile == WEDGE_PROFILE_UNIFORM) {
        return shareOfPart(from, light, vec2(-1.0f, -1.0f), vec2(1.0f, 1.0f), share);
    }
    // In cells of one brightness each.
    const float stepA = (area.high.x - area.low.x) / (float)WEDGE_LIGHT_CELLS;
    const float stepB = (area.high.y - area.low.y) / (float)WEDGE_LIGHT_CELLS;
    float sum = 0.0f;
    for (uint j = 0u; stepA > 0.0f && stepB > 0.0f && j < WEDGE_LIGHT_CELLS * WEDGE_LIGHT_CELLS; ++j) {
        const Vec2 low = vec2(
            area.low.x + (float)(j % WEDGE_LIGHT_CELLS) * stepA, area.low.y + (float)(j / WEDGE_LIGHT_CELLS) * stepB);
        const Vec2 high = vec2(low.x + stepA, low.y + stepB);
        sum += shareOfPart(from, light, low, high, share) * meanProfile(light, low.x, high.x)
            * meanProfile(light, low.y, high.y);
    }
    return sum;
}

/// Lights that are near a pixel in the image.
typedef struct {
    uint count, index[WEDGE_MOST_SEEN];
    LightArea area[WEDGE_MOST_SEEN]; ///< of which rays through the pixel may come
} NearLights;

/// A primary ray's way: image position in pixels from the pixel's centre, and point of the lens.
typedef struct {
    Vec2 offset, lens;
} PrimaryWay;

/// One of WEDGE_TRIED_RAYS: any one, or one to a random point of a light near by, if that is a way.
WEDGE_FN PrimaryWay triedWay(
    SeeingPixel from, __global const AreaLight* restrict lights, const NearLights* near, uint index)
{
    const CameraParams camera = from.camera;
    const uint filter = camera.pixelFilter;
    const Vec2 u = sobolOwen(index, from.seed);
    PrimaryWay way;
    way.offset = way.lens = vec2(0.0f, 0.0f);
    if (filter != WEDGE_PIXEL_CENTRE) {
        way.offset = vec2(u.x - 0.5f, u.y - 0.5f);
    }
    if (camera.apertureRadius > 0.0f) {
        way.lens = aperturePoint(camera.gaussianAperture, sobolOwen(index, hashUint(from.seed)));
    }
    if (index % 2u == 0u) {
        return way;
    }
    const uint which = index / 2u % near->count;
    const AreaLight light = lights[near->index[which]];
    const LightArea area = near->area[which];
    const float a = area.low.x + u.x * (area.high.x - area.low.x), b = area.low.y + u.y * (area.high.y - area.low.y);
    const SeenPoint p = seenPoint(camera, lightPoint(light.centre, light.halfU, light.halfV, a, b));
    const float x = p.at.x + 0.5f * from.width - from.x, y = p.at.y + 0.5f * from.height - from.y;
    if (filter == WEDGE_PIXEL_CENTRE) {
        const Vec2 lens = vec2(-x / p.shift, -y / p.shift);
        way.lens = lens.x * lens.x + lens.y * lens.y <= 1.0f ? lens : way.lens;
    } else {
        const Vec2 offset = vec2(x + p.shift * way.lens.x, y + p.shift * way.lens.y);
        way.offset = fmax(fabs(offset.x), fabs(offset.y)) <= 0.5f ? offset : way.offset;
    }
    return way;
}

/// Whether rays through a pixel meet a light, and none of them anything before it.
WEDGE_FN bool seesLights(SeeingPixel from, __global const TraversalNode* restrict nodes,
    __global const TriangleBlock* restrict blocks, __global const AreaLight* restrict lights, uint lightCount,
    const NearLights* near)
{
    const CameraParams camera = from.camera;
    bool any = false;
    for (uint first = 0u; first < WEDGE_TRIED_RAYS; first += WEDGE_PACKET_SIZE) {
        RayPacket rays;
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            const PrimaryWay way = triedWay(from, lights, near, first + lane);
            const CameraRay ray = cameraRay(
                camera, from.width, from.height, from.x + way.offset.x, from.y + way.offset.y, way.lens, 0.0f);
            setRay(&rays, lane, ray.origin, ray.direction, 0.0f, INFINITY);
            setTime(&rays, lane, shutterTime(camera, sobolOwen(first + lane, hashUint(from.seed ^ 0x55555555u)).x));
        }
        VecLanes sent, nearest;
        uint met[WEDGE_PACKET_SIZE], occluded[WEDGE_PACKET_SIZE];
        lightsMet(lights, lightCount, &rays, &sent, met);
        endAtLights(lights, lightCount, &rays, &nearest);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            rays.tMax[lane] = met[lane] > 0u ? rays.tMax[lane] : 0.0f;
        }
        anyHits(nodes, blocks, &rays, occluded);
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            if (met[lane] > 1u || (met[lane] == 1u && occluded[lane] != 0u)) {
                return false;
            }
            any = any || met[lane] > 0u;
        }
    }
    return any;
}

/// in   frame, camera, BVH, lights; windows: of windowsOfLights
/// out  known: radiance of the lights that the pixel sees, colours in 47 bits, 1e-4 exact; 0: not known, or none
#include "pass/seenLights.h"
#ifdef PASS_seenLights
__kernel void seenLights(PARAMETERS)
{
    WEDGE_PIXEL(frame, x, y, i);
    STORE_known(frame.planeSize, i, vec3(0.0f, 0.0f, 0.0f));
    SeeingPixel from;
    from.camera = camera;
    from.width = (float)frame.width;
    from.height = (float)frame.height;
    from.x = (float)x + 0.5f;
    from.y = (float)y + 0.5f;
    // Of numbers that no primary sample has: what is concluded from them has no part in the samples' mean.
    from.seed = hashCombine(hashCombine(frame.seed, WEDGE_TRIED_SEED), y * frame.width + x);
    const float reach = reachOf(from, 0.0f);
    NearLights near;
    near.count = 0u;
    bool edge = false;
    for (uint k = 0u; k < lightCount; ++k) {
        __global const float* w = windows + 6u * k;
        if (w[0] - from.x > reach || w[1] - from.y > reach || w[2] - from.x < -reach || w[3] - from.y < -reach) {
            continue;
        }
        if (w[4] == (float)WEDGE_SHARE_UNKNOWN || near.count == WEDGE_MOST_SEEN) {
            return;
        }
        const ImageQuad quad = partInImage(from, lights[k], vec2(-1.0f, -1.0f), vec2(1.0f, 1.0f), vec2(0.0f, 0.0f));
        const int where = squareInQuad(quad, reachOf(from, w[5]));
        if (where >= 0) {
            near.index[near.count] = k;
            near.area[near.count] = seenArea(from, lights[k], w[5]);
            ++near.count;
            edge = edge || where == 0 || lights[k].profile != WEDGE_PROFILE_UNIFORM;
        }
    }
    // Inside a uniform light all samples see the same.
    if (!edge || !seesLights(from, nodes, blocks, lights, lightCount, &near)) {
        return;
    }
    Vec3 radiance = vec3(0.0f, 0.0f, 0.0f);
    for (uint k = 0u; k < near.count; ++k) {
        const AreaLight light = lights[near.index[k]];
        if (light.twoSided != 0u || vecDot(light.normal, vecSub(camera.eye, light.centre)) > 0.0f) {
            const uint share = (uint)windows[6u * near.index[k] + 4u];
            radiance = vecMad(radiance, light.radiance, shareOfLight(from, light, share, near.area[k]));
        }
    }
    STORE_known(frame.planeSize, i, radiance);
}
#endif
