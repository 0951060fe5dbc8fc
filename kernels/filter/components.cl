// Multiple axis-aligned filters (Wu et al. 2017): the sums of light/components.h over a pixel's neighbours, in one
// pass, with weights by how far these are along both of the light's axes,
//
//     h = sum over neighbours j and products (i, k) of c_i(d_u) c_k(d_v) S_ik(j) / the same of T_ik(j) (21)
//
// S the sums of what is seen, T those of all samples: so what is the same everywhere stays so, whatever the samples and
// whichever neighbours are left out. d: their offset (gather.h's offset16()) in the light's standard deviations; d > 0
// is where y is. Of the component p of slopes s_min to s_max, with the centre C_x and the extent sigma_x of (7), (8):
//
//     c_0 = mu_0 g_0,  c_(2p-1) = 2 mu_p cos(C_x d) g_p,  c_2p = -2 mu'_p sin(C_x d) g_p,
//     g_p = sigma_x exp(-(sigma_x d)^2 / 2)
//
// Weights mu are those of (10), or from a table (refitted_weights.h), then of sines apart.
#include "filter/gather.h"
#include "shared/components.h"
#if WEDGE_COMPONENTS > 1
#include "filter/refitted_weights.h"
#endif

#define WEDGE_PRODUCTS (WEDGE_COMPONENTS * WEDGE_COMPONENTS)
#define WEDGE_PAIRS ((WEDGE_COMPONENTS + 1) / 2)
#ifdef WEDGE_SPECULAR
#define WEDGE_COMPONENT_CHANNELS 2u
#else
#define WEDGE_COMPONENT_CHANNELS 1u
#endif
/// Where weights of neighbours cancel to less than this share of what they are without their signs, nothing is known.
#define WEDGE_LEAST_SHARE 0.05f
/// How far above the least that filterWidth() has for any slope widths are by slopes of their own: more than what 16
/// bits round.
#define WEDGE_ABOVE_FLOOR 1.05f

/// The components of sixteen pixels along an axis of the light, whose standard deviation is 1.
typedef struct {
    float16 centre[WEDGE_PAIRS], extent[WEDGE_PAIRS]; ///< over d, (7), (8)
    float16 cosine[WEDGE_PAIRS], sine[WEDGE_PAIRS]; ///< factors of c
    float16 reach; ///< largest standard deviation over d
} ComponentBank;

/// (7) and (8); at p = 0 (8) is that of one axis-aligned filter, as the paper's text has it.
WEDGE_INLINE void placeComponents(float bandwidth, float16 sMin, float16 sMax, ComponentBank* bank)
{
    const float count = (float)WEDGE_COMPONENTS;
    bank->reach = (float16)(0.0f);
    for (uint p = 0u; p < WEDGE_PAIRS; ++p) {
        const float16 inner = (2.0f * (float)p - 1.0f) / (count * sMax),
                      outer = (2.0f * (float)p + 1.0f) / (count * sMin);
        bank->centre[p] = p > 0u ? 0.5f * bandwidth * (inner + outer) : (float16)(0.0f);
        bank->extent[p] = p > 0u ? 0.5f * bandwidth * (outer - inner) : bandwidth / (count * sMin);
        bank->reach = max16(bank->reach, 1.0f / bank->extent[p]);
    }
}

/// (10): weights of cosines and of sines alike.
WEDGE_INLINE void weighAsPrinted(float bandwidth, float16 sMin, ComponentBank* bank)
{
    for (uint p = 0u; p < WEDGE_PAIRS; ++p) {
        const float16 x = bank->centre[p] * sMin / bandwidth;
        const float y = 2.0f * (float)p / (float)WEDGE_COMPONENTS;
        bank->cosine[p] = bank->sine[p] = exp2Block(-WEDGE_HALF_LOG2E * (x * x + y * y));
    }
}

