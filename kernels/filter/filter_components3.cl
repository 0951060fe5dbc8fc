// The filter of 3 components along each axis of a light.
#define WEDGE_COMPONENTS 3
#include "filter/components.h"
