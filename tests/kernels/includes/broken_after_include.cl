#include "left.h"
// line 2
#include "left.h"
#include "right.h"
__kernel void unused(__global int* result) { result[0] = alsoUndeclared + TEST_VALUE; }