/// From the table, linear in the logarithm of s_max / s_min.
WEDGE_INLINE void weighAsRefitted(float16 ratio, ComponentBank* bank)
{
#if WEDGE_COMPONENTS > 1
    float at[16], cosine[WEDGE_PAIRS][16], sine[WEDGE_PAIRS][16];
    vstore16(4.0f * log2Block(ratio), 0, at);
    for (uint lane = 0u; lane < 16u; ++lane) {
        const float row = clamp(at[lane], 0.0f, (float)(WEDGE_REFITTED_ROWS - 1));
        const uint below = min((uint)row, (uint)(WEDGE_REFITTED_ROWS - 2));
        const float share = row - (float)below;
        for (uint p = 0u; p < WEDGE_PAIRS; ++p) {
            const uint c = p > 0u ? 2u * p - 1u : 0u, s = 2u * p;
            cosine[p][lane] = mix(refittedWeights[below][c], refittedWeights[below + 1u][c], share);
            sine[p][lane] = mix(refittedWeights[below][s], refittedWeights[below + 1u][s], share);
        }
    }
    for (uint p = 0u; p < WEDGE_PAIRS; ++p) {
        bank->cosine[p] = vload16(0, cosine[p]);
        bank->sine[p] = vload16(0, sine[p]);
    }
#else
    (void)ratio;
    bank->cosine[0] = (float16)(1.0f);
#endif
}

WEDGE_INLINE ComponentBank bankOf(float bandwidth, uint refitted, float16 sMin, float16 ratio)
{
    ComponentBank bank;
    placeComponents(bandwidth, sMin, sMin * ratio, &bank);
    if (refitted != 0u) {
        weighAsRefitted(ratio, &bank);
    } else {
        weighAsPrinted(bandwidth, sMin, &bank);
    }
    for (uint p = 0u; p < WEDGE_PAIRS; ++p) {
        bank.cosine[p] *= (p > 0u ? 2.0f : 1.0f) * bank.extent[p];
        bank.sine[p] *= -2.0f * bank.extent[p];
    }
    return bank;
}

/// sinCosTurn() of sixteen, at any turn.
WEDGE_INLINE void sinCosTurn16(float16 turn, float16* sine, float16* cosine)
{
    const float16 nearest = floor(4.0f * turn + 0.5f);
    const int16 quarter = convert_int16(nearest);
    const float16 x = 6.28318531f * (turn - 0.25f * nearest);
    const float16 q = x * x;
    const float16 s = x * (1.0f - q * (0.166666667f - q * (0.00833333333f - q * 0.000198412698f)));
    const float16 c = 1.0f - q * (0.5f - q * (0.0416666667f - q * (0.00138888889f - q * 0.0000248015873f)));
    const float16 a = (quarter & 1) != 0 ? c : s;
    const float16 b = (quarter & 1) != 0 ? s : c;
    *sine = (quarter & 2) != 0 ? -a : a;
    *cosine = ((quarter + 1) & 2) != 0 ? -b : b;
}

/// c of every component at d.
WEDGE_INLINE void coefficientsAt(const ComponentBank* bank, float16 d, float16* c)
{
    for (uint p = 0u; p < WEDGE_PAIRS; ++p) {
        const float16 x = bank->extent[p] * d;
        const float16 g = exp2Block(-WEDGE_HALF_LOG2E * x * x);
        if (p == 0u) {
            c[0] = bank->cosine[0] * g;
        } else {
            float16 sine, cosine;
            sinCosTurn16(0.159154943f * bank->centre[p] * d, &sine, &cosine);
            c[2u * p - 1u] = bank->cosine[p] * cosine * g;
            c[2u * p] = bank->sine[p] * sine * g;
        }
    }
}

/// What the pass reads.
typedef struct {
    __global const float *value, *beta, *slopeWidth, *ratio, *position, *normal, *pixelSize, *sums, *components;
    __global const uint* objectId;
} ComponentPlanes;

/// Over neighbours, of each channel: what is seen, all, and all without signs.
typedef struct {
    float16 seen[WEDGE_COMPONENT_CHANNELS], all[WEDGE_COMPONENT_CHANNELS], size[WEDGE_COMPONENT_CHANNELS];
    float16 squared; ///< of all, of the first channel
    float16 part[WEDGE_PAIRS * WEDGE_PAIRS]; ///< of what is seen in the first channel, by pairs along u and v
} ComponentSum;

