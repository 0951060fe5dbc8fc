// Filters of images (kernels/filter/image.cl): how far they reach, of which windows follow.
#ifndef WEDGE_SHARED_IMAGE_FILTER_H
#define WEDGE_SHARED_IMAGE_FILTER_H

/// Gaussians end at this many standard deviations, rounded up to whole pixels.
#define WEDGE_IMAGE_CUT 3.0f
/// Largest radius of medians, pixels, and how many pixels there are in their square.
#define WEDGE_IMAGE_MEDIAN_RADIUS 3
#define WEDGE_IMAGE_MEDIAN_PIXELS 49

#endif
