// The filter of indirect light: red, green and blue.
#define WEDGE_GATHER_CHANNELS 3
#include "filter/gather_lines.h"
