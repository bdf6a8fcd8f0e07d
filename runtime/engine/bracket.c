/* bracket.c - see bracket.h.
 *
 * For each link, F V over the points of its receiver is between k and K: F by its bounds
 * (terms/form_factor_range.h), V by what a shaft has proved (tools/bracket.h); rays prove nothing.
 * So the least light that a point of a leaf can have is sum k L over its links and those of what
 * holds it, L the least below the emitter, and the most is sum K U.
 *
 * A point also sees no more than everything, sum F V <= 1, and where no light leaves the scene
 * exactly 1. Without that, rows beside edges, where K sums to 3 and more, would make upper
 * solutions diverge. The most of sum w U with k <= w <= K and sum w <= 1 is a fractional knapsack;
 * its dual bounds it without sorting the links of each leaf: for every level t >= 0
 *     sum w U <= t + sum of (U > t ? K : k) (U - t),
 * and the smallest of them over all t is the knapsack's value. The sums of LEVELS levels are handed
 * down from element to element as light is; a leaf takes the best. t = 0 is the plain sum. The same
 * from below, with (L > t ? k : K), where the leaf is closed; else t = 0 alone.
 *
 * Every sweep from a bound gives a bound, and the truth that they enclose does not change with the
 * links. So iteration begins with what the last pass left, may stop at any time, and the two
 * solutions only ever approach each other. A leaf's children begin with what it has.
 * Where groups are linked, all that is known of F V is that it is between 0 and 1.
 * [Lischinski, Smits and Greenberg 1994, lower and upper solutions; levels: derived here]
 * Fails: in half shadow V is anything from 0 to 1 at any size.
 *
 * Invariant: results do not depend on threads: a sweep reads the values of the one before.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/bracket.h"
#include "engine/winding.h"
#include "kernel/constants.h"
#include "terms/form_factor_range.h"
#include "tools/bracket.h"
#include "util/array.h"
#include "util/thread_pool.h"

enum { LEVELS = 16, SAMPLES = 1024, SWEEPS = 100 };

/* One of the two solutions while it is swept. */
struct bound_sweep {
    const struct bracket *bracket;
    const struct light_operator *op;
    double *value, *next; /* [element * bands + band] */
    int upper;
    double level[3][LEVELS]; /* t, by band; [0] is 0 */
};

/* By band and level, the sum over links. */
struct level_sums {
    double at[3][LEVELS];
};

static int reserve_bracket(struct bracket *b, uint32_t count, uint32_t bands)
{
    double **const lists[] = {&b->lower, &b->upper, &b->next};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        if (array_reserve_beside(lists[i], count, b->capacity, bands * sizeof **lists[i]) < 0)
            return -1;
    return array_reserve(&b->closed, count, &b->capacity, sizeof *b->closed);
}

int bracket_start(struct bracket *b, const struct light_operator *op, struct hierarchy *h)
{
    const struct problem *p = op->problem;
    double most[3] = {0, 0, 0}, rho[3] = {0, 0, 0};
    if (reserve_bracket(b, h->count, p->bands) < 0)
        return -1;
    for (uint32_t i = 0; i < h->face_count; i++)
        for (uint32_t k = 0; k < p->bands; k++) {
            most[k] = fmax(most[k], p->exitance[(size_t)i * p->bands + k]);
            rho[k] = fmax(rho[k], p->reflectance[(size_t)i * p->bands + k]);
        }
    for (uint32_t i = 0; i < h->count; i++) {
        struct element *e = &h->elements[i];
        for (uint32_t k = 0; k < p->bands && e->vertices; k++) {
            size_t at = (size_t)i * p->bands + k, face = (size_t)e->face * p->bands + k;
            b->lower[at] = p->exitance[face];
            b->upper[at] = p->exitance[face] + p->reflectance[face] * most[k] / (1 - rho[k]);
            e->lower = fmax(e->lower, b->lower[at]);
        }
    }
    b->started = h->count;
    return 0;
}

/* ---- what is known of each link */

/* F V of the link, wherever on the receiver: first cheaply, then as well as matters. */
static void find_range(const struct bracket *b, const struct light_operator *op, size_t link,
                       float range[2])
{
    const struct link *l = &op->refinement->links[link];
    const struct element *r = &op->hierarchy->elements[l->receiver],
                         *s = &op->hierarchy->elements[l->emitter];
    const uint32_t bands = op->problem->bands;
    double f[2], v[2], most = 0;
    range[0] = 0;
    range[1] = 1;
    if (!r->vertices || !s->vertices)
        return;
    struct terms terms;
    link_recall(l, &terms);
    bracket_visibility(terms.visibility, terms.visibility_level, v);
    form_factor_range_bound_to(r, s, 0, f);
    for (uint32_t k = 0; k < bands; k++)
        most = fmax(most, b->upper[(size_t)l->emitter * bands + k]);
    if (v[0] > 0
        && (f[1] - f[0]) * most
               > RANGE_FINE * RANGE_DETAIL * rays_host(op->problem->rays)->irradiance)
        form_factor_range_bound(r, s, f);
    range[0] = (float)(v[0] * f[0] * (1 - RANGE_ROUNDING));
    range[1] = (float)fmin(v[1] * f[1] * (1 + RANGE_ROUNDING), 1);
}

