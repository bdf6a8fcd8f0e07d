/* candidates.c - what stands in a shaft or along a segment.
 *
 * A walk over the clusters, depth first: a box that lies outside is left alone with all it holds, a
 * face is cut by the shaft's planes. Nothing is allocated and nothing written, so any number of
 * threads may walk at once while nobody splits. [Haines & Wallace 1994]
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include "visibility/candidates.h"
#include "hierarchy/reach.h"
#include "kernel/element_distance.h"
#include "kernel/shaft.h"

struct walk {
    const struct hierarchy *h;
    const struct shaft *shaft;
    const uint32_t *of; /* solids, and those behind the ends; NULL: nobody knows of any */
    uint32_t behind[2];
    double offset; /* how far the ends are off their surfaces (m) */
    int (*found)(void *context, uint32_t face);
    void *context;
};

/* The box of a group, whose faces may reach out of its plane a little. */
static void box_of_group(const struct element *e, double flat, double low[3], double high[3])
{
    distance_box(e, low, high);
    for (int k = 0; k < 3; k++) {
        low[k] -= flat;
        high[k] += flat;
    }
}

/* How far an end reaches in front of a plane, and behind: no less than *high and *low say already.
 */
static void end_reach(const struct shaft *shaft, int end, const double on[3],
                      const double normal[3], double *high, double *low)
{
    polygon_reach((const double(*)[3])shaft->end[end], (uint32_t)shaft->points[end], on, normal,
                  high, low);
}

/* Does a face lie wholly behind the surface of one end? Segments between the ends run in front of
 * both, so it stops none, though ends are moved off, and of surfaces that meet at an acute angle,
 * or are nearer to each other than that, moved behind each other. Of a bent surface the lowest
 * corner counts. What the deeper pair leaves out is no less: `touch` grows. */
static int lies_behind(const struct shaft *shaft, double offset, const struct element *e)
{
    for (int end = 0; end < 2; end++) {
        const double *n = shaft->facing[end], *on = shaft->end[end][0];
        double high = -INFINITY, low = INFINITY, own_high = high, own_low = low;
        end_reach(shaft, end, on, n, &own_high, &own_low);
        polygon_reach((const double(*)[3])e->vertex, e->vertices, on, n, &high, &low);
        if (high - own_low + offset <= shaft->touch)
            return 1;
    }
    return 0;
}

/* Do the ends as they are, before they are moved off, lie on one side of a face, but for
 * SHAFT_STRIP, since files round corners? Where surfaces meet at an acute angle, moving an end off
 * the one puts a strip of it, no wider than the offset, behind the other. */
static int on_one_side(const struct shaft *shaft, double offset, const struct element *e)
{
    const double(*v)[3] = (const double(*)[3])e->vertex,
          strip = SHAFT_STRIP * offset + shaft->touch;
    double low = INFINITY, high = -INFINITY;
    if (shaft_side(shaft, v, e->vertices, e->normal) < 0)
        return 0;
    for (int end = 0; end < 2; end++) {
        const double moved = offset * dot3(e->normal, shaft->facing[end]);
        double end_high = -INFINITY, end_low = INFINITY;
        end_reach(shaft, end, v[0], e->normal, &end_high, &end_low);
        low = fmin(low, end_low - moved);
        high = fmax(high, end_high - moved);
    }
    return (low >= -strip && high > SHAFT_AWAY * strip)
           || (high <= strip && low < -SHAFT_AWAY * strip);
}

int candidates_parted(const struct hierarchy *h, const struct shaft *shaft, double offset,
                      uint32_t index)
{
    const struct element *e = &h->elements[index];
    const double(*v)[3] = (const double(*)[3])e->vertex;
    double normal[3];
    if (h->solid && (lies_behind(shaft, offset, e) || on_one_side(shaft, offset, e)))
        return 0;
    return shaft_normal(v, e->vertices, normal)
           && (shaft_bent(shaft, v, e->vertices, normal)
               || shaft_side(shaft, v, e->vertices, normal) <= 0);
}

int candidates_meets(const struct hierarchy *h, const struct shaft *shaft, double offset,
                     uint32_t index)
{
    const struct element *e = &h->elements[index];
    return !(h->solid && lies_behind(shaft, offset, e))
           && shaft_meets(shaft, (const double(*)[3])e->vertex, e->vertices, NULL)
           && !(h->solid && on_one_side(shaft, offset, e));
}

/* Is all of the shaft on one side of a plane that all faces of a cluster lie in, so that it meets
 * none of them? As shaft_side, but for how far these may be apart from that plane; and where an end
 * may lie flat on one of them, each is asked. */
static int runs_beside(const struct walk *w, const struct element *plane)
{
    const struct shaft *shaft = w->shaft;
    const double apart = SHAFT_SLACK * w->offset, near = shaft->margin + apart;
    double low = INFINITY, high = -INFINITY;
    for (int end = 0; end < 2; end++) {
        double end_high = -INFINITY, end_low = INFINITY, across[3];
        end_reach(shaft, end, plane->vertex[0], plane->normal, &end_high, &end_low);
        cross3(across, plane->normal, shaft->facing[end]);
        if (end_low < near && end_high > -near && dot3(across, across) < 2 * SHAFT_PARALLEL)
            return 0;
        low = fmin(low, end_low);
        high = fmax(high, end_high);
    }
    return low >= apart - shaft->touch || high <= shaft->touch - apart;
}

