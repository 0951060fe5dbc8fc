// The filter of 1 components along each axis of a light.
#define WEDGE_COMPONENTS 1
#include "filter/components.h"
