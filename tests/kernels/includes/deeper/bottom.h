// No guard of its own: the flattener brings each file in once.
#include "beside.h"
int bottom(void) { return BESIDE; }
