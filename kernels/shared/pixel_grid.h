// The pixels of planes of one scale, the frame's or a coarser one, as the kernels see them.
#ifndef WEDGE_SHARED_PIXEL_GRID_H
#define WEDGE_SHARED_PIXEL_GRID_H

#include "compat.h"

WEDGE_SHARED_BEGIN

/// Pixel (x, y) lies over the frame's pixels from (scale * x, scale * y), scale of them each way; at the right and
/// lower edges over those that there are.
typedef struct {
    uint scale; ///< pixels of the frame along each side of one
    uint width, height; ///< pixels
    uint stride; ///< elements from one row of a plane to the next, for pixelIndex()
    uint size; ///< elements of a plane
    uint x0, y0, x1, y1; ///< the rectangle that the pass covers, half open, in pixels of the pass's scale
} PixelGrid;

WEDGE_SHARED_END

#endif
