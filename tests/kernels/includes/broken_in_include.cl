#include "left.h"
#include "broken.h"
__kernel void unused(__global int* result) { result[0] = broken(); }
