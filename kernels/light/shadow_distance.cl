// Hard shadows in a style: how far pixels are from the shadow's edges, and that smoothed. docs/stylized-shadows.md
#include "core/formats.h"
#include "core/vector16.h"
#include "light/near_edges.h"
#include "light/style_knob.h"
#include "light/unmapped_normals.h"
#include "shared/filter_params.h"

/// How far pixels are from the shadow's edge: the power mean of thesis (3.2) for p = 8, but of the distances to a
/// straight edge, so that it is a distance: D = (Phi / K)^(-1/7), Phi the sum of len r^-8. Edges count within so many
/// times the distance of the nearest one, or of the largest that is told apart. As published all of them count, and the
/// mean is over their length: D = (Phi / length)^(-1/8).
///
/// How far away what hides the light is, is known in shadow alone, and changes at once at its edge. Knobs go by the
/// mean over edges, sum of a len r^-8 over that sum, a being that of an edge. As far from all edges as what is told
/// apart it goes over into a pixel's own, within as much again.
///
/// Where styles tell less apart than light of several levels has to, that mean is of pixels near to edges alone. As far
/// from all edges as `meanWithin` it goes over into the distance to the nearest one, within as much again.
///
/// in      p, position, normal, matte, occluder; edges, boxes, listed[0], most: how many edges, room: for boxes;
///         published: 1 or 0; largest, farthest: metres, that are told apart of distances and of what hides the
///         light, above 0; meanWithin: metres, above 0
/// in out  distance: metres, below 0 in shadow, 0 where the matte is unknown or nobody came to; away: metres, of what
///         hides the light
#include "pass/shadowDistance.h"
#ifdef PASS_shadowDistance
__kernel void shadowDistance(PARAMETERS)
{
    // A frame may be stopped between some blocks and the next, whose order is that of rows.
    const uint left = p.x0 & ~15u, across = max((p.x1 - left + 15u) / 16u, 1u);
    const ulong item = (ulong)firstGroup * get_local_size(0) + get_global_id(0);
    const uint x = left + (uint)(item % across) * 16u, y = p.y0 + (uint)(item / across);
    if (y >= p.y1) {
        return;
    }
    const int i = (int)pixelIndex(x, y, p.stride);
    EdgeBlock b;
    const float16 v = LOAD16_matte(p.planeSize, i);
    b.known = v >= 0.0f;
    if (!any(b.known)) {
        vstore16((float16)(0.0f), 0, distance + i);
#if HAS_away
        vstore16((float16)(0.0f), 0, away + i);
#endif
        return;
    }
    b.at = loadVecBlock(position, p.planeSize, i);
    b.n = loadVecBlock(WEDGE_UNMAPPED(p.planeSize), p.planeSize, i);
    b.edges = edges;
    b.boxes = boxes;
    b.count = min(listed[0], most);
    b.room = room;
    boundBlock(&b);
    float16 d = (float16)(largest), far = (float16)(0.0f);
    EdgeSums sums;
    const float perAway = HAS_away ? 1.0f / farthest : 0.0f;
    if (published != 0u) {
        const float16 perUnit = perUnitOf(nearestSquare(&b, 3e38f));
        sums = edgeSums(&b, perUnit, (float16)(3e38f), perAway);
        const float16 mean = sums.weights / max16(edgeLength(&b, perUnit), (float16)(1e-30f));
        d = min16(exp2Block(log2Block(mean) * (-1.0f / 8.0f)) / perUnit, d);
    } else {
        // An edge all around is nearer in the mean than at its nearest, but not by half.
        const float square = largest * largest, beyond = 4.0f * square;
        const float16 nearest = nearestSquare(&b, beyond);
        const int16 near = b.known & (nearest < beyond);
        const float16 reach = WEDGE_EDGE_REACH * WEDGE_EDGE_REACH * min16(nearest, (float16)(square));
        const float16 perUnit = perUnitOf(nearest), metres = sqrt(max16(nearest, (float16)(0.0f)));
        const float16 beyondMean = min16(metres * (1.0f / meanWithin) - 1.0f, (float16)(1.0f));
        sums = edgeSums(&b, perUnit, (near & (beyondMean < 1.0f)) ? reach : (float16)(-1.0f), perAway);
        const float16 power = log2Block(sums.weights * (1.0f / WEDGE_EDGE_CONSTANT)) * (-1.0f / 7.0f);
        const float16 mean = min16(exp2Block(power) / perUnit, d), other = min16(metres, d);
        d = near ? (beyondMean > 0.0f ? mean + (other - mean) * beyondMean : mean) : d;
        far = metres * (1.0f / largest) - 1.0f;
    }
    vstore16(b.known ? (v > 0.5f ? d : -d) : (float16)(0.0f), 0, distance + i);
#if HAS_away
    const float16 own = LOAD16_occluder(p.planeSize, i), t = min16(max16(far, (float16)(0.0f)), (float16)(1.0f));
    const float16 mean = sums.weights > 0.0f ? sums.away / sums.weights * farthest : own;
    const float16 inside = mean + (own - mean) * (t * t * (3.0f - 2.0f * t));
    vstore16(b.known ? (v > 0.5f ? mean : inside) : (float16)(0.0f), 0, away + i);
#else
    (void)farthest;
    (void)far;
#endif
}
#endif

/// Sums of a blur.
typedef struct {
    float16 values, weights;
} SmoothSums;

/// A block of pixels, and planes that its neighbours are in.
typedef struct {
    Vec3x16 at, n;
    uint16 object;
    float16 perSize; ///< 1 over the side of what a pixel sees, metres
    float16 perSquare; ///< 1/m^2: weights are 2^(-perSquare r^2)
    float16 square; ///< m^2, as far as which neighbours count
    __global const float *position, *normal, *pixelSize, *distance;
    __global const uint* objectId;
    uint size;
} SmoothBlock;

