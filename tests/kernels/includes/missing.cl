// line 1
// line 2
#include "deeper/incomplete.h"
