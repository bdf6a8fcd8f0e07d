/* misfit.c - see misfit.h.
 *
 * Files round coordinates, each object's by themselves, to six digits or more: what touches then
 * does so nearly. Of an exact file little is left but the rounding of what is computed here. What
 * lies on what is known of groups, which are flat within h->flat, and of the feet of bodies;
 * corners are in one place as places.h has it. What is farther apart than six digits put it stands
 * off, as a sill does off a window in a scene of a whole street. A quad's bend is its own, however
 * large. Invariant: but for bends nothing counts above FARTHEST. [derived here]
 * SPDX-License-Identifier: MIT */
#include "hierarchy/misfit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hierarchy/places.h"
#include "hierarchy/reach.h"

/* of h->flat, which is 2e-6 of the scene's extent */
static const double FARTHEST = 0.5;

static double larger(const struct hierarchy *h, double most, double apart)
{
    return apart <= FARTHEST * h->flat ? fmax(most, apart) : most;
}

/* Of bent quads and of flat groups. */
static double of_planes(const struct hierarchy *h)
{
    double most = 0;
    for (uint32_t i = 0; i < h->built; i++) {
        const struct element *e = &h->elements[i];
        double high = 0, low = 0;
        if (!e->vertices)
            continue;
        polygon_reach((const double(*)[3])e->vertex, e->vertices, e->centre, e->normal, &high,
                      &low);
        most = fmax(most, fmax(high, -low));
        for (uint32_t c = 0; c < e->children; c++) {
            high = low = 0;
            element_reach(e, &h->elements[e->child + c], &high, &low);
            most = larger(h, most, fmax(high, -low));
        }
    }
    return most;
}

/* Of the corners that a body stands on something with. */
static double of_feet(const struct hierarchy *h, const struct bodies *b)
{
    double most = 0;
    for (size_t i = 0; i < b->feet_count; i++) {
        const struct body *body = &b->body[b->feet[i].body];
        const struct element *on = &h->elements[b->feet[i].on];
        for (uint32_t k = 0; k < body->corners && b->feet[i].area > 0; k++)
            most = larger(h, most,
                          fabs(height3(b->corners[body->corner + k], on->vertex[0], on->normal)));
    }
    return most;
}

/* Of corners that are one place. */
static int of_corners(const struct hierarchy *h, double *most)
{
    size_t count = 0, room = 4 * (size_t)h->face_count + 1;
    struct corner *corners = malloc(room * sizeof *corners);
    uint32_t *place = malloc(room * sizeof *place);
    double(*box)[2][3] = malloc(room * sizeof *box);
    const int failed = !corners || !place || !box;
    for (uint32_t f = 0; f < h->face_count && !failed; f++) {
        const struct element *e = hierarchy_surface(h, f);
        for (int i = 0; i < e->vertices; i++, count++)
            corners[count] = (struct corner){e->vertex[i], count};
    }
    if (!failed) {
        places_find(corners, count, FARTHEST * h->flat, place);
        for (size_t i = 0; i < count; i++)
            for (int k = 0; k < 3; k++) {
                box[i][0][k] = INFINITY;
                box[i][1][k] = -INFINITY;
            }
        for (size_t i = 0; i < count; i++)
            for (int k = 0; k < 3; k++) {
                double *low = &box[place[corners[i].index]][0][k],
                       *high = &box[place[corners[i].index]][1][k];
                *low = fmin(*low, corners[i].at[k]);
                *high = fmax(*high, corners[i].at[k]);
                *most = larger(h, *most, *high - *low);
            }
    }
    free(corners);
    free(place);
    free(box);
    return failed ? -1 : 0;
}

int misfit_find(const struct hierarchy *h, const struct bodies *bodies, double *misfit)
{
    *misfit = fmax(of_planes(h), of_feet(h, bodies));
    return of_corners(h, misfit);
}
