// The sink of components, 7 along each axis of a light.
#define WEDGE_COMPONENTS 7
#include "light/components.h"
