// How many rays a work-item traces together.
#ifndef WEDGE_PACKET_SIZE_H
#define WEDGE_PACKET_SIZE_H

#include "shared/bvh_types.h"

#ifdef WEDGE_TRAVERSAL_SCALAR
#define WEDGE_PACKET_SIZE 1
#else
#define WEDGE_PACKET_SIZE WEDGE_WIDE_PACKET_SIZE
#endif

#endif
