// What becomes of the samples of indirect.cl where it is compiled alone: the sinks of the first paths over pixels. In
// a frame each pass has a text of its own in the place of this file, generated from what the pass declares
// (host/graph/interface.h).
#include "paths/distances.h"
#include "sinks/means.h"
#include "sinks/parts.h"
#include "sinks/sums.h"

#define WEDGE_SINK_PARAMETERS                                                                                          \
    __global float* restrict sums, __global float* restrict value, __global float* restrict parts,                     \
        __global float* restrict reflectors
#define WEDGE_SINK_ARGUMENTS sums, value, parts, reflectors
typedef struct {
    Sums ofSums;
    Parts ofParts;
    Distances ofDistances;
} Sink;
WEDGE_INLINE void beginReceivers(const Sampling* at, Sink* sink, WEDGE_SINK_PARAMETERS)
{
    (void)sink;
    (void)sums;
    (void)value;
    (void)parts;
    (void)reflectors;
    beginSums(at, &sink->ofSums, sums);
    beginParts(at, &sink->ofParts, sums);
    beginDistances(at, &sink->ofDistances, reflectors);
}
WEDGE_INLINE void takeSamples(const Sampling* at, const Samples* s, Sink* sink, WEDGE_SINK_PARAMETERS)
{
    (void)sink;
    (void)sums;
    (void)value;
    (void)parts;
    (void)reflectors;
    takeSums(at, s, &sink->ofSums);
    takeParts(at, s, &sink->ofParts);
    takeDistances(at, s, &sink->ofDistances);
}
WEDGE_INLINE void finishReceivers(const Sampling* at, Sink* sink, WEDGE_SINK_PARAMETERS)
{
    (void)sink;
    (void)sums;
    (void)value;
    (void)parts;
    (void)reflectors;
    finishSums(at, &sink->ofSums, sums);
    finishMeans(at, sums, value);
    finishParts(at, &sink->ofParts, parts);
    finishDistances(at, &sink->ofDistances, reflectors);
}
