/* exchange_sight.c - the exchange area of two faces past what stands between them.
 *
 * Most pairs end here: nothing stands between, or all is hidden, both proved by a shaft; or so
 * little would be exchanged that a few rays do. Of the others one end is chosen whose points look
 * at the other, and integrated over (sight_cubature.h): the one on which a blocker's shadow moves
 * least from point to point, unless the other one is much smaller.
 * SPDX-License-Identifier: MIT */
#include "engine/exchange_sight.h"
#include "engine/sight_between.h"
#include "engine/sight_rays.h"
#include "kernel/polygon_factor.h"
#include "kernel/shaft.h"

/* How large e looks from the nearest of the faces: seen from another point of e, their shadows move
 * by so much. */
static double sway(const struct element *e, const struct exchange_tree *t, const uint32_t *list,
                   int count)
{
    double least = INFINITY;
    for (int i = 0; i < count; i++) {
        const struct element *face = &t->h.elements[list[i]];
        double apart[3], most = least + face->radius;
        sub3(apart, face->centre, e->centre);
        if (dot3(apart, apart) > most * most) /* all of it is farther */
            continue;
        least = fmin(least, polygon_distance(e->centre, (const double(*)[3])face->vertex,
                                             face->vertices, face->normal));
    }
    return e->radius / (least + e->radius);
}

/* So many rays of a pair, in a scene of many polygons, whose clear view is no more than this share
 * of the error that is allowed: what they leave open is 1/8 of that view at the most, as a standard
 * error. Chosen: a 30th of what is allowed. */
enum { FAINT_RAYS = 16 };
static const double FAINT = 0.25;

/* Most pairs of a large scene exchange next to nothing, and have the most between them. */
static int is_faint(const struct sight_limits *limits, double clear, double least)
{
    return clear <= FAINT * limits->tolerance * limits->floor * least;
}

/* Of faces that differ by so much in area the points are on the smaller one: of a large face few
 * see any of it through a slot, and of it all see some of the large one. Measured: 4 to 16 do for
 * fins, 64 is too much, and where all is alike in size shadows that sway less tell more. */
static const double SMALLER = 16;

/* How near two planes are to be one, by offsets of rays: ends are moved off by one, and what is
 * nearer stands before nothing. */
static const double JOINED = 4;

double sight_pair(const struct element *r, const struct element *s, const struct exchange_tree *t,
                  const struct sight_list *among, struct sight_scratch *scratch, int again,
                  double *error)
{
    const int believes = scratch->limits.many && !again;
    double least = fmin(r->area, s->area);
    const struct host *host = &t->host;
    const uint32_t on_r = t->h.face_element[r->face], on_s = t->h.face_element[s->face];
    uint32_t own[SIGHT_LIST];
    struct shaft shaft;
    *error = 0;
    if (bodies_cover(&t->bodies, &t->h, on_r) || bodies_cover(&t->bodies, &t->h, on_s)
        || bodies_meet(&t->bodies, &t->h, on_r, on_s) || !shaft_open(&shaft, r, s, host))
        return 0;
    int count = among ? sight_list_near(among, t, &shaft, own)
                      : host->candidates(host, &shaft, SIGHT_LIST, own);
    if (count == HOST_HIDDEN)
        return 0;
    const double clear = fmin(r->area * polygon_factor(r, s, 1), least);
    if (count == 0)
        return clear;
    if (believes && is_faint(&scratch->limits, clear, least))
        return sight_rays_leave(r, s, rays_host(t->rays), FAINT_RAYS, clear, error);
    int many = count > SIGHT_LIST; /* the larger one is cut: shafts shrink most */
    if (!many && !among)
        sight_list_sort(own, count);
    const enum between stands =
        many ? BETWEEN_MANY : sight_between_find(scratch->between, t, &shaft, own, count, 1);
    if (stands == BETWEEN_ALL)
        return 0;
    if (stands == BETWEEN_NOTHING)
        return clear;
    const int apart = r->area * SMALLER < s->area || s->area * SMALLER < r->area;
    double sway_r = many ? -r->radius : sway(r, t, own, count),
           sway_s = many ? -s->radius : sway(s, t, own, count);
    int from_r = apart ? r->area < s->area : sway_r < sway_s || (sway_r == sway_s && r->id < s->id);
    const double near = JOINED * host->ray_offset;
    const int joins_r = bodies_join(&t->bodies, &t->h, on_r, s, near),
              joins_s = bodies_join(&t->bodies, &t->h, on_s, r, near);
    if (joins_r != joins_s)
        from_r = joins_r;
    const struct sight_ends ends = {.tree = t,
                                    .from = from_r ? r : s,
                                    .to = from_r ? s : r,
                                    .clear = clear,
                                    .list = own,
                                    .count = count,
                                    .found = stands == BETWEEN_SOME,
                                    .believes = believes,
                                    .on = from_r ? on_r : on_s,
                                    .joined = joins_r || joins_s};
    return sight_integrate(&ends, scratch, error);
}
