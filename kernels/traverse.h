// What kernels trace rays with: closestHit and anyHit over nodes of type TraversalNode.
#ifndef WEDGE_TRAVERSE_H
#define WEDGE_TRAVERSE_H

#include "traverse_wide.h"

#endif
