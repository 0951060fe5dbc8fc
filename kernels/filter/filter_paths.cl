// The filter of indirect light and of the variance of pixels' samples of it (fallback.cl): red, green, blue, variance.
#define WEDGE_GATHER_CHANNELS 4
#include "filter/gather_lines.h"
