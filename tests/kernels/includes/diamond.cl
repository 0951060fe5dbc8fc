#include "left.h"
#include "right.h" // both include bottom.h
/* a comment may speak of
#include "nowhere.h"
without meaning it */
__kernel void diamond(__global int* result) { result[0] = bottom() + LEFT + RIGHT; }
