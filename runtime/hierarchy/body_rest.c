/* body_rest.c - see body_rest.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "hierarchy/body_rest.h"
#include "hierarchy/lids.h"
#include "hierarchy/reach.h"
#include "kernel/constants.h"

int body_rest_near(const struct hierarchy *h, const struct element *e, const struct shell_lid *lid)
{
    const double(*v)[3] = (const double(*)[3])lid->corner,
          most = e->children ? 2 * h->flat : h->flat;
    double high = 0, low = 0, box[2][3];
    if (e->vertices) {
        polygon_reach(v, (uint32_t)lid->n, e->vertex[0], e->normal, &high, &low);
        if (!(fabs(dot3(e->normal, lid->normal)) > GROUP_COSINE) || high > most || low < -most)
            return 0;
    }
    element_box(e, box);
    for (int k = 0; k < 3; k++) {
        double from = v[0][k], to = from;
        for (int i = 1; i < lid->n; i++) {
            from = v[i][k] < from ? v[i][k] : from;
            to = v[i][k] > to ? v[i][k] : to;
        }
        if (from > box[1][k] + most || to < box[0][k] - most)
            return 0;
    }
    return 1;
}

/* Does one below an element lie on the lid? */
static int has_on(const struct hierarchy *h, uint32_t index, const struct shell_lid *lid)
{
    const struct element *e = &h->elements[index];
    struct lid under;
    if (!body_rest_near(h, e, lid) || (e->vertices && !(dot3(e->normal, lid->normal) < 0)))
        return 0;
    for (uint32_t c = 0; c < e->children; c++)
        if (has_on(h, e->child + c, lid))
            return 1;
    if (e->children)
        return 0;
    lid_of(&under, (const double(*)[3])e->vertex, e->vertices, e->normal, h->flat);
    return lid_place(&under, (const double(*)[3])lid->corner, (uint32_t)lid->n) != BESIDE;
}

int body_rest_on_lid(const struct hierarchy *h, const struct shell_lid *lid)
{
    return has_on(h, 0, lid);
}

int body_rest_is_on(const struct hierarchy *h, const struct element *e)
{
    struct shell_lid lid;
    shell_lid_of(&lid, e);
    return has_on(h, 0, &lid);
}
