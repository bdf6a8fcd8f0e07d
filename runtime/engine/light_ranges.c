/* light_ranges.c - see light_ranges.h.
 *
 * Invariant: the shares of a leaf cover all surfaces of the scene, each once, but for those that no
 * point of the leaf sees, as is proved. So at each point x of the leaf the light is
 *     H(x) = sum_l w_l B_l,   w_l = F_l(x) V_l(x) in [low_l, high_l], or in [0, high_l] where
 *     something may be between, sum w_l <= 1,
 * B_l within what the emitter's leaves have. A pair without a link may have been dropped because
 * few rays found it hidden, which proves nothing; so it has a share like any other.
 *
 * F(x) is bounded over the leaf by terms/form_factor_range.h, of a cluster by the sphere around it,
 * (R/d)^2. What is between is found out by shafts, never by rays: an empty one proves V = 1, one
 * that a face covers V = 0, all else is anything from 0 to 1. Emitters are taken by parts as long
 * as they would count for more than RANGE_DETAIL otherwise; nothing is split for it.
 * [Lischinski, Smits and Greenberg 1994, bounds on the parts of a link; that shares sum to no more
 * than 1, which keeps rows beside edges finite: derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "engine/light_ranges.h"
#include "engine/winding.h"
#include "kernel/constants.h"
#include "terms/blockers.h"
#include "terms/form_factor_range.h"
#include "util/array.h"
#include "util/thread_pool.h"

/* One thread's walk over the emitters that a leaf may see. */
struct walk {
    struct light_ranges *ranges;
    const struct element *elements, *leaf;
    const double *most, *spread;
    double detail; /* W/m2 */
    /* [element]: 1 + the link to it from the leaf or what holds the leaf; how many links lead
     * below it */
    uint32_t *linked, *below;
    struct share *shares; /* of this leaf, as far as found */
    struct share_group *groups;
    size_t share_count, share_room, group_count, group_room;
    uint32_t group; /* where shares go now; 0: none */
    /* [element]: what stands between the ends of the link to it, where that has been found out */
    struct blockers *between;
    int failed;
};

/* ---- links of the leaf and of what holds it */

/* What stands between a receiver with parts and an emitter is found for all parts at once: a shaft
 * within it meets no other face (kernel/shaft.h). */
static void look_between(struct walk *w, uint32_t receiver, uint32_t emitter)
{
    const struct element *r = &w->elements[receiver], *s = &w->elements[emitter];
    struct blockers *list = &w->between[emitter];
    list->known = BLOCKERS_UNKNOWN;
    if (!r->vertices || !r->children || !s->vertices)
        return;
    blockers_find(r, s, rays_host(w->ranges->op->problem->rays), list);
    list->known = list->count > BLOCKERS_MAX || (list->count > 0 && !list->covered && !list->handed)
                      ? BLOCKERS_UNKNOWN
                      : BLOCKERS_INHERITED;
}

static void mark_links(struct walk *w, uint32_t receiver, int by)
{
    const struct refinement *r = w->ranges->op->refinement;
    for (size_t l = r->first_link[receiver]; l < r->first_link[receiver + 1]; l++) {
        uint32_t e = r->links[l].emitter;
        w->linked[e] = by > 0 ? (uint32_t)l + 1 : 0;
        if (by > 0)
            look_between(w, receiver, e);
        while (e) {
            e = w->elements[e].parent;
            w->below[e] += (uint32_t)by;
        }
    }
}

/* ---- shares */

static void add_share(struct walk *w, uint32_t emitter, const double range[2], double linked,
                      int visible)
{
    struct share *s;
    if (array_reserve(&w->shares, w->share_count + 1, &w->share_room, sizeof *s) < 0) {
        w->failed = 1;
        return;
    }
    s = &w->shares[w->share_count++];
    memset(s, 0, sizeof *s);
    s->emitter = emitter;
    s->low = (float)(range[0] * (1 - RANGE_ROUNDING));
    s->high = (float)fmin(range[1] * (1 + RANGE_ROUNDING), 1);
    s->linked = (float)linked;
    s->group = w->group & 0x7fffffffu;
    s->visible = (unsigned)visible & 1u;
    if (w->group && !visible)
        w->groups[w->group - 1].visible = 0;
}

/* Until w->group is 0 again, shares are of parts of this face. Returns 0 when no point of the leaf
 * can see it. */
