// The sink of stored.h, of what points on lights bring without reflected directions.
#define WEDGE_STORED points
#include "sinks/stored.h"
