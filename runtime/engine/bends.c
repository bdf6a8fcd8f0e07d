/* bends.c - how far from linear over a receiver is what all its links bring it together.
 *
 * One link's light may bend over a receiver that all light evenly: over a floor, what one wall
 * brings grows where what the wall opposite brings falls, and in a white furnace each point
 * receives the same whatever each link does. So a receiver is not worth splitting for bends that
 * make up for each other. A link's bend is told from F at the receiver's centre and corners
 * (kernel/corner_factors.h); here it is that of the sum over links, each times what its emitter
 * sends, in the band where it is most. What comes by links of groups counts as even.
 *
 * Centre and corners do not see what is odd about the centre, or repeats: under a low ceiling of
 * strips, bright and dark in turn, what each strip brings bends and their sum is the same at all
 * five. So the sum is looked at INSIDE, too, at a point by chance in each of sixteen parts of the
 * receiver: what the best linear function of these leaves, root mean square, is a bend. Of one
 * link they are not needed: its light has one peak.
 *
 * It is for scenes in which nothing stands between any two faces. Elsewhere an element that waits
 * for what its links bring together is asked for rays before it is split, with a quarter or less of
 * those that its parts would cast, and what these miss is lost. Measured (cornell, room, panels,
 * maze_8, td, sejour): 3 to 8 % fewer links, 5 to 15 % more rays, the same error; and where only
 * later passes look at it 1 % fewer links. Fails: light that is even but for spots smaller than a
 * sixteenth of the receiver, which make up for each other.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/bends.h"
#include "kernel/constants.h"
#include "kernel/corner_factors.h"
#include "kernel/hash.h"
#include "util/thread_pool.h"

enum { BANDS = 3, PARTS = 4, INSIDE = PARTS * PARTS, AT_ONCE = 8 };
_Static_assert((int)AT_ONCE <= (int)LAMBERT_POINTS && INSIDE % AT_ONCE == 0, "taken in turn");

/* What arrives, by band: in the mean, at the centre and the corners, inside (W/m2). */
struct light_at {
    double mean[BANDS], point[5][BANDS], inside[INSIDE][BANDS];
};

struct bending {
    const struct light_operator *op;
    const double *radiosity;
    double *bend; /* [element] */
};

/* One by chance in each part of r, in its plane. */
static void points_inside(const struct element *r, double x[INSIDE][3])
{
    for (int i = 0; i < INSIDE; i++) {
        const double s = hash_unit(r->id + (uint64_t)(2 * i) * HASH_STEP),
                     t = hash_unit(r->id + (uint64_t)(2 * i + 1) * HASH_STEP);
        surface_even_point(x[i], r, (i / PARTS + s) / PARTS, (i % PARTS + t) / PARTS);
    }
}

static void add_link(const struct bending *x, size_t link, const double (*inside)[3],
                     struct light_at *at)
{
    const struct refinement *f = x->op->refinement;
    const struct link *l = &f->links[link];
    const struct element *elements = x->op->hierarchy->elements, *r = &elements[l->receiver];
    const double v = l->visibility * (1.0 / LINK_VISIBLE);
    const uint32_t bands = x->op->problem->bands;
    double factor[5], within[INSIDE];
    struct polygon front;
    corner_factors_in(r, &elements[l->emitter], &front, factor);
    for (int i = 0; i < INSIDE; i += AT_ONCE)
        point_factors_at(AT_ONCE, &inside[i], r, &elements[l->emitter], &front, &within[i]);
    for (uint32_t k = 0; k < bands; k++) {
        const double b = v * x->radiosity[(size_t)l->emitter * bands + k];
        at->mean[k] += (double)l->form_factor * b;
        for (int i = 0; i < 1 + r->vertices; i++)
            at->point[i][k] += factor[i] * b;
        for (int i = 0; i < INSIDE; i++)
            at->inside[i][k] += within[i] * b;
    }
}

