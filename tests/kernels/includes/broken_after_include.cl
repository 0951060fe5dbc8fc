#include "left.h"
// line 2
#include "right.h"
#include "left.h"
__kernel void unused(__global int* result) { result[0] = alsoUndeclared; }