/* Returns 0, or -1 when who is told wants no more. `flat`: a cluster above it is in a plane, which
 * crosses the shaft. */
static int walk_shaft(const struct walk *w, uint32_t index, int flat)
{
    const struct hierarchy *h = w->h;
    const struct element *e = &h->elements[index];
    double low[3], high[3];
    if (h->outer && h->outer[index])
        return 0;
    if (w->of && w->of[index] && (w->of[index] == w->behind[0] || w->of[index] == w->behind[1]))
        return 0;
    if (h->solid ? h->solid[index] : e->vertices)
        return face_shades(&h->faces[h->order[h->range[index].from]])
                       && candidates_meets(h, w->shaft, w->offset, index)
                   ? w->found(w->context, h->solid ? index : e->face)
                   : 0;
    if (e->vertices)
        box_of_group(e, h->flat, low, high);
    if (shaft_misses_box(w->shaft, e->vertices ? low : e->vertex[0],
                         e->vertices ? high : e->vertex[1]))
        return 0;
    if (!flat && h->plane && h->plane[index]) {
        if (runs_beside(w, &h->elements[h->plane[index]]))
            return 0;
        flat = 1;
    }
    for (uint32_t c = 0; c < e->children; c++)
        if (walk_shaft(w, e->child + c, flat) < 0)
            return -1;
    return 0;
}

int candidates_walk(const struct hierarchy *h, const struct solids *solids,
                    const struct shaft *shaft, double offset,
                    int (*found)(void *context, uint32_t face), void *context)
{
    struct walk w = {.h = h, .shaft = shaft, .offset = offset, .found = found, .context = context};
    for (int end = 0; end < 2 && solids; end++)
        w.behind[end] =
            solids_behind(solids, h, shaft->facing[end], (const double(*)[3])shaft->end[end],
                          shaft->points[end], shaft->slack - offset);
    if (w.behind[0] || w.behind[1])
        w.of = solids->of;
    return walk_shaft(&w, 0, 0);
}

struct list {
    int most, count;
    uint32_t *faces;
};

static int add_face(void *list, uint32_t face)
{
    struct list *l = list;
    if (l->count == l->most)
        return -1;
    l->faces[l->count++] = face;
    return 0;
}

int candidates_find(const struct hierarchy *h, const struct shaft *shaft, double offset, int most,
                    uint32_t *faces)
{
    struct list list = {most, 0, faces};
    return candidates_walk(h, NULL, shaft, offset, add_face, &list) < 0 ? most + 1 : list.count;
}

void candidates_corners(const struct hierarchy *h, uint32_t face, struct polygon *polygon)
{
    const struct element *e = &h->elements[h->solid ? face : h->face_element[face]];
    polygon->n = e->vertices;
    memcpy(polygon->v, e->vertex, e->vertices * sizeof *e->vertex);
}

/* Length of the segment inside a box (m). */
static double inside(const struct segment *g, const double low[3], const double high[3])
{
    double from = 0, to = 1, v[3];
    sub3(v, g->to, g->from);
    for (int k = 0; k < 3; k++) {
        double a = low[k] - g->from[k], b = high[k] - g->from[k];
        if (!(fabs(v[k]) > 0)) {
            if (a > 0 || b < 0)
                return 0;
            continue;
        }
        a /= v[k];
        b /= v[k];
        if (a > b) {
            double swap = a;
            a = b;
            b = swap;
        }
        from = a > from ? a : from;
        to = b < to ? b : to;
    }
    return from < to ? (to - from) * length3(v) : 0;
}

static double depth(const struct hierarchy *h, uint32_t index, const struct segment *g,
                    const uint32_t own[2], double least)
{
    const struct element *e = &h->elements[index];
    double low[3], high[3], area = 0, volume = 1, sum = 0;
    int counts = 1;
    if (e->vertices)
        return 0;
    for (int k = 0; k < 3; k++) {
        double more = 0.5 * (least - (e->vertex[1][k] - e->vertex[0][k]));
        more = more > 0 ? more : 0;
        low[k] = e->vertex[0][k] - more;
        high[k] = e->vertex[1][k] + more;
        volume *= high[k] - low[k];
    }
    double length = inside(g, low, high);
    if (!(length > 0))
        return 0;
    for (int c = 0; c < e->children; c++) {
        const struct element *x = &h->elements[e->child + (uint32_t)c];
        if (!x->vertices) {
            sum += depth(h, e->child + (uint32_t)c, g, own, least);
            continue;
        }
        if (x->face == own[0] || x->face == own[1])
            counts = 0;
        if (face_shades(&h->faces[x->face]))
            area += x->area;
    }
    return counts && area > 0 ? sum + 0.25 * area / volume * length : sum;
}

double candidates_depth(const struct hierarchy *h, const struct segment *segment, uint32_t receiver,
                        uint32_t emitter, double least)
{
    const uint32_t own[2] = {receiver, emitter};
    return depth(h, 0, segment, own, least);
}
