// Equal samples that the filter gathers, in packed frames.
#define WEDGE_GATHER_PACKED
#include "filter/filter_counts.cl"
