/* lights_reach.c - see lights_reach.h.
 *
 * Where no particle was reflected, that is chance or it is so: a lamp may shine through a pinhole,
 * and a hot body alone in space shines on nothing. Planes tell the second: light goes from a face
 * to another only if each has a corner in front of the other's plane. So do colours: of a red lamp
 * among faces that reflect green and blue nothing comes back. Where much faces each other
 * the first pairs say so; of others no more than PAIRS are looked at.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "engine/lights_reach.h"
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

static int emits(const struct problem *p, uint32_t face)
{
    int any = 0;
    for (uint32_t k = 0; k < p->bands; k++)
        any |= p->exitance[(size_t)face * p->bands + k] > 0;
    return any;
}

/* May this face reflect of that one's light? Not what is red, of a blue lamp's. */
static int answers(const struct problem *p, uint32_t face, uint32_t lamp)
{
    int any = 0;
    for (uint32_t k = 0; k < p->bands; k++)
        any |= p->reflectance[(size_t)face * p->bands + k] > 0
               && p->exitance[(size_t)lamp * p->bands + k] > 0;
    return any;
}

int lights_reach(const struct problem *p, const struct hierarchy *h)
{
    uint32_t *white = malloc(((size_t)h->face_count + 1) * sizeof *white), count = 0, pairs = 0;
    int reach = !white;
    for (uint32_t i = 0; i < h->face_count && white; i++)
        if (h->faces[i].light != FACE_DARK && p->whitest[i] > 0)
            white[count++] = i;
    for (uint32_t i = 0; i < h->face_count && count && !reach; i++) {
        const struct element *s = hierarchy_surface(h, i);
        if (!emits(p, i))
            continue;
        for (uint32_t j = 0; j < count && !reach; j++) {
            const struct element *r = hierarchy_surface(h, white[j]);
            reach = ++pairs > PAIRS
                    || (answers(p, white[j], i) && is_in_front(r, s) && is_in_front(s, r));
        }
    }
    free(white);
    return reach;
}
