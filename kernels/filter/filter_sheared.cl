// The filter of one light's term (filter.cl) that follows gradients.
#define WEDGE_GATHER_SHEARED
#include "filter/filter.cl"
