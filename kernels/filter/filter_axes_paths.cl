// The same, and the variance of pixels' samples.
#define WEDGE_GATHER_MEAN_SQUARE
#include "filter/filter_paths.cl"
