// The filter of 5 components along each axis of a light.
#define WEDGE_COMPONENTS 5
#include "filter/components.h"
