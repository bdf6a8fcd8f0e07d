/* factor_sky.c - what becomes of the light that a row lacks: by rays.
 *
 * A row that sums to 1 within the tolerance needs no ray: what it lacks is less than what it may be wrong by. Of others 1,024
 * rays per face say whether any light leaves the scene; how much is what the row lacks.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/environment.h"
#include "kernel/hemisphere.h"
#include "kernel/surface_point.h"

enum { SIDE = 4, POINTS = SIDE * SIDE, DIRECTIONS = 64, BURIED = DIRECTIONS / 4 * 3 };

/* Where the rays from one face went. Those from points inside a solid count as buried, whatever they met. */
struct fates {
    int fronts, leaves, backs, buried;
};

static struct fates look_around(const struct rays *rays, const struct element *e)
{
    const struct hemisphere above = hemisphere_over(e->normal);
    struct fates all = { 0, 0, 0, 0 };
    double offset = rays_host(rays)->ray_offset;
    int i, m, k;
    for (i = 0; i < POINTS; i++) {
        double p[3], d[3];
        int met[3] = { 0, 0, 0 };
        surface_point(p, e, (i % SIDE + 0.5) / SIDE, (i / SIDE + 0.5) / SIDE);
        for (k = 0; k < 3; k++)
            p[k] += offset * e->normal[k];
        for (m = 0; m < DIRECTIONS; m++) {
            hemisphere_direction(d, &above, m, DIRECTIONS, i / (double)POINTS);
            met[rays_first(rays, p, d, NULL, NULL)]++;
        }
        if (met[RAY_MEETS_BACK] >= BURIED) {
            all.buried += DIRECTIONS;
            continue;
        }
        all.fronts += met[RAY_MEETS_FRONT];
        all.leaves += met[RAY_LEAVES];
        all.backs += met[RAY_MEETS_BACK];
    }
    return all;
}

static struct factor_sky look(const struct factor_matrix *m, uint32_t i)
{
    const struct hierarchy *h = &m->tree->h;
    struct factor_sky sky = { 0, 0, 0, 1 };
    double leaves = 0, lost = 0, buried = 0;
    uint32_t p;
    for (p = m->first[i]; p != UINT32_MAX; p = m->next[p]) {
        const struct element *e = &h->elements[h->face_element[h->order[p]]];
        struct fates f = look_around(m->tree->rays, e);
        double ray = e->area / (f.fronts + f.leaves + f.backs + f.buried);
        leaves += ray * f.leaves;
        lost += ray * f.backs;
        buried += ray * f.buried;
    }
    sky.leaves = (float)(leaves / m->area[i]);
    sky.lost = (float)(lost / m->area[i]);
    sky.buried = (float)(buried / m->area[i]);
    return sky;
}

void factor_sky_ask(struct factor_sky *sky, const struct factor_matrix *m, const double *sums, double tolerance, int threads)
{
    uint32_t i;
#pragma omp parallel for schedule(dynamic, 16) num_threads(threads)
    for (i = 0; i < m->inputs; i++)
        if (m->area[i] > 0 && (tolerance <= 0 || !(fabs(1 - sums[i]) <= tolerance)))
            sky[i] = look(m, i);
}

int factor_sky_closed(const struct factor_sky *sky)
{
    return !(sky->leaves > 0) && !(sky->lost > 0) && !(sky->buried > 0);
}
