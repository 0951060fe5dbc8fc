// The bodies of glass that a path is inside of, in the order in which it entered them. Where it is in several, its
// medium is the one of the highest priority, and of those the one that it entered last.
#ifndef WEDGE_MEDIA_H
#define WEDGE_MEDIA_H

#include "shared/material.h"

/// Bodies, by MaterialData::medium, from the outermost; bodies of one material are as many entries.
typedef struct {
    uint count;
    uint body[WEDGE_MOST_MEDIA];
} Media;

#define WEDGE_NO_MEDIUM 0xffffffffu ///< outside of all
#define WEDGE_MATERIAL_OF(medium) ((medium)&WEDGE_MEDIUM_MATERIAL)

/// Puts a body at a place of the list. Of a full list the outermost is forgotten: who leaves it was inside.
WEDGE_FN void insertMedium(Media* m, uint place, uint body)
{
    if (m->count == WEDGE_MOST_MEDIA) {
        if (place == 0u) {
            return;
        }
        for (uint i = 1u; i < m->count; ++i) {
            m->body[i - 1u] = m->body[i];
        }
        --m->count;
        --place;
    }
    for (uint i = m->count; i > place; --i) {
        m->body[i] = m->body[i - 1u];
    }
    m->body[place] = body;
    ++m->count;
}

/// Takes out the innermost of these bodies; returns where it was, WEDGE_NO_MEDIUM: there is none.
WEDGE_FN uint removeMedium(Media* m, uint body)
{
    uint place = m->count;
    while (place > 0u && m->body[place - 1u] != body) {
        --place;
    }
    if (place == 0u) {
        return WEDGE_NO_MEDIUM;
    }
    for (uint i = place; i < m->count; ++i) {
        m->body[i - 1u] = m->body[i];
    }
    --m->count;
    return place - 1u;
}

/// Of what the path is in.
WEDGE_FN uint mediumOf(const Media* m)
{
    uint medium = WEDGE_NO_MEDIUM;
    for (uint i = m->count; i > 0u; --i) {
        const uint body = m->body[i - 1u];
        const bool above = medium == WEDGE_NO_MEDIUM
            || (body >> WEDGE_MEDIUM_PRIORITY_SHIFT) > (medium >> WEDGE_MEDIUM_PRIORITY_SHIFT);
        medium = above ? body : medium;
    }
    return medium;
}

/// How many of the first `count` entries are this body.
WEDGE_FN uint countMedium(const Media* m, uint count, uint body)
{
    uint found = 0u;
    for (uint i = 0u; i < count; ++i) {
        found += m->body[i] == body ? 1u : 0u;
    }
    return found;
}

WEDGE_FN float indexOf(__global const MaterialData* materials, uint medium)
{
    return medium == WEDGE_NO_MEDIUM ? 1.0f : materials[WEDGE_MATERIAL_OF(medium)].exponent;
}

/// A path's way through faces that lie in one another within rounding.
typedef struct {
    Media before, behind; ///< where it comes from, and where it is behind the faces so far
    uint entered; ///< of behind, the last so many were entered at these faces
} Crossing;

WEDGE_FN void beginCrossing(const Media* inside, Crossing* c)
{
    c->before = *inside;
    c->behind = *inside;
    c->entered = 0u;
}

/// Enters a body. Of those that are entered at one place the smaller one is the inner one.
WEDGE_FN void enterBody(__global const MaterialData* materials, uint body, Crossing* c)
{
    const uint rank = materials[WEDGE_MATERIAL_OF(body)].nesting;
    uint place = c->behind.count;
    const uint lowest = place - min(c->entered, place);
    while (place > lowest && materials[WEDGE_MATERIAL_OF(c->behind.body[place - 1u])].nesting > rank) {
        --place;
    }
    insertMedium(&c->behind, place, body);
    c->entered = min(c->entered + 1u, c->behind.count);
}

/// Leaves a body; where the path has not entered it, it began within it.
WEDGE_FN void leaveBody(uint body, Crossing* c)
{
    const uint place = removeMedium(&c->behind, body);
    if (place == WEDGE_NO_MEDIUM) {
        insertMedium(&c->before, 0u, body);
    } else if (place + c->entered > c->behind.count) {
        --c->entered;
    }
}

#endif
