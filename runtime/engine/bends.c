/* bends.c - how far from linear over a receiver is what all its links bring it together.
 *
 * One link's light may bend over a receiver that all light evenly: over a floor, what one wall
 * brings grows where what the wall opposite brings falls, and in a white furnace each point
 * receives the same whatever each link does. So a receiver is not worth splitting for bends that
 * make up for each other. A link's bend is told from F at the receiver's centre and corners
 * (kernel/corner_factors.h); here it is that of the sum over links, each times what its emitter
 * sends, in the band where it is most. What comes by links of groups counts as even.
 *
 * It is for scenes in which nothing stands between any two faces. Elsewhere an element that waits
 * for what its links bring together is asked for rays before it is split, with a quarter or less of
 * those that its parts would cast, and what these miss is lost. Measured (cornell, room, panels,
 * maze_8, td, sejour): 3 to 8 % fewer links, 5 to 15 % more rays, the same error; and where only
 * later passes look at it 1 % fewer links.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/bends.h"
#include "kernel/constants.h"
#include "kernel/corner_factors.h"
#include "util/thread_pool.h"

enum { BANDS = 3 };

/* What arrives, by band: in the mean, at the centre, at the corners (W/m2). */
struct light_at {
    double mean[BANDS], point[5][BANDS];
};

struct bending {
    const struct light_operator *op;
    const double *radiosity;
    double *bend; /* [element] */
};

static void add_link(const struct bending *x, size_t link, struct light_at *at)
{
    const struct refinement *f = x->op->refinement;
    const struct link *l = &f->links[link];
    const struct element *elements = x->op->hierarchy->elements, *r = &elements[l->receiver];
    const double v = l->visibility * (1.0 / LINK_VISIBLE);
    const uint32_t bands = x->op->problem->bands;
    double factor[5];
    (void)corner_factors(r, &elements[l->emitter], factor);
    for (uint32_t k = 0; k < bands; k++) {
        const double b = v * x->radiosity[(size_t)l->emitter * bands + k];
        at->mean[k] += (double)l->form_factor * b;
        for (int i = 0; i < 1 + r->vertices; i++)
            at->point[i][k] += factor[i] * b;
    }
}

static double bend_of(const struct light_at *at, int corners, uint32_t bands)
{
    double most = 0;
    for (uint32_t k = 0; k < bands; k++) {
        double f[5];
        for (int i = 0; i < 1 + corners; i++)
            f[i] = at->point[i][k];
        most = fmax(most, corner_bend(f, corners, at->mean[k]));
    }
    return most;
}

static void measure(const void *bending, size_t from, size_t to)
{
    const struct bending *x = bending;
    const struct refinement *f = x->op->refinement;
    for (size_t e = from; e < to; e++) {
        const struct element *r = &x->op->hierarchy->elements[e];
        struct light_at at = {{0}, {{0}}};
        if (!r->vertices || !shares_mine(&x->op->shares, (uint32_t)e))
            continue;
        for (size_t i = f->first_link[e]; i < f->first_link[e + 1]; i++)
            if (x->op->hierarchy->elements[f->links[i].emitter].vertices)
                add_link(x, i, &at);
        x->bend[e] = bend_of(&at, r->vertices, x->op->problem->bands);
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
