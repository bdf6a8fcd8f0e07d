/* importance.c - the adjoint of light: Y = r + F V (rho Y), solved over the links that carry light.
 *
 * r is what a view asks for: 1 where a surface is in the picture, 0 where not; for a leaf the share
 * of its points that are. So Y of a place says how much of all that is seen changes with the light
 * that leaves there: with areas as weights, <r, B> = <Y, E>, as far as A_i F_ij = A_j F_ji holds. Z
 * = rho Y obeys Z = rho r + rho F V Z, radiosity's own equation with another source; so it is
 * solved by the same sweeps (transport.c), and Y = r + what Z irradiates.
 *
 * Three bands are one here: rho is the largest. The oracles see Y as a share of its largest value
 * (so scene.importance is 1, with a view or without), at least IMPORTANCE_LEAST, and with the
 * hysteresis of radiosity (oracle_inputs.c); host.impact is that largest value, for those who
 * compare errors in watts. Without a view, for them alone, r is 1 everywhere. At first they see r
 * itself: what the picture does not
 * hold is linked coarsely, and refined once the first solve has said what it means for the picture.
 * Fails: 64 points may all miss the part of a large leaf that is in the picture; r is then 0 until
 * something splits it.
 * [Smits, Arvo and Salesin 1992, sections 3 and 4]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/importance.h"
#include "kernel/constants.h"
#include "kernel/surface_point.h"
#include "util/array.h"
#include "util/ranks_loop.h"

enum { SIDE = 8, POINTS = SIDE * SIDE };

/* The share of e's points that are in the picture: in front of the camera, turned to it, and
 * nothing between. */
static double share_in_picture(const struct host *host, const struct camera *c,
                               const struct element *e)
{
    int count = 0, hits = 0;
    if (!(height3(c->eye, e->centre, e->normal) > 0))
        return 0;
    struct segment segments[POINTS];
    for (int i = 0; i < POINTS; i++) {
        struct segment *g = &segments[count];
        double v[3];
        surface_point(g->from, e, (i % SIDE + 0.5) / SIDE, (i / SIDE + 0.5) / SIDE);
        for (int k = 0; k < 3; k++)
            g->from[k] += host->ray_offset * e->normal[k];
        sub3(v, g->from, c->eye);
        double depth = dot3(v, c->ahead);
        if (!(depth > 0) || fabs(dot3(v, c->right)) > c->wide * depth
            || fabs(dot3(v, c->up)) > c->high * depth)
            continue;
        for (int k = 0; k < 3; k++)
            g->to[k] = c->eye[k];
        count++;
    }
    if (count == 0)
        return 0;
    uint64_t blocked = host->occluded(host, count, segments);
    for (int i = 0; i < count; i++)
        hits += !(blocked >> i & 1);
    return hits / (double)POINTS;
}

/* Room for all elements. Returns 0 or -1. */
static int reserve_importance(struct importance *y, uint32_t count)
{
    double **const lists[] = {&y->response, &y->source, &y->carried, &y->irradiance};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        if (array_reserve_beside(lists[i], count, y->capacity, sizeof **lists[i]) < 0)
            return -1;
    return array_reserve(&y->value, count, &y->capacity, sizeof *y->value);
}

/* For whom the surfaces made since the last call have a response. */
struct responding {
    const struct importance *y;
    const struct light_operator *op;
};

static void take_shares(const void *responding, size_t from, size_t to)
{
    const struct responding *r = responding;
    const struct problem *p = r->op->problem;
    for (size_t i = r->y->started + from; i < r->y->started + to; i++) {
        const struct element *e = &r->op->hierarchy->elements[i];
        r->y->response[i] = !e->vertices ? 0
                            : !p->options.camera
                                ? 1
                                : share_in_picture(rays_host(p->rays), p->options.camera, e);
    }
}

/* r of the surfaces made since the last call, which several ranks share out; what they carry starts
 * as their parents'. */
static void respond(struct importance *y, const struct light_operator *op)
{
    const struct element *elements = op->hierarchy->elements;
    const struct solve_options *o = &op->problem->options;
    const struct responding r = {y, op};
    uint32_t count = op->hierarchy->count;
    ranks_loop_run(o->ranks, RANKS_VALUES, o->threads, count - y->started, 64, take_shares, &r,
                   y->response + y->started, sizeof *y->response);
    for (uint32_t i = y->started; i < count; i++) {
        y->source[i] = elements[i].reflectance * y->response[i];
        y->carried[i] = !elements[i].vertices   ? 0
                        : elements[i].depth > 0 ? y->carried[elements[i].parent]
                                                : y->source[i];
        y->value[i] = y->response[i];
        y->irradiance[i] = 0;
    }
    y->started = count;
}

/* Means of what has children, and what the report says of the leaves. */
static void average(struct importance *y, const struct light_operator *op)
{
    const struct element *elements = op->hierarchy->elements;
    double whole = 0;
    for (uint32_t i = op->hierarchy->count; i-- > 0;) { /* children follow their parents */
        if (elements[i].children)
            y->value[i] = 0;
        for (int c = 0; c < elements[i].children; c++) {
            uint32_t j = elements[i].child + (uint32_t)c;
            y->value[i] += operator_share(op, j, i) * y->value[j];
        }
    }
    y->largest = y->seen = y->mean = 0;
    for (uint32_t i = 0; i < op->hierarchy->count; i++) {
        if (elements[i].children || !elements[i].vertices)
            continue;
        whole += elements[i].area;
        y->largest = fmax(y->largest, y->value[i]);
        y->mean += elements[i].area * y->value[i];
        y->seen += elements[i].area * y->response[i];
    }
    y->mean /= whole;
}

/* What the oracles see of it. */
static void mark_grown(const struct importance *y, struct hierarchy *h, struct oracle_inputs *in)
{
    for (uint32_t i = 0; i < h->count; i++) {
        double share = fmax(y->largest > 0 ? y->value[i] / y->largest : 1, IMPORTANCE_LEAST);
        in->changed[i] |=
            (unsigned char)oracle_inputs_follow(&h->elements[i].importance, share, HYSTERESIS, 0);
    }
}

int importance_start(struct importance *y, const struct light_operator *op, struct hierarchy *h,
                     struct oracle_inputs *in)
{
    if (ranks_any(op->problem->options.ranks, reserve_importance(y, h->count) < 0))
        return -1;
    respond(y, op);
    average(y, op);
    mark_grown(y, h, in);
    return 0;
}

int importance_open(struct importance *y, const struct light_operator *op,
                    struct transport *carried)
{
    if (ranks_any(op->problem->options.ranks, reserve_importance(y, op->hierarchy->count) < 0))
        return -1;
    respond(y, op);
    *carried = (struct transport){.bands = 1,
                                  .value = y->carried,
                                  .irradiance = y->irradiance,
                                  .source = y->source,
                                  .by_element = 1,
                                  .reflectance = op->problem->whitest,
                                  .tolerance = op->problem->options.tolerance};
    return 0;
}

void importance_update(struct importance *y, const struct light_operator *op, struct hierarchy *h,
                       struct oracle_inputs *in)
{
    for (uint32_t i = 0; i < h->count; i++)
        if (h->elements[i].vertices && !h->elements[i].children)
            y->value[i] =
                y->response[i] + (op->uncovered[i] > 0 ? y->irradiance[i] / op->uncovered[i] : 0);
    average(y, op);
    mark_grown(y, h, in);
}

void importance_free(struct importance *y)
{
    free(y->response);
    free(y->source);
    free(y->carried);
    free(y->irradiance);
    free(y->value);
}
