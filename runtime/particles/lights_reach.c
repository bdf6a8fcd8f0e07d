/* lights_reach.c - see lights_reach.h.
 *
 * Where no particle was reflected, that is chance or it is so: a lamp may shine through a pinhole,
 * and a hot body alone in space shines on nothing. Planes tell the second: light goes from a face
 * to another only if each has a corner in front of the other's plane. Where much faces each other
 * the first pairs say so; of others no more than PAIRS are looked at.
 * SPDX-License-Identifier: MIT */
#include "particles/lights_reach.h"

#include "kernel/plane_side.h"

enum { PAIRS = 10000000 }; /* chosen, a tenth of a second */

/* of the radii: less is rounding, as where faces adjoin */
static const double ROUNDING = 1e-9;

static int is_in_front(const struct element *e, const struct element *plane)
{
    double low, high;
    plane_side_heights(e, plane, &low, &high);
    return high > ROUNDING * (e->radius + plane->radius);
}

int lights_reach(const struct tracer *t)
{
    uint32_t pairs = 0;
    for (uint32_t f = 0; f < t->hierarchy->face_count; f++) {
        if (!(tracer_reflectance(t, f) > 0))
            continue;
        const struct element *r = tracer_surface(t, f);
        for (uint32_t i = 0; i < t->lights.count; i++) {
            const struct element *s = tracer_surface(t, t->lights.face[i]);
            if (++pairs > PAIRS || (is_in_front(r, s) && is_in_front(s, r)))
                return 1;
        }
    }
    return 0;
}