/* ---- sweeps */

static void add_links(const struct bound_sweep *w, uint32_t e, struct level_sums *sums)
{
    const struct refinement *r = w->op->refinement;
    const uint32_t bands = w->op->problem->bands;
    for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++) {
        const double low = (double)w->bracket->range[i][0], high = (double)w->bracket->range[i][1];
        const double *from = &w->value[(size_t)r->links[i].emitter * bands];
        for (uint32_t k = 0; k < bands; k++)
            for (int t = 0; t < LEVELS; t++) {
                double over = from[k] - w->level[k][t];
                sums->at[k][t] += ((over > 0) == w->upper ? high : low) * over;
            }
    }
}

/* The best of what all levels say of the leaf. */
static void take_best(const struct bound_sweep *w, uint32_t leaf, const struct level_sums *sums)
{
    const struct problem *p = w->op->problem;
    const uint32_t bands = p->bands, face = w->op->hierarchy->elements[leaf].face;
    for (uint32_t k = 0; k < bands; k++) {
        size_t at = (size_t)leaf * bands + k, of = (size_t)face * bands + k;
        double light = sums->at[k][0];
        for (int t = 1; t < LEVELS; t++) {
            double other = w->level[k][t] + sums->at[k][t];
            if (w->upper)
                light = fmin(light, other);
            else if (w->bracket->closed[leaf])
                light = fmax(light, other);
        }
        double x = p->exitance[of] + p->reflectance[of] * light;
        w->next[at] = w->upper ? fmin(w->value[at], x + BOUND_ROUNDING * x)
                               : fmax(w->value[at], x - BOUND_ROUNDING * x);
    }
}

static void sweep_below(const struct bound_sweep *w, uint32_t e, const struct level_sums *above)
{
    const struct element *x = &w->op->hierarchy->elements[e];
    struct level_sums sums = *above;
    add_links(w, e, &sums);
    for (int c = 0; c < x->children; c++)
        sweep_below(w, x->child + (uint32_t)c, &sums);
    if (!x->children)
        take_best(w, e, &sums);
}

/* The extreme of the uncovered leaves below each element that has children. */
static void gather_extremes(const struct bound_sweep *w)
{
    const struct hierarchy *h = w->op->hierarchy;
    const uint32_t bands = w->op->problem->bands;
    for (uint32_t i = h->count; i-- > 0;) { /* children follow their parents */
        const struct element *e = &h->elements[i];
        for (uint32_t k = 0; k < bands && e->children; k++) {
            double extreme = w->upper ? 0 : INFINITY;
            for (uint32_t c = e->child; c < e->child + e->children; c++) {
                double v = w->value[(size_t)c * bands + k];
                if (w->op->uncovered[c] > 0)
                    extreme = w->upper ? fmax(extreme, v) : fmin(extreme, v);
            }
            w->value[(size_t)i * bands + k] = extreme < INFINITY ? extreme : 0;
        }
    }
}

/* Levels: 0, and values that the leaves have, evenly from the least to the most. */
static void choose_levels(struct bound_sweep *w)
{
    const struct hierarchy *h = w->op->hierarchy;
    const uint32_t bands = w->op->problem->bands, step = h->count / SAMPLES + 1;
    double samples[SAMPLES + 1];
    for (uint32_t k = 0; k < bands; k++) {
        size_t n = 0;
        for (uint32_t i = 0; i < h->count && n <= SAMPLES; i += step)
            if (h->elements[i].vertices && w->op->uncovered[i] > 0)
                samples[n++] = w->value[(size_t)i * bands + k];
        qsort(samples, n, sizeof *samples, compare_numbers);
        for (size_t t = 0; t < LEVELS; t++)
            w->level[k][t] = t > 0 && n > 0 ? samples[(n - 1) * t / (LEVELS - 1)] : 0;
    }
}

/* sum A x over uncovered leaves, all bands (W). */
static double power_of(const struct light_operator *op, const double *x)
{
    const uint32_t bands = op->problem->bands;
    double sum = 0;
    for (uint32_t i = 0; i < op->hierarchy->count; i++)
        for (uint32_t k = 0; k < bands && operator_counts(op, i); k++)
            sum += op->hierarchy->elements[i].area * op->uncovered[i] * x[(size_t)i * bands + k];
    return sum;
}

static void sweep_faces(const void *sweep, size_t from, size_t to)
{
    const struct bound_sweep *w = sweep;
    const struct hierarchy *h = w->op->hierarchy;
    for (size_t i = from; i < to; i++) {
        struct level_sums above = {{{0}}};
        for (uint32_t e = h->face_element[i]; e;) {
            e = h->elements[e].parent;
            add_links(w, e, &above);
        }
        sweep_below(w, h->face_element[i], &above);
    }
}

