// What becomes of the samples of area_light.cl where it is compiled alone: the sinks of the first pass over pixels. In
// a frame each pass has a text of its own in the place of this file, generated from what the pass declares
// (host/graph/interface.h).
#include "light/slopes.h"
#include "sinks/means.h"
#include "sinks/parts.h"
#include "sinks/sums.h"

#define WEDGE_SINK_PARAMETERS                                                                                          \
    __global float* restrict sums, __global float* restrict value, __global float* restrict parts,                     \
        __global float* restrict slopes
#define WEDGE_SINK_ARGUMENTS sums, value, parts, slopes
typedef struct {
    Sums ofSums;
    Parts ofParts;
    Slopes ofSlopes;
} Sink;
WEDGE_INLINE void beginReceivers(const Sampling* at, Sink* sink, WEDGE_SINK_PARAMETERS)
{
    (void)sink;
    (void)sums;
    (void)value;
    (void)parts;
    (void)slopes;
    beginSums(at, &sink->ofSums, sums);
    beginParts(at, &sink->ofParts, sums);
    beginSlopes(at, &sink->ofSlopes, slopes);
}
WEDGE_INLINE void takeSamples(const Sampling* at, const Samples* s, Sink* sink, WEDGE_SINK_PARAMETERS)
{
    (void)sink;
    (void)sums;
    (void)value;
    (void)parts;
    (void)slopes;
    takeSums(at, s, &sink->ofSums);
    takeParts(at, s, &sink->ofParts);
    takeSlopes(at, s, &sink->ofSlopes);
}
WEDGE_INLINE void finishReceivers(const Sampling* at, Sink* sink, WEDGE_SINK_PARAMETERS)
{
    (void)sink;
    (void)sums;
    (void)value;
    (void)parts;
    (void)slopes;
    finishSums(at, &sink->ofSums, sums);
    finishMeans(at, sums, value);
    finishParts(at, &sink->ofParts, parts);
    finishSlopes(at, &sink->ofSlopes, slopes);
}