static int open_group(struct walk *w, const struct element *face)
{
    double range[2];
    form_factor_range_bound(w->leaf, face, range);
    if (!(range[1] > 0)
        || array_reserve(&w->groups, w->group_count + 1, &w->group_room, sizeof *w->groups) < 0) {
        w->failed |= range[1] > 0;
        return 0;
    }
    w->groups[w->group_count++] =
        (struct share_group){(float)(range[0] * (1 - RANGE_ROUNDING)),
                             (float)fmin(range[1] * (1 + RANGE_ROUNDING), 1), 1};
    w->group = (uint32_t)w->group_count;
    return 1;
}

/* The link that holds a pair of the leaf: its V, 0 where there is none; and what is known to stand
 * between its ends, NULL: nothing. */
struct holder {
    double linked;
    const struct blockers *between;
};

/* What is between leaf and e: 1 nothing, 0 a face that hides all of it, -1 who knows. */
static int find_between(const struct walk *w, const struct element *e, const struct holder *from)
{
    struct blockers list;
    list.known = BLOCKERS_UNKNOWN;
    if (from->between && from->between->known != BLOCKERS_UNKNOWN) {
        list = *from->between;
        if (list.covered || list.count == 0)
            return !list.covered;
    }
    blockers_find(w->leaf, e, rays_host(w->ranges->op->problem->rays), &list);
    return list.covered ? 0 : list.count == 0 ? 1 : -1;
}

static void range_below(struct walk *w, uint32_t e, struct holder from);

static void take_children(struct walk *w, uint32_t e, struct holder from)
{
    const struct element *x = &w->elements[e];
    int opens = x->vertices && x->depth == 0;
    if (opens && !open_group(w, x))
        return;
    for (int c = 0; c < x->children; c++)
        range_below(w, x->child + (uint32_t)c, from);
    if (opens)
        w->group = 0;
}

static void take_surface(struct walk *w, uint32_t e, struct holder from)
{
    const struct element *x = &w->elements[e];
    double range[2];
    form_factor_range_bound_to(w->leaf, x, 0, range);
    if (!(range[1] > 0))
        return;
    int between = find_between(w, x, &from);
    if (between == 0) {
        if (w->group)
            w->groups[w->group - 1].visible = 0;
        return;
    }
    if (x->children && range[1] * (between > 0 ? w->spread[e] : w->most[e]) > w->detail) {
        take_children(w, e, from);
        return;
    }
    if ((range[1] - range[0]) * w->most[e] > RANGE_FINE * w->detail)
        form_factor_range_bound(w->leaf, x, range);
    add_share(w, e, range, from.linked, between > 0);
}

/* The most that a point of the leaf can see of a cluster. */
static double cluster_share(const struct element *leaf, const struct element *cluster)
{
    double away[3], half = 0;
    sub3(away, cluster->centre, leaf->centre);
    for (int k = 0; k < 3; k++)
        half += 0.5 * fabs(leaf->normal[k]) * (cluster->vertex[1][k] - cluster->vertex[0][k]);
    if (dot3(leaf->normal, away) + half <= 0)
        return 0;
    double distance = length3(away) - leaf->radius, radius = cluster->radius;
    return distance > radius ? radius * radius / (distance * distance) : 1;
}

/* Shares of e, which `from` holds. */
static void range_below(struct walk *w, uint32_t e, struct holder from)
{
    const struct element *x = &w->elements[e];
    if (w->linked[e]) {
        const struct link *l = &w->ranges->op->refinement->links[w->linked[e] - 1];
        from = (struct holder){l->visibility * (1.0 / LINK_VISIBLE), &w->between[e]};
    } else if (w->below[e]) {
        take_children(w, e, from);
        return;
    }
    if (x->vertices) {
        take_surface(w, e, from);
        return;
    }
    const double range[2] = {0, cluster_share(w->leaf, x)};
    if (range[1] * w->most[e] > w->detail)
        take_children(w, e, from);
    else if (range[1] > 0)
        add_share(w, e, range, from.linked, 0);
}

/* ---- leaves */

static void find_row(struct walk *w, uint32_t leaf)
{
    struct share_row *row = &w->ranges->rows[leaf];
    w->leaf = &w->elements[leaf];
    w->share_count = w->group_count = 0;
    w->group = 0;
    range_below(w, 0, (struct holder){0, NULL});
    row->share_count = (uint32_t)w->share_count;
    row->group_count = (uint32_t)w->group_count;
    row->shares = malloc((w->share_count + 1) * sizeof *row->shares);
    row->groups = malloc((w->group_count + 1) * sizeof *row->groups);
    w->failed |= !row->shares || !row->groups;
    if (w->failed)
        return;
    if (w->share_count)
        memcpy(row->shares, w->shares, w->share_count * sizeof *row->shares);
    if (w->group_count)
        memcpy(row->groups, w->groups, w->group_count * sizeof *row->groups);
}

