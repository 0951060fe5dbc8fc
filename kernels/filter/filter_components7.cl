// The filter of 7 components along each axis of a light.
#define WEDGE_COMPONENTS 7
#include "filter/components.h"
