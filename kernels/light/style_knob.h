// Knobs of styles, by how far away what hides the light is.
#ifndef WEDGE_STYLE_KNOB_H
#define WEDGE_STYLE_KNOB_H

#include "core/vector16.h"
#include "shared/styled_shadows.h"

/// d: metres.
WEDGE_FN float knobAt(StyleKnob knob, float d)
{
    return clamp(knob.base + d * (knob.linear + d * knob.square), knob.least, knob.most);
}

WEDGE_FN float16 knobsAt(StyleKnob knob, float16 d)
{
    const float16 at = knob.base + d * (knob.linear + d * knob.square);
    return min16(max16(at, (float16)(knob.least)), (float16)(knob.most));
}

#endif
