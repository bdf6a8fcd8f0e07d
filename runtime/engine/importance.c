/* importance.c - the adjoint of light: Y = r + F V (rho Y), solved over the links that carry light.
 *
 * r is what a view asks for: 1 where a surface is in the picture, 0 where not; for a leaf the share of its points that
 * are. So Y of a place says how much of all that is seen changes with the light that leaves there: with areas as weights,
 * <r, B> = <Y, E>, as far as A_i F_ij = A_j F_ji holds. Z = rho Y obeys Z = rho r + rho F V Z, radiosity's own equation
 * with another source; so it is solved by the same sweeps (balance.c), and Y = r + what Z irradiates.
 *
 * Three bands are one here: rho is the largest. The oracles see Y as a share of its largest value (so scene.importance
 * is 1, with a view or without), at least LEAST, so that nothing divides by 0, and as stale as radiosity (publish.h).
 * At first they see r itself: what the picture does not hold is linked coarsely, and refined once the first
 * solve has said what it means for the picture.
 * Fails: 64 points may all miss the part of a large leaf that is in the picture; r is then 0 until something splits it.
 * [Smits, Arvo and Salesin 1992, sections 3 and 4]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/transport.h"
#include "engine/importance.h"
#include "engine/oracle_inputs.h"
#include "kernel/surface_point.h"

#define LEAST 1e-4
enum { SIDE = 8, POINTS = SIDE * SIDE };

/* The share of e's points that are in the picture: in front of the camera, turned to it, and nothing between. */
static double seen(const struct solve *s, const struct camera *c, const struct element *e)
{
    const struct host *host = rays_host(s->rays);
    struct segment segments[POINTS];
    uint64_t blocked;
    int i, k, count = 0, hits = 0;
    if (!(height3(c->eye, e->centre, e->normal) > 0))
        return 0;
    for (i = 0; i < POINTS; i++) {
        struct segment *g = &segments[count];
        double v[3], depth;
        surface_point(g->from, e, (i % SIDE + 0.5) / SIDE, (i / SIDE + 0.5) / SIDE);
        for (k = 0; k < 3; k++)
            g->from[k] += host->ray_offset * e->normal[k];
        sub3(v, g->from, c->eye);
        depth = dot3(v, c->ahead);
        if (!(depth > 0) || fabs(dot3(v, c->right)) > c->wide * depth || fabs(dot3(v, c->up)) > c->high * depth)
            continue;
        for (k = 0; k < 3; k++)
            g->to[k] = c->eye[k];
        count++;
    }
    if (count == 0)
        return 0;
    blocked = host->occluded(host, count, segments);
    for (i = 0; i < count; i++)
        hits += !(blocked >> i & 1);
    return hits / (double)POINTS;
}

/* Room for all elements. Returns 0 or -1. */
static int enlarge(struct importance *y, uint32_t count)
{
    double **const lists[] = { &y->response, &y->source, &y->carried, &y->irradiance, &y->value };
    size_t room = (size_t)count + count / 4, i;
    if (count <= y->room)
        return 0;
    for (i = 0; i < sizeof lists / sizeof *lists; i++) {
        double *moved = realloc(*lists[i], room * sizeof *moved);
        if (!moved)
            return -1;
        *lists[i] = moved;
    }
    y->room = (uint32_t)(room > UINT32_MAX ? UINT32_MAX : room);
    return 0;
}

/* r of the surfaces made since the last call; what they carry starts as their parents'. */
static void respond(struct solve *s)
{
    struct importance *y = &s->importance;
    const struct element *elements = s->hierarchy.elements;
    uint32_t i;
#pragma omp parallel for schedule(dynamic, 64) num_threads(s->options.threads)
    for (i = y->started; i < s->hierarchy.count; i++)
        y->response[i] = elements[i].vertices ? seen(s, s->options.camera, &elements[i]) : 0;
    for (i = y->started; i < s->hierarchy.count; i++) {
        y->source[i] = elements[i].reflectance * y->response[i];
        y->carried[i] = elements[i].vertices ? elements[i].depth > 0 ? y->carried[elements[i].parent] : y->source[i] : 0;
        y->value[i] = y->response[i];
        y->irradiance[i] = 0;
    }
    y->started = s->hierarchy.count;
}

/* Means of what has children, then what the oracles see of everything. */
static void show(struct solve *s)
{
    struct importance *y = &s->importance;
    struct element *elements = s->hierarchy.elements;
    double whole = 0;
    uint32_t i;
    int c;
    for (i = s->hierarchy.count; i-- > 0;) { /* children follow their parents */
        if (elements[i].children)
            y->value[i] = 0;
        for (c = 0; c < elements[i].children; c++)
            y->value[i] += balance_share(s, elements[i].child + (uint32_t)c, i) * y->value[elements[i].child + (uint32_t)c];
    }
    y->largest = y->seen = y->mean = 0;
    for (i = 0; i < s->hierarchy.count; i++) {
        if (elements[i].children || !elements[i].vertices)
            continue;
        whole += elements[i].area;
        y->largest = y->value[i] > y->largest ? y->value[i] : y->largest;
        y->mean += elements[i].area * y->value[i];
        y->seen += elements[i].area * y->response[i];
    }
    y->mean /= whole;
    for (i = 0; i < s->hierarchy.count; i++) {
        double share = y->largest > 0 ? y->value[i] / y->largest : 1;
        share = share > LEAST ? share : LEAST;
        if (share > (1 + STALE) * elements[i].importance)
            s->changed[i] = 1;
        else if (share >= (1 - STALE) * elements[i].importance)
            continue;
        elements[i].importance = share;
    }
}

int importance_start(struct solve *s)
{
    if (enlarge(&s->importance, s->hierarchy.count) < 0)
        return -1;
    respond(s);
    show(s);
    return 0;
}

int importance_solve(struct solve *s)
{
    struct importance *y = &s->importance;
    struct balance carried;
    double residual = s->residual;
    uint32_t i;
    if (enlarge(y, s->hierarchy.count) < 0)
        return -1;
    respond(s);
    memset(&carried, 0, sizeof carried);
    carried.bands = 1;
    carried.value = y->carried;
    carried.irradiance = y->irradiance;
    carried.source = y->source;
    carried.by_element = 1;
    carried.reflectance = s->whitest;
    carried.tolerance = s->options.tolerance;
    if (balance_solve(s, &carried) < 0)
        return -1;
    s->residual = residual; /* the summary's is that of radiosity */
    s->converged = s->converged && carried.converged;
    y->sweeps += carried.sweeps;
    for (i = 0; i < s->hierarchy.count; i++)
        if (s->hierarchy.elements[i].vertices && !s->hierarchy.elements[i].children)
            y->value[i] = y->response[i] + (s->exposed[i] > 0 ? y->irradiance[i] / s->exposed[i] : 0);
    show(s);
    return 0;
}

void importance_free(struct solve *s)
{
    free(s->importance.response);
    free(s->importance.source);
    free(s->importance.carried);
    free(s->importance.irradiance);
    free(s->importance.value);
}