/// The pair of components p and -p that basis function i is of.
WEDGE_INLINE uint pairOf(uint i) { return (i + 1u) / 2u; }

/// Adds the neighbours at element j. width: metres, of the pixels' own filters by their slopes
WEDGE_INLINE void addNeighbours(FilterParams p, LightAxes light, GatherBlock b, const ComponentBank* bank,
    float16 width, ComponentPlanes in, int j, ComponentSum* sum)
{
    const float16 betaThere = loadBlock(in.beta, j);
    const Neighbours n = neighboursAt(p, b, j, betaThere, in.position, in.normal, in.pixelSize, in.objectId);
    float16 u = n.offset.x * light.alongU.x + n.offset.y * light.alongU.y + n.offset.z * light.alongU.z;
    float16 v = n.offset.x * light.alongV.x + n.offset.y * light.alongV.y + n.offset.z * light.alongV.z;
    if (p.narrower != 0u) {
        // As if the pair had the slopes of the one that has the lesser: then the bank is the same, but narrower. A
        // pixel without slopes (beta 0) does not narrow its neighbours'.
        const float16 there = loadShortBlock(in.slopeWidth, j);
        const int16 narrows = (betaThere > 0.0f) & (there > 0.0f) & (there < width);
        const float16 closer = narrows ? width / there : (float16)(1.0f);
        u *= closer;
        v *= closer;
    }
    const int16 taken = n.known & (u * u + v * v <= p.cut * p.cut * bank->reach * bank->reach);
    if (!any(taken)) {
        return;
    }
    float16 ofU[WEDGE_COMPONENTS], ofV[WEDGE_COMPONENTS];
    coefficientsAt(bank, u, ofU);
    coefficientsAt(bank, v, ofV);
    for (uint channel = 0u; channel < WEDGE_COMPONENT_CHANNELS; ++channel) {
        const uint first = 2u * channel * WEDGE_PRODUCTS;
        float16 all = (float16)(0.0f), seen = (float16)(0.0f), part[WEDGE_PAIRS * WEDGE_PAIRS];
        for (uint pair = 0u; pair < WEDGE_PAIRS * WEDGE_PAIRS; ++pair) {
            part[pair] = (float16)(0.0f);
        }
        for (uint i = 0u; i < WEDGE_COMPONENTS; ++i) {
            for (uint k = 0u; k < WEDGE_COMPONENTS; ++k) {
                const float16 c = ofU[i] * ofV[k];
                const uint plane = first + i * WEDGE_COMPONENTS + k;
                all += c * loadShortsBlock(in.components, p.planeSize, j, plane);
                part[pairOf(i) * WEDGE_PAIRS + pairOf(k)] +=
                    c * loadShortsBlock(in.components, p.planeSize, j, plane + WEDGE_PRODUCTS);
            }
        }
        for (uint pair = 0u; pair < WEDGE_PAIRS * WEDGE_PAIRS; ++pair) {
            seen += part[pair];
        }
        // Pixels count for the surface that they see, and not for how much arrives there.
        const float16 weights = loadBlock(in.sums + 2u * channel * p.planeSize, j);
        const int16 counts = taken & (weights > 0.0f);
        const float16 perSample = n.area / (counts ? weights : (float16)(1.0f));
        const float16 a = counts ? perSample * all : (float16)(0.0f);
        sum->seen[channel] += counts ? perSample * seen : (float16)(0.0f);
        sum->all[channel] += a;
        sum->size[channel] += fabs(a);
        if (channel == 0u) {
            sum->squared += a * a;
            for (uint pair = 0u; pair < WEDGE_PAIRS * WEDGE_PAIRS; ++pair) {
                sum->part[pair] += counts ? perSample * part[pair] : (float16)(0.0f);
            }
        }
    }
}

