#include "deeper/bottom.h"
#define RIGHT 100
