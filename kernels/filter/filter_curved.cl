// The filter of one light's term (filter.cl) that follows gradients and second derivatives.
#define WEDGE_GATHER_SHEARED
#define WEDGE_GATHER_CURVED
#include "filter/filter.cl"
