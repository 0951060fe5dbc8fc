#include "deeper/bottom.h"
#define LEFT 10