/// in   value: what is filtered, beta: metres, 0 or less: nothing is gathered; slopeWidth: what beta is by slopes
///      alone, and ratio: s_max / s_min, both of 16 bits; sums (light_sampling.h), components (light/components.h), and
///      the gather's planes. slopesPerWidth: s_min over slopeWidth, 1/m. floorPerPixel: the least that slopes come out
///      as, over (1 + s) and the pixel's metres. refitted: 1, or 0 for weights as printed
/// out  filtered; effective: the number of equal pixels that the weights amount to; parts, where they are shown: of
///      the first channel, before it is bounded, what each pair of components along u and v has of it (v running
///      fastest), all of it of the pair 0, 0 where nothing is gathered
#include "pass/filterComponents.h"
#ifdef PASS_filterComponents
__kernel void filterComponents(PARAMETERS)
{
    WEDGE_PIXEL(p, x, y, i);
    const ComponentPlanes in = { value, beta, slopeWidth, ratio, position, normal, pixelSize, sums, components,
        objectId };
    const uint16 object = loadIdBlock(objectId, i);
    const float16 width = loadShortBlock(slopeWidth, i);
    // Where a standard deviation of the light is less than a pixel in shadows, widths are those of pixels and tell no
    // slope (filterWidth()), and there is next to nothing to gather.
    const float perMetre = sqrt(fmin(vecDot(light.alongU, light.alongU), vecDot(light.alongV, light.alongV)));
    const float16 slope = width * slopesPerWidth;
    const int16 wide = slope > WEDGE_ABOVE_FLOOR * floorPerPixel * (1.0f + slope) * loadSizeBlock(pixelSize, i);
    const int16 gathers = (loadBlock(beta, i) > 0.0f) & wide & (object != 0u);
    ComponentSum sum;
    for (uint channel = 0u; channel < WEDGE_COMPONENT_CHANNELS; ++channel) {
        sum.seen[channel] = sum.all[channel] = sum.size[channel] = (float16)(0.0f);
    }
    sum.squared = (float16)(0.0f);
    for (uint pair = 0u; pair < WEDGE_PAIRS * WEDGE_PAIRS; ++pair) {
        sum.part[pair] = (float16)(0.0f);
    }
    if (any(gathers)) {
        const GatherBlock b = gatherBlock(p, i, object, position, normal, pixelSize);
        const float16 sMin = gathers ? slope : (float16)(1.0f);
        const ComponentBank bank =
            bankOf(light.bandwidth, refitted, sMin, gathers ? loadShortBlock(ratio, i) : (float16)(1.0f));
        const float16 reach = p.cut / perMetre * bank.reach;
        const int across = (int)largestOf(gathers ? radiusInPixels(p, b, p.right, reach) : (float16)(0.0f));
        const int down = (int)largestOf(gathers ? radiusInPixels(p, b, p.down, reach) : (float16)(0.0f));
        const int first = max(-down, -(int)y), last = min(down, (int)(p.height - 1u - y));
        for (int dy = first; dy <= last; ++dy) {
            for (int dx = -across; dx <= across; ++dx) {
                addNeighbours(p, light, b, &bank, width, in, i + dy * (int)p.stride + dx, &sum);
            }
        }
    }
    for (uint channel = 0u; channel < WEDGE_COMPONENT_CHANNELS; ++channel) {
        const float16 own = loadBlock(value + channel * p.planeSize, i);
        const int16 known = gathers & (sum.all[channel] > WEDGE_LEAST_SHARE * sum.size[channel]);
        const float16 mean = sum.seen[channel] / (known ? sum.all[channel] : (float16)(1.0f));
        const float16 bounded = min16(max16(mean, (float16)(0.0f)), (float16)(p.most));
        vstore16(known ? bounded : own, 0, filtered + channel * p.planeSize + i);
    }
    const float16 count = sum.all[0] * sum.all[0] / max16(sum.squared, (float16)(1e-30f));
    const int16 known = gathers & (sum.all[0] > WEDGE_LEAST_SHARE * sum.size[0]);
    vstore16(known ? count : (float16)(1.0f), 0, effective + i);
#if HAS_parts
    for (uint pair = 0u; pair < WEDGE_PAIRS * WEDGE_PAIRS; ++pair) {
        const float16 unfiltered = pair == 0u ? loadBlock(value, i) : (float16)(0.0f);
        const float16 all = known ? sum.all[0] : (float16)(1.0f);
        vstore16(known ? sum.part[pair] / all : unfiltered, 0, parts + pair * p.planeSize + i);
    }
#endif
}
#endif
