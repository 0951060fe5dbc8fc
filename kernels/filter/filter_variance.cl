// Filters of one plane in distributed frames: visibilities of lights; and of variances, for what the filter gathers.
#define WEDGE_GATHER_CHANNELS 1
#include "filter/gather_lines.h"
