// The indirect filter of one plane, the samples' variance, for what the filter gathers and how uncertain that is.
#define WEDGE_GATHER_CHANNELS 1
#include "gather.h"
