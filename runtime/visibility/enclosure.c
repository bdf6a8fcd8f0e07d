/* enclosure.c - is the scene closed? Decided by walks of light through it, none of which may end.
 *
 * Closed means that what leaves a lit front always meets a front, so that rows sum to 1 wherever
 * light comes. A walk starts on something that emits, goes on in a cosine-spread direction and
 * again from where it meets a front, 256 times. It ends when it leaves the scene, or meets a back,
 * which is black. Because it goes where light goes, what light never reaches is not asked: points
 * inside a solid, the hollow of a book against its cover, faces that turn outward. Nor do walks
 * start in such places: all rays around a start must meet fronts.
 *
 * Walks visit surfaces in proportion to their areas, so an opening of the share p of all area ends
 * about p of all steps. Two of 100,000 may end and the scene still count as closed, for rounding
 * lets one through a crack between faces now and then. What can be missed, then, is an opening of
 * that share, and the error that makes is no larger than the share; one of 1/10,000 is found with a
 * probability of 99.99 %. Openings in a place that light reaches only through a much smaller one
 * can be missed as well.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include "visibility/enclosure.h"
#include "kernel/constants.h"
#include "kernel/hash.h"
#include "kernel/hemisphere.h"
#include "kernel/surface_point.h"
#include "util/thread_pool.h"

enum { WALKS = 1024, LENGTH = 256, SIDE = 4, AROUND = 64 };

/* Do all rays around the point meet fronts? */
static int sees_only_fronts(const struct rays *rays, const double p[3], const double normal[3])
{
    const struct hemisphere above = hemisphere_over(normal);
    for (int m = 0; m < AROUND; m++) {
        double d[3];
        hemisphere_direction(d, &above, m, AROUND, 0);
        if (rays_first(rays, p, d, NULL, NULL) != RAY_MEETS_FRONT)
            return 0;
    }
    return 1;
}

/* One walk, which starts on the surface e. Returns how many steps it took, and 0 when it cannot
 * start; *ended: it found an end. */
static int walk_light(const struct rays *rays, uint32_t walk, const struct element *e, int *ended)
{
    double p[3], n[3] = {e->normal[0], e->normal[1], e->normal[2]},
                 offset = rays_host(rays)->ray_offset;
    *ended = 0;
    surface_point(p, e, (walk % SIDE + 0.5) / SIDE, (walk / SIDE % SIDE + 0.5) / SIDE);
    for (int k = 0; k < 3; k++)
        p[k] += offset * n[k];
    if (!sees_only_fronts(rays, p, n))
        return 0;
    int i;
    for (i = 0; i < LENGTH && !*ended; i++) {
        const struct hemisphere above = hemisphere_over(n);
        uint64_t bits = hash64(((uint64_t)walk * LENGTH + (uint64_t)i + 1) * HASH_STEP);
        double d[3];
        hemisphere_direction(d, &above, (int)(bits >> 48), 1 << 16,
                             (double)(bits & 0xffffffff) * (1 / 4294967296.0));
        *ended = rays_first(rays, p, d, p, n) != RAY_MEETS_FRONT;
        for (int k = 0; k < 3; k++)
            p[k] += offset * n[k];
    }
    return i;
}

struct walks {
    const struct rays *rays;
    const struct hierarchy *h;
    uint32_t start[WALKS]; /* faces */
    _Atomic int64_t *taken, *ends;
};

static void walk_some(const void *walks, size_t from, size_t to)
{
    const struct walks *w = walks;
    for (size_t i = from; i < to; i++) {
        int ended;
        *w->taken += walk_light(w->rays, (uint32_t)i, hierarchy_surface(w->h, w->start[i]), &ended);
        *w->ends += ended;
    }
}

int enclosure_decide(const struct rays *rays, const struct hierarchy *h, const double *exitance,
                     int threads, uint64_t *steps)
{
    uint32_t count = 0, next = 0, w = 0;
    _Atomic int64_t taken = 0, ends = 0;
    struct walks walks = {.rays = rays, .h = h, .taken = &taken, .ends = &ends};
    for (uint32_t i = 0; i < h->face_count; i++)
        count += exitance[i] > 0;
    for (uint32_t i = 0; i < h->face_count; i++) { /* shared out evenly */
        next += exitance[i] > 0;
        while (w < WALKS && (uint64_t)w * count / WALKS < next)
            walks.start[w++] = i;
    }
    thread_pool_run(threads, w, 16, walk_some, &walks);
    *steps = (uint64_t)taken;
    return taken > 0 && (double)ends <= ENCLOSURE_CRACKS * (double)taken;
}
