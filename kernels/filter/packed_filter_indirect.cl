// The filter of indirect light in packed frames.
#define WEDGE_GATHER_PACKED
#define WEDGE_GATHER_VALUE_ONLY
#include "filter/filter_indirect.cl"
