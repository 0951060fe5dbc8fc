// line 1
#include "absent.h"
