/* enclosure.c - is the scene closed? Decided by walks of light through it, none of which may end.
 *
 * Closed means that what leaves a lit front always meets a front, so that rows sum to 1 wherever light comes. A walk starts on
 * something that emits, goes on in a cosine-spread direction and again from where it meets a front, LENGTH times. It ends
 * when it leaves the scene, or meets a back, which is black. Because it goes where light goes, what light never
 * reaches is not asked: points inside a solid, the hollow of a book against its cover, faces that turn
 * outward. Nor do walks start in such places: all rays around a start must meet fronts.
 *
 * Walks visit surfaces in proportion to their areas, so an opening of the share p of all area ends about p of all steps.
 * Two of 100,000 may end and the scene still count as closed, for rounding lets one through a crack between faces now and then.
 * What can be missed, then, is an opening of that share, and the error that makes is no larger than the share;
 * one of 1/10,000 is found with a probability of 99.99 %. Openings in a place that light reaches only through a much
 * smaller one can be missed as well.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include "engine/enclosure.h"
#include "kernel/hemisphere.h"
#include "kernel/hash.h"
#include "kernel/surface_point.h"

enum { WALKS = 1024, LENGTH = 256, SIDE = 4, AROUND = 64 };
#define CRACKS 2e-5

static int lit(const struct problem *p, uint32_t face)
{
    uint32_t k;
    for (k = 0; k < p->bands; k++)
        if (p->exitance[(size_t)face * p->bands + k] > 0)
            return 1;
    return 0;
}

/* Do all rays around the point meet fronts? */
static int is_clear(const struct rays *rays, const double p[3], const double normal[3])
{
    const struct hemisphere above = hemisphere_over(normal);
    double d[3];
    int m;
    for (m = 0; m < AROUND; m++) {
        hemisphere_direction(d, &above, m, AROUND, 0);
        if (rays_first(rays, p, d, NULL, NULL) != RAY_MEETS_FRONT)
            return 0;
    }
    return 1;
}

/* One walk, which starts on the face. Returns how many steps it took, and 0 when it cannot start; *ended: it found an end. */
static int go(const struct rays *rays, const struct hierarchy *h, uint32_t walk, uint32_t face, int *ended)
{
    const struct element *e = &h->elements[h->face_element[face]];
    double p[3], n[3] = { e->normal[0], e->normal[1], e->normal[2] }, offset = rays_host(rays)->ray_offset;
    int i, k;
    *ended = 0;
    surface_point(p, e, (walk % SIDE + 0.5) / SIDE, (walk / SIDE % SIDE + 0.5) / SIDE);
    for (k = 0; k < 3; k++)
        p[k] += offset * n[k];
    if (!is_clear(rays, p, n))
        return 0;
    for (i = 0; i < LENGTH && !*ended; i++) {
        const struct hemisphere above = hemisphere_over(n);
        uint64_t bits = hash64(((uint64_t)walk * LENGTH + (uint64_t)i + 1) * HASH_STEP);
        double d[3];
        hemisphere_direction(d, &above, (int)(bits >> 48), 1 << 16, (double)(bits & 0xffffffff) * (1 / 4294967296.0));
        *ended = rays_first(rays, p, d, p, n) != RAY_MEETS_FRONT;
        for (k = 0; k < 3; k++)
            p[k] += offset * n[k];
    }
    return i;
}

int enclosure_decide(const struct problem *p, const struct hierarchy *h, uint64_t *rays)
{
    uint32_t start[WALKS] = { 0 }, count = 0, next = 0, w = 0, i;
    int64_t steps = 0, ends = 0;
    for (i = 0; i < p->scene->face_count; i++)
        count += (uint32_t)lit(p, i);
    for (i = 0; i < p->scene->face_count; i++) { /* shared out evenly */
        next += (uint32_t)lit(p, i);
        while (w < WALKS && (uint64_t)w * count / WALKS < next)
            start[w++] = i;
    }
#pragma omp parallel for schedule(dynamic, 16) num_threads(p->options.threads) reduction(+ : steps, ends)
    for (i = 0; i < w; i++) {
        int ended;
        steps += go(p->rays, h, i, start[i], &ended);
        ends += ended;
    }
    *rays = (uint64_t)steps;
    return steps > 0 && (double)ends <= CRACKS * (double)steps;
}
