// Two widths compared in packed frames.
#define WEDGE_GATHER_PACKED
#include "compare_widths.cl"
