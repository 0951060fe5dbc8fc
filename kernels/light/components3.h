// The sink of components, 3 along each axis of a light.
#define WEDGE_COMPONENTS 3
#include "light/components.h"
