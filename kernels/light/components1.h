// The sink of components, 1 along each axis of a light.
#define WEDGE_COMPONENTS 1
#include "light/components.h"
