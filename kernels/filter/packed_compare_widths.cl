// Two widths compared in packed frames.
#define WEDGE_GATHER_PACKED
#include "filter/compare_widths.cl"