/* Take from f[INSIDE] its share in `by`. */
static void take_away(double f[INSIDE], const double by[INSIDE])
{
    double both = 0, square = 0;
    for (int i = 0; i < INSIDE; i++) {
        both += f[i] * by[i];
        square += by[i] * by[i];
    }
    for (int i = 0; i < INSIDE && square > 0; i++)
        f[i] -= both / square * by[i];
}

/* What 1, and how far to two sides, leave of each other: orthogonal over the points. */
static void linear_inside(const struct element *r, const double (*x)[3], double base[3][INSIDE])
{
    double side[2][3];
    sub3(side[0], r->vertex[1], r->vertex[0]);
    sub3(side[1], r->vertex[2], r->vertex[1]);
    for (int i = 0; i < INSIDE; i++) {
        double away[3];
        sub3(away, x[i], r->centre);
        base[0][i] = 1;
        base[1][i] = dot3(away, side[0]);
        base[2][i] = dot3(away, side[1]);
    }
    take_away(base[1], base[0]);
    take_away(base[2], base[0]);
    take_away(base[2], base[1]);
}

/* What no linear function takes up of f, root mean square. */
static double rest_of(const double base[3][INSIDE], double f[INSIDE])
{
    double square = 0;
    for (int k = 0; k < 3; k++)
        take_away(f, base[k]);
    for (int i = 0; i < INSIDE; i++)
        square += f[i] * f[i];
    return sqrt(square / INSIDE);
}

static double bend_of(const struct light_at *at, const double base[3][INSIDE], int corners,
                      uint32_t bands)
{
    double most = 0;
    for (uint32_t k = 0; k < bands; k++) {
        double f[5], inside[INSIDE];
        for (int i = 0; i < 1 + corners; i++)
            f[i] = at->point[i][k];
        for (int i = 0; i < INSIDE; i++)
            inside[i] = at->inside[i][k];
        most = fmax(most, fmax(corner_bend(f, corners, at->mean[k]), rest_of(base, inside)));
    }
    return most;
}

static void measure(const void *bending, size_t from, size_t to)
{
    const struct bending *x = bending;
    const struct refinement *f = x->op->refinement;
    for (size_t e = from; e < to; e++) {
        const struct element *r = &x->op->hierarchy->elements[e];
        struct light_at at = {{0}, {{0}}, {{0}}};
        double inside[INSIDE][3], base[3][INSIDE];
        if (!r->vertices || f->first_link[e] == f->first_link[e + 1]
            || !shares_mine(&x->op->shares, (uint32_t)e))
            continue;
        points_inside(r, inside);
        linear_inside(r, (const double(*)[3])inside, base);
        for (size_t i = f->first_link[e]; i < f->first_link[e + 1]; i++)
            if (x->op->hierarchy->elements[f->links[i].emitter].vertices)
                add_link(x, i, (const double(*)[3])inside, &at);
        x->bend[e] =
            bend_of(&at, (const double(*)[INSIDE])base, r->vertices, x->op->problem->bands);
    }
}

int bends_update(struct oracle_inputs *in, struct light_operator *op, const double *radiosity,
                 struct hierarchy *h)
{
    double *bend = calloc(h->count, sizeof *bend);
    if (ranks_any(op->problem->options.ranks, !bend)) {
        free(bend);
        return -1;
    }
    const struct bending x = {op, radiosity, bend};
    thread_pool_run(operator_threads(op), h->count, 256, measure, &x);
    if (shares_complete(&op->shares, bend, 1) < 0) {
        free(bend);
        return -1;
    }
    for (uint32_t i = 0; i < h->count; i++) {
        struct element *e = &h->elements[i];
        double seen = (double)e->bend;
        in->changed[i] |= (unsigned char)oracle_inputs_follow(&seen, bend[i], HYSTERESIS,
                                                              in->known * e->radiosity);
        e->bend = (float)seen;
    }
    free(bend);
    return 0;
}
