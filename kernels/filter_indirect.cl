// The filter of indirect light: red, green and blue.
#define WEDGE_GATHER_CHANNELS 3
#include "gather_lines.h"
