// The filter of one plane in packed frames.
#define WEDGE_GATHER_PACKED
#include "filter/filter_variance.cl"
