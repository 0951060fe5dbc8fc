// Floats as whole numbers of the same order.
#ifndef WEDGE_FLOAT_ORDER_H
#define WEDGE_FLOAT_ORDER_H

#include "shared/compat.h"

/// Numbers that have the order of finite floats, from the least below 0 on; and back.
WEDGE_FN uint orderOf(float value)
{
    const uint bits = as_uint(value);
    return (bits >> 31) != 0u ? ~bits : bits | 0x80000000u;
}

WEDGE_FN float valueAt(uint order) { return as_float((order >> 31) != 0u ? order & 0x7fffffffu : ~order); }

#endif
