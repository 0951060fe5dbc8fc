// Filters of stored samples (kernels/filter/path_density.cl): of how far they look, and what else windows and memory
// follow from.
#ifndef WEDGE_SHARED_SAMPLE_FILTER_H
#define WEDGE_SHARED_SAMPLE_FILTER_H

/// Two samples are no farther apart than this, pixels: nothing beyond it is looked at.
#define WEDGE_SAMPLE_REACH 4
/// Differences of CIELAB that count as much as one pixel.
#define WEDGE_LAB_PIXEL 20.0f
/// What exposed RGB is multiplied by where it is compared in place of CIELAB, pixels: so white is as far from black as
/// there, 100 / WEDGE_LAB_PIXEL, by a Euclidean norm of three equal numbers.
#define WEDGE_RGB_PIXELS 2.88675135f
/// Nearest samples that a sample is compared with, at most.
#define WEDGE_MOST_NEAREST 256
/// Groups of samples whose means are compared, at most.
#define WEDGE_MOST_GROUPS 63
/// Bins of brightness into which samples fall where they are not stored one by one, and numbers of 16 bits of each.
#define WEDGE_SAMPLE_BINS 8
#define WEDGE_BIN_NUMBERS 5
/// Gaussians that spread what is left out end at this many standard deviations.
#define WEDGE_SPREAD_CUT 2.0f
/// Where their width grows with what is left out, it does until a pixel gets no more back than this share of the mean
/// around it.
#define WEDGE_SPREAD_SHARE 0.1f
/// Of the brightness that samples have before any filter: in each direction one pixel of so many is looked at, with so
/// many samples.
#define WEDGE_PROBE_STEP 4
#define WEDGE_PROBE_SAMPLES 16
/// Bins of their luminances: eight an octave, of all floats.
#define WEDGE_PROBE_BINS 2048
/// What the median luminance is shown as.
#define WEDGE_MIDDLE_GREY 0.18f

#endif
