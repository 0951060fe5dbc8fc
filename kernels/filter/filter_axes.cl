// The filter of environment light with widths along both axes (docs/environment.md): red, green and blue.
#define WEDGE_GATHER_MEAN_SQUARE
#include "filter/filter_indirect.cl"
