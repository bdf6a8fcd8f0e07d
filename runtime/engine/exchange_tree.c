/* exchange_tree.c - a hierarchy with flat groups, and a host over it: rays are the scene's, shafts
 * are asked for groups.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_tree.h"
#include "visibility/candidates.h"
#include "visibility/hidden.h"

static const struct exchange_tree *tree_of(const struct host *host)
{
    return (const struct exchange_tree *)(const void *)host;
}

static uint64_t occluded(const struct host *host, int count, const struct segment *segments)
{
    const struct host *rays = rays_host(tree_of(host)->rays);
    return rays->occluded(rays, count, segments);
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

int exchange_tree_open(struct exchange_tree *t, const struct face *faces, uint32_t face_count,
                       int threads, const char **cause)
{
    double *unit = malloc(face_count * sizeof *unit), *black = calloc(face_count, sizeof *black);
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
    if (hierarchy_build_groups(&t->h, &t->plain, rays_host(t->rays)->flat) < 0
        || mates_open(&t->mates, &t->h) < 0 || bodies_open(&t->bodies, &t->h, &t->mates) < 0
        || solids_open(&t->solids, &t->h, &t->mates) < 0)
        goto fail;
    t->host = *rays_host(t->rays);
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
