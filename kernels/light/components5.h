// The sink of components, 5 along each axis of a light.
#define WEDGE_COMPONENTS 5
#include "light/components.h"