/* Rows of the leaves below e. Returns how many shares they have. */
static uint64_t find_below(struct walk *w, uint32_t e)
{
    const struct element *x = &w->elements[e];
    uint64_t count = 0;
    mark_links(w, e, 1);
    for (int c = 0; c < x->children && !w->failed; c++)
        count += find_below(w, x->child + (uint32_t)c);
    if (!x->children && w->ranges->op->uncovered[e] > 0) {
        find_row(w, e);
        count = w->share_count;
    }
    mark_links(w, e, -1);
    return count;
}

static void mark_clusters_of(struct walk *w, uint32_t face, int by)
{
    for (uint32_t e = face; e;) {
        e = w->elements[e].parent;
        mark_links(w, e, by);
    }
}

/* How far all threads have come. */
struct progress {
    _Atomic uint64_t shares, faces;
    atomic_int stopped, failed;
};

/* All leaves, face by face. */
struct ranging {
    const struct hierarchy *h;
    struct walk *walks; /* [thread] */
    struct progress *progress;
    ranges_watch *watch;
    void *context;
};

static void range_faces(const void *ranging, size_t from, size_t to)
{
    const struct ranging *g = ranging;
    struct progress *p = g->progress;
    struct walk *w = &g->walks[thread_pool_number()];
    for (size_t i = from; i < to; i++) {
        uint64_t so_far = p->shares;
        if (p->failed || p->stopped || so_far > RANGES_MOST)
            continue;
        mark_clusters_of(w, g->h->face_element[i], 1);
        p->shares += find_below(w, g->h->face_element[i]);
        mark_clusters_of(w, g->h->face_element[i], -1);
        uint64_t faces = ++p->faces;
        if (w->failed)
            p->failed = 1;
        if (g->watch && thread_pool_number() == 0 && g->watch(g->context, faces, so_far))
            p->stopped = 1;
    }
}

/* Returns 0 or -1. */
static int walk_open(struct walk *w, struct light_ranges *r, const double *most,
                     const double *spread)
{
    const struct light_operator *op = r->op;
    *w = (struct walk){.ranges = r,
                       .elements = op->hierarchy->elements,
                       .most = most,
                       .spread = spread,
                       .detail = RANGE_DETAIL * rays_host(op->problem->rays)->irradiance,
                       .linked = calloc(op->hierarchy->count, sizeof *w->linked),
                       .below = calloc(op->hierarchy->count, sizeof *w->below),
                       .between = calloc(op->hierarchy->count, sizeof *w->between)};
    return w->linked && w->below && w->between ? 0 : -1;
}

static void walk_close(struct walk *w)
{
    free(w->linked);
    free(w->below);
    free(w->between);
    free(w->shares);
    free(w->groups);
}

int light_ranges_open(struct light_ranges *r, const struct light_operator *op, const double *most,
                      const double *spread, ranges_watch *watch, void *context)
{
    const struct hierarchy *h = op->hierarchy;
    int threads = op->problem->options.threads;
    struct progress p = {0};
    const struct ranging g = {h, calloc((size_t)threads, sizeof *g.walks), &p, watch, context};
    *r = (struct light_ranges){.op = op};
    r->rows = calloc(h->count, sizeof *r->rows);
    r->closed = malloc(h->count);
    p.failed = !r->rows || !r->closed || !g.walks;
    for (int t = 0; t < threads && !p.failed; t++)
        p.failed = walk_open(&g.walks[t], r, most, spread) < 0;
    if (!p.failed) {
        winding_closed(h, op->uncovered, threads, r->closed);
        thread_pool_run(threads, h->face_count, 1, range_faces, &g);
    }
    for (int t = 0; t < threads && g.walks; t++)
        walk_close(&g.walks[t]);
    free(g.walks);
    r->count = p.shares;
    r->too_many = p.shares > RANGES_MOST;
    if (p.failed || p.stopped) {
        light_ranges_close(r);
        return -1;
    }
    return 0;
}

void light_ranges_close(struct light_ranges *r)
{
    for (uint32_t i = 0; r->rows && i < r->op->hierarchy->count; i++) {
        free(r->rows[i].shares);
        free(r->rows[i].groups);
    }
    free(r->rows);
    free(r->closed);
    *r = (struct light_ranges){0};
}
