// The filter of one light's term; planes of value: diffuse, and with specular surfaces the specular one.
#ifdef WEDGE_SPECULAR
#define WEDGE_GATHER_CHANNELS 2
#else
#define WEDGE_GATHER_CHANNELS 1
#endif
#include "filter/gather_lines.h"
