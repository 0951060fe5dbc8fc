#include "broken.h"
#include "left.h"
__kernel void unused(__global int* result) { result[0] = broken() + TEST_VALUE; }
