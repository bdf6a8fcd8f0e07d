/* exchange_tree.c - a hierarchy with flat groups, and a host over it: rays are the scene's, shafts
 * are asked for groups.
 *
 * What touches is told by a share of how large the scene is, since rays, in single precision, tell
 * no less (visibility/rays.c). Shafts and points do: one face far off would make all that is near
 * touch. So for them it is a share of where most corners are, or of how far that is from where
 * coordinates begin, which may be rounded as floats are.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_contacts.h"
#include "engine/exchange_tree.h"
#include "hierarchy/misfit.h"
#include "util/array.h"
#include "visibility/candidates.h"
#include "visibility/hidden.h"
#include "visibility/outer_walls.h"

static const struct exchange_tree *tree_of(const struct host *host)
{
    return (const struct exchange_tree *)(const void *)host;
}

/* Oracles' rays start off surfaces by as much as touches here; they go on from as far off along
 * themselves as rays must. */
static uint64_t occluded(const struct host *host, int count, const struct segment *segments)
{
    const struct host *rays = rays_host(tree_of(host)->rays);
    const double more = rays->ray_offset - host->ray_offset;
    struct segment shorter[SEGMENTS_MAX];
    if (!(more > 0))
        return rays->occluded(rays, count, segments);
    for (int i = 0; i < count; i++) {
        const double *from = segments[i].from, *to = segments[i].to;
        double along[3];
        sub3(along, to, from);
        const double length = length3(along), t = length > 2 * more ? more / length : 0.5;
        for (int k = 0; k < 3; k++) {
            shorter[i].from[k] = from[k] + t * along[k];
            shorter[i].to[k] = to[k] - t * along[k];
        }
    }
    return rays->occluded(rays, count, shorter);
}

/* Faces found in a shaft, and whether they hide all. */
struct found {
    struct hidden hidden;
    int count, most;
    uint32_t *elements;
};

static int add_found(void *found, uint32_t element)
{
    struct found *f = found;
    if (f->count < f->most)
        f->elements[f->count] = element;
    f->count += f->count <= f->most;
    hidden_add(&f->hidden, element);
    return f->count > f->most && f->hidden.open ? -1 : 0;
}

static int candidates(const struct host *host, const struct shaft *shaft, int most,
                      uint32_t *elements)
{
    const struct exchange_tree *t = tree_of(host);
    struct found f = {.most = most, .elements = elements};
    hidden_start(&f.hidden, &t->h, &t->mates, shaft);
    (void)candidates_walk(&t->h, &t->solids, shaft, host->ray_offset, add_found, &f);
    return hidden_all(&f.hidden) ? HOST_HIDDEN : f.count;
}

static void corners(const struct host *host, uint32_t element, struct polygon *polygon)
{
    candidates_corners(&tree_of(host)->h, element, polygon);
}

/* The share of corners that is left out at either end of each axis; and how many times as large as
 * the box of the others a scene may be to count whole. Chosen: a furnished room has its walls. */
static const double FAR_OFF = 0.05, LARGE = 4;

/* How large a scene is for what is near in it, of how large it is; 0 when out of memory. */
static double near_share(const struct face *faces, uint32_t count)
{
    double all = 0, most = 0, from_origin = 0, *at = malloc(4 * (size_t)count * sizeof *at);
    if (!at)
        return 0;
    for (int k = 0; k < 3; k++) {
        size_t n = 0;
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t v = 0; v < faces[i].vertices; v++)
                at[n++] = faces[i].vertex[v][k];
        qsort(at, n, sizeof *at, compare_numbers);
        const size_t out = (size_t)(FAR_OFF * (double)n);
        const double low = at[out], high = at[n - 1 - out], wide = at[n - 1] - at[0];
        all += wide * wide;
        most += (high - low) * (high - low);
        from_origin = fmax(from_origin, fmax(fabs(low), fabs(high)));
    }
    free(at);
    const double near = fmax(LARGE * sqrt(most), from_origin);
    return near * near < all ? near / sqrt(all) : 1;
}

int exchange_tree_open(struct exchange_tree *t, const struct face *faces, uint32_t face_count,
                       int threads, const char **cause)
{
    double misfit, *unit = malloc(face_count * sizeof *unit),
                   *black = calloc(face_count, sizeof *black);
    memset(t, 0, sizeof *t);
    *cause = "out of memory";
    if (!unit || !black || face_count > UINT32_MAX / 16
        || hierarchy_build(&t->plain, faces, face_count) < 0)
        goto fail;
    for (uint32_t i = 0; i < face_count; i++)
        unit[i] = 1;
    t->rays = rays_prepare(&t->plain, unit, black, threads, cause);
    if (!t->rays || (rays_in_the_way(t->rays) && rays_build(t->rays, cause) < 0))
        goto fail;
    *cause = "out of memory";
    const double share = near_share(faces, face_count);
    if (!(share > 0)
        || hierarchy_build_groups(&t->h, &t->plain, share * rays_host(t->rays)->flat) < 0
        || mates_open(&t->mates, &t->h) < 0 || bodies_open(&t->bodies, &t->h, &t->mates) < 0
        || solids_open(&t->solids, &t->h, &t->mates) < 0
        || misfit_find(&t->h, &t->bodies, &misfit) < 0
        || (rays_in_the_way(t->rays) && exchange_contacts_find(t) < 0))
        goto fail;
    t->host = *rays_host(t->rays);
    t->host.ray_offset *= share;
    t->host.flat *= share;
    if (outer_walls_find(&t->h, t->host.ray_offset) < 0)
        goto fail;
    t->lift =
        fmin(fmax(SIGHT_LIFT * t->host.ray_offset, SIGHT_MISFITS * misfit), t->host.ray_offset);
    t->host.occluded = occluded;
    t->host.candidates = candidates;
    t->host.corners = corners;
    t->host.optical_depth = NULL;
    t->host.elements = (const struct element *const *)&t->h.elements;
    if (rays_in_the_way(t->rays))
        hierarchy_free(&t->plain); /* of the rays' host, only rays are asked from here on */
    free(unit);
    free(black);
    return 0;
fail:
    exchange_tree_close(t);
    free(unit);
    free(black);
    return -1;
}

void exchange_tree_close(struct exchange_tree *t)
{
    rays_close(t->rays);
    mates_close(&t->mates);
    bodies_close(&t->bodies);
    solids_close(&t->solids);
    hierarchy_free(&t->h);
    hierarchy_free(&t->plain);
    memset(t, 0, sizeof *t);
}