/* One sweep: `next` of every leaf from `value` of every element, then `value`. */
static void sweep_bound(const struct bound_sweep *w)
{
    const struct hierarchy *h = w->op->hierarchy;
    const uint32_t bands = w->op->problem->bands;
    thread_pool_run(w->op->problem->options.threads, h->face_count, 8, sweep_faces, w);
    for (uint32_t i = 0; i < h->count; i++)
        if (h->elements[i].vertices && !h->elements[i].children)
            memcpy(&w->value[(size_t)i * bands], &w->next[(size_t)i * bands],
                   bands * sizeof *w->value);
    gather_extremes(w);
}

/* Sweep until a sweep brings little nearer to `other`, the other solution. */
static void solve_bound(struct bracket *b, const struct light_operator *op, int upper)
{
    struct bound_sweep w = {b, op, upper ? b->upper : b->lower, b->next, upper, {{0}}};
    double other = power_of(op, upper ? b->lower : b->upper), before = power_of(op, w.value);
    gather_extremes(&w);
    for (int n = 0; n < SWEEPS; n++) {
        choose_levels(&w);
        sweep_bound(&w);
        b->power[upper] = power_of(op, w.value);
        if (!(fabs(b->power[upper] - before) > BRACKET_ENOUGH * fabs(b->power[upper] - other)))
            break;
        before = b->power[upper];
    }
}

/* ---- what the oracles see */

/* How much nearer the two come where the parts of element i are taken one by one. */
static double gap_of(const struct bracket *b, const struct light_operator *op, uint32_t i)
{
    const struct element *e = &op->hierarchy->elements[i];
    const uint32_t bands = op->problem->bands;
    double widest = 0;
    for (uint32_t k = 0; k < bands && e->children; k++) {
        size_t at = (size_t)i * bands + k;
        double gap = b->upper[at] - b->lower[at];
        for (uint32_t c = e->child; c < e->child + e->children; c++) {
            size_t part = (size_t)c * bands + k;
            if (op->uncovered[c] > 0)
                gap -= operator_share(op, c, i) * (b->upper[part] - b->lower[part]);
        }
        widest = fmax(widest, gap);
    }
    return widest;
}

static void tell_oracles(const struct bracket *b, const struct light_operator *op,
                         struct hierarchy *h, struct oracle_inputs *in)
{
    const uint32_t bands = op->problem->bands;
    for (uint32_t i = 0; i < h->count; i++) {
        struct element *e = &h->elements[i];
        double lower = 0, gap = gap_of(b, op, i);
        for (uint32_t k = 0; k < bands; k++)
            lower = fmax(lower, b->lower[(size_t)i * bands + k]);
        int grew = lower > (1 + HYSTERESIS) * e->lower
                   || gap > (1 + HYSTERESIS) * e->gap + in->known * lower;
        in->changed[i] |= (unsigned char)grew;
        if (grew || lower < (1 - HYSTERESIS) * e->lower)
            e->lower = lower;
        if (grew || gap < (1 - HYSTERESIS) * e->gap)
            e->gap = gap;
    }
}

struct bracketing {
    const struct bracket *bracket;
    const struct light_operator *op;
};

static void find_ranges(const void *bracketing, size_t from, size_t to)
{
    const struct bracketing *w = bracketing;
    for (size_t i = from; i < to; i++)
        find_range(w->bracket, w->op, i, w->bracket->range[i]);
}

int bracket_update(struct bracket *b, const struct light_operator *op, struct hierarchy *h,
                   struct oracle_inputs *in)
{
    const uint32_t bands = op->problem->bands;
    const size_t links = op->refinement->link_count;
    if (reserve_bracket(b, h->count, bands) < 0)
        return -1;
    for (uint32_t i = b->started; i < h->count; i++)
        for (uint32_t k = 0; k < bands; k++) {
            size_t up = (size_t)h->elements[i].parent * bands + k, at = (size_t)i * bands + k;
            b->lower[at] = b->lower[up];
            b->upper[at] = b->upper[up];
        }
    b->started = h->count;
    free(b->range);
    b->range = malloc((links + 1) * sizeof *b->range);
    if (!b->range)
        return -1;
    const struct bracketing work = {b, op};
    thread_pool_run(op->problem->options.threads, links, 64, find_ranges, &work);
    winding_closed(h, op->uncovered, op->problem->options.threads, b->closed);
    solve_bound(b, op, 0);
    solve_bound(b, op, 1);
    b->solves++;
    tell_oracles(b, op, h, in);
    return 0;
}

void bracket_free(struct bracket *b)
{
    free(b->lower);
    free(b->upper);
    free(b->next);
    free(b->closed);
    free(b->range);
}