/// Adds the neighbours at j to the lanes of `mine`: those on the same object whose normals are within 45 degrees, each
/// for what it sees of the surface.
WEDGE_INLINE void addNeighbours(const SmoothBlock* b, int16 mine, int j, SmoothSums* sums)
{
    const Vec3x16 d = sub16(loadVecBlock(b->position, b->size, j), b->at);
    const float16 square = dot16(d, d), facing = dot16(b->n, loadVecBlock(b->normal, b->size, j));
    const float16 value = loadBlock(b->distance, j), side = loadBlock(b->pixelSize, j) * b->perSize;
    const int16 counts = mine & (loadIdBlock(b->objectId, j) == b->object) & (facing > WEDGE_SURFACE_COSINE)
        & (square <= b->square) & (value != 0.0f);
    const float16 weight = exp2Block(square * -b->perSquare) * side * side;
    sums->weights += counts ? weight : (float16)(0.0f);
    sums->values += counts ? weight * value : (float16)(0.0f);
}

/// Whole pixels that `reach` metres of a surface span along an image step: the shadow of a disk of that normal.
/// Surfaces bend, so it is a quarter more, up to that of a disk that faces the camera.
WEDGE_INLINE float16 pixelsAlong(FrameParams frame, Vec3x16 n, Vec3 step, float16 depth, float16 reach)
{
    const float length = vecLength(step);
    const float16 along = dot16(n, splat3(step)) / length, away = dot16(n, splat3(frame.forward));
    const float16 side = min16(1.25f * sqrt(max16(1.0f - along * along, (float16)(0.0f))), (float16)(1.0f));
    // The nearer end of it is larger.
    const float16 least = depth - reach * sqrt(max16(1.0f - away * away, (float16)(0.0f)));
    const float16 pixels = reach * side / (length * max16(least, 0.2f * depth));
    return floor(min16(pixels, (float16)((float)max(frame.width, frame.height))));
}

/// The power of 2 that a stride along so many pixels has, so that there are few taps.
WEDGE_INLINE float16 strideOf(float16 pixels)
{
    float16 power = (float16)(0.0f);
    for (float most = WEDGE_STYLE_TAPS; most < 65536.0f; most *= 2.0f) {
        power += pixels > most ? (float16)(1.0f) : (float16)(0.0f);
    }
    return power;
}

/// Distances, smoothed along surfaces by a Gaussian. Wide ones take every second, fourth ... neighbour along either
/// axis: each pixel by its own width, so that nobody's depends on who is beside it. The largest distances stay: nothing
/// that is told apart is near.
///
/// in   frame, surfaces; distance, away: of shadowDistance(); deviation: metres, by what is away; largest: metres
/// out  smoothed: metres, 0 where the distance is
#include "pass/smoothDistance.h"
#ifdef PASS_smoothDistance
__kernel void smoothDistance(PARAMETERS)
{
    WEDGE_PIXEL(frame, x, y, i);
    SmoothBlock b;
    b.size = frame.planeSize;
    b.position = position;
    b.normal = WEDGE_UNMAPPED(frame.planeSize);
    b.pixelSize = pixelSize;
    b.distance = distance;
    b.objectId = objectId;
    b.at = loadVecBlock(position, b.size, i);
    b.n = loadVecBlock(b.normal, b.size, i);
    b.object = loadIdBlock(objectId, i);
    b.perSize = 1.0f / max16(loadBlock(pixelSize, i), (float16)(1e-30f));
#if HAS_away
    const float16 sigma = knobsAt(deviation, LOAD16_away(b.size, i));
#else
    const float16 sigma = (float16)(deviation.base);
#endif
    b.perSquare = 0.72134752f / max16(sigma * sigma, (float16)(1e-30f));
    const float16 reach = WEDGE_STYLE_CUT * sigma;
    b.square = reach * reach;
    const float16 depth = max16(dot16(sub16(b.at, splat3(frame.eye)), splat3(frame.forward)), (float16)(1e-20f));
    const float16 across = pixelsAlong(frame, b.n, frame.right, depth, reach);
    const float16 down = pixelsAlong(frame, b.n, frame.down, depth, reach);
    const float16 kind = strideOf(across) + 32.0f * strideOf(down);
    float16 out = loadBlock(distance, i);
    int16 left = (out != 0.0f) & (fabs(out) < largest) & (sigma > 0.0f);
    while (any(left)) {
        const float first = largestOf(left ? kind : (float16)(-1.0f));
        const int16 mine = left & (kind == first);
        const int stepX = 1 << ((int)first % 32), stepY = 1 << ((int)first / 32);
        const int tapsX = (int)largestOf(mine ? across : (float16)(0.0f)) / stepX;
        const int tapsY = (int)largestOf(mine ? down : (float16)(0.0f)) / stepY;
        SmoothSums sums;
        sums.values = sums.weights = (float16)(0.0f);
        for (int v = -tapsY; v <= tapsY; ++v) {
            const int16 inRow = mine & (down >= fabs((float)(v * stepY)));
            for (int u = -tapsX; u <= tapsX; ++u) {
                const int row = (int)y + v * stepY, column = (int)x + u * stepX;
                if (row >= 0 && row < (int)frame.height && column > -16 && column < (int)frame.width) {
                    const int16 inReach = inRow & (across >= fabs((float)(u * stepX)));
                    addNeighbours(&b, inReach, i + v * stepY * (int)frame.stride + u * stepX, &sums);
                }
            }
        }
        out = mine ? sums.values / max16(sums.weights, (float16)(1e-30f)) : out;
        left = left & ~mine;
    }
    vstore16(out, 0, smoothed + i);
}
#endif
