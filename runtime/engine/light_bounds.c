/* light_bounds.c - see light_bounds.h.
 *
 * For given radiosities the most light that a leaf's ranges allow is a fractional knapsack: shares
 * begin at their least, and what is left of the 1 that all sum to goes to the brightest first, as
 * far as each, and each face's group of them, can take. The least light is the same with the
 * darkest first where the leaf is closed; else what is left may go to the dark outside. Each is the
 * extreme of a linear function over a laminar polymatroid, so greed is exact.
 *
 * T, from x to source + rho (that light), is monotone, and as shares sum to no more than 1 it takes
 * y + c to no more than T(y) + rho c. So with c = max (T(y) - y) / (1 - max rho), and any y at all,
 *     T(y + c) <= T(y) + rho c <= y + c:
 * y + c lies above the fixed point, and so does T(y) + rho c, which is the result. The closer y the
 * tighter; it is improved by Howard's policy iteration: with the weights that greed chose the
 * equation is linear, and swept alone.
 * [Howard 1960; Lischinski, Smits and Greenberg 1994 for bounds on radiosity; derived here]
 *
 * Invariant: results do not depend on threads: leaves are swept all at once, and each leaf's shares
 * are sorted by value, equal ones by element.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "engine/light_bounds.h"
#include "kernel/constants.h"
#include "util/thread_pool.h"

enum { POLICIES = 12, SWEEPS = 400, GROUPS = 64, RUN = 64 };

struct bounding {
    const struct light_bounds *b;
    const struct hierarchy *h;
    const double *uncovered;
    double *value; /* [element]: y at leaves, its extreme below clusters and split surfaces */
    double *next;  /* [element]: leaves */
    double *most;  /* [run of RUN elements]: by how much a sweep has changed one (W/m2) */
    int least, linked;
    atomic_int *failed;
};

/* ---- shares of one leaf */

static int comes_after(const struct bounding *g, const struct share *a, const struct share *b)
{
    double x = g->value[a->emitter], y = g->value[b->emitter];
    return x != y ? (g->least ? x > y : x < y) : a->emitter > b->emitter;
}

/* Sift down for heapsort, whose heap has the last at its top. */
static void sift(const struct bounding *g, struct share *s, size_t at, size_t n)
{
    struct share moved = s[at];
    for (size_t child; (child = 2 * at + 1) < n; at = child) {
        child += child + 1 < n && comes_after(g, &s[child + 1], &s[child]);
        if (!comes_after(g, &s[child], &moved))
            break;
        s[at] = s[child];
    }
    s[at] = moved;
}

/* By value, the first to be served first. Mostly it is sorted from the last time. */
static void sort_shares(const struct bounding *g, struct share *s, size_t n)
{
    size_t moves = 0, i;
    for (i = 1; i < n && moves < 8 * n; i++) {
        struct share moved = s[i];
        size_t j = i;
        for (; j > 0 && comes_after(g, &s[j - 1], &moved); j--)
            s[j] = s[j - 1];
        s[j] = moved;
        moves += i - j;
    }
    if (i >= n)
        return;
    for (i = n / 2; i-- > 0;)
        sift(g, s, i, n);
    for (i = n; i-- > 1;) {
        struct share swap = s[0];
        s[0] = s[i];
        s[i] = swap;
        sift(g, s, 0, i);
    }
}

static double low_of(const struct bounding *g, const struct share *s)
{
    return s->visible ? (double)s->low : g->linked ? (double)s->low * (double)s->linked : 0;
}

static double high_of(const struct bounding *g, const struct share *s)
{
    return !s->visible && g->linked ? (double)s->high * (double)s->linked : (double)s->high;
}

/* What each face's group may still take, and must. */
struct purse {
    double room, due;
};

/* Serve the shares in their order; weights are set. purses: [groups]. Returns the irradiance. */
static double allot(const struct bounding *g, const struct share_row *row, int closed,
                    struct purse *purses)
{
    double total = 0, light = 0, scale = 1;
    for (uint32_t i = 0; i < row->group_count; i++)
        purses[i] = (struct purse){(double)row->groups[i].high,
                                   row->groups[i].visible ? (double)row->groups[i].low : 0};
    for (uint32_t i = 0; i < row->share_count; i++)
        total += low_of(g, &row->shares[i]);
    if (total > 1) /* rounding; or links that see too much, which prove nothing */
        scale = total < 1 + 1e-6 ? 1 / total : 0;
    total = 0;
    for (uint32_t i = 0; i < row->share_count; i++) {
        struct share *s = &row->shares[i];
        double low = scale * low_of(g, s);
        s->weight = (float)low;
        total += low;
        light += low * g->value[s->emitter];
        if (s->group) {
            purses[s->group - 1].room -= low;
            purses[s->group - 1].due -= low;
        }
    }
    for (int must = 1; must >= 0; must--) {
        if (!must && g->least && !closed)
            break;
        for (uint32_t i = 0; i < row->share_count && total < 1; i++) {
            struct share *s = &row->shares[i];
            double more = fmin(high_of(g, s) - (double)s->weight, 1 - total);
            if (must && !s->group)
                continue;
            if (s->group)
                more = fmin(more, must ? purses[s->group - 1].due : purses[s->group - 1].room);
            if (!(more > 0))
                continue;
            if (s->group) {
                purses[s->group - 1].room -= more;
                purses[s->group - 1].due -= more;
            }
            s->weight += (float)more;
            total += more;
            light += more * g->value[s->emitter];
        }
    }
    return light;
}

/* ---- sweeps */

static int counts(const struct bounding *g, uint32_t e)
{
    return operator_counts(g->b->ranges->op, e);
}

/* The extreme of the uncovered leaves below each element, from those of the leaves; 0 where there
 * is none. */
static void gather_extremes(const struct bounding *g)
{
    for (uint32_t e = g->h->count; e-- > 0;) { /* children follow their parents */
        const struct element *x = &g->h->elements[e];
        double extreme = 0;
        int some = 0;
        if (!x->children) {
            g->value[e] = g->uncovered[e] > 0 ? g->value[e] : 0;
            continue;
        }
        for (uint32_t c = x->child; c < x->child + x->children; c++) {
            if (!(g->uncovered[c] > 0))
                continue;
            double v = g->value[c];
            extreme = !some ? v : g->least ? fmin(extreme, v) : fmax(extreme, v);
            some = 1;
        }
        g->value[e] = extreme;
    }
}

static int threads_of(const struct bounding *g)
{
    return g->b->ranges->op->problem->options.threads;
}

static void apply_to_leaves(const void *bounding, size_t from, size_t to)
{
    const struct bounding *g = bounding;
    const struct light_bounds *b = g->b;
    for (uint32_t i = (uint32_t)from; i < to; i++) {
        const struct share_row *row = &b->ranges->rows[i];
        struct purse few[GROUPS], *purses = few;
        if (!counts(g, i))
            continue;
        if (row->group_count > GROUPS)
            purses = malloc(row->group_count * sizeof *purses);
        if (!purses) {
            *g->failed = 1;
            continue;
        }
        sort_shares(g, row->shares, row->share_count);
        double light = allot(g, row, b->ranges->closed[i], purses);
        if (b->irradiance)
            b->irradiance[i] = light;
        g->next[i] = b->source[i] + b->rho[g->h->elements[i].face] * light;
        if (purses != few)
            free(purses);
    }
}

/* T(y) into next, and weights anew. Returns -1 when out of memory. */
static int apply(const struct bounding *g)
{
    thread_pool_run(threads_of(g), g->h->count, 16, apply_to_leaves, g);
    return *g->failed ? -1 : 0;
}

static void sweep_leaves(const void *bounding, size_t from, size_t to)
{
    const struct bounding *g = bounding;
    const struct light_bounds *b = g->b;
    double most = 0;
    for (uint32_t i = (uint32_t)from; i < to; i++) {
        const struct share_row *row = &b->ranges->rows[i];
        double light = 0;
        if (!counts(g, i))
            continue;
        for (uint32_t k = 0; k < row->share_count; k++)
            light += (double)row->shares[k].weight * g->value[row->shares[k].emitter];
        g->next[i] = b->source[i] + b->rho[g->h->elements[i].face] * light;
        most = fmax(most, fabs(g->next[i] - g->value[i]));
    }
    g->most[from / RUN] = most;
}

/* Sweep with the weights as they are until it changes little beside what is there to be found, in
 * the mean. */
static void bracket_until(const struct bounding *g, double enough)
{
    double most = INFINITY;
    for (int n = 0; n < SWEEPS && most > enough; n++) {
        most = 0;
        gather_extremes(g);
        thread_pool_run(threads_of(g), g->h->count, RUN, sweep_leaves, g);
        for (uint32_t i = 0; i < g->h->count; i += RUN)
            most = fmax(most, g->most[i / RUN]);
        for (uint32_t i = 0; i < g->h->count; i++)
            if (counts(g, i))
                g->value[i] = g->next[i];
    }
}

/* How far T(y) is beyond y, at the most; *moved: mean over the area of |T(y) - start|, beside which
 * the result is good to know, and of what rounding of weights would leave alone. */
static double overshoot(const struct bounding *g, double *moved)
{
    double most = 0, sum = 0, area = 0;
    for (uint32_t i = 0; i < g->h->count; i++) {
        if (!counts(g, i))
            continue;
        double a = g->h->elements[i].area, start = g->b->start ? g->b->start[i] : 0;
        most = fmax(most, g->least ? g->value[i] - g->next[i] : g->next[i] - g->value[i]);
        sum += a * (fabs(g->next[i] - start) + BOUND_WEIGHTS / BOUND_ENOUGH * fabs(g->next[i]));
        area += a;
    }
    *moved = area > 0 ? sum / area : 0;
    return most;
}

static void finish(const struct bounding *g, double beyond)
{
    const struct light_bounds *b = g->b;
    for (uint32_t i = 0; i < g->h->count; i++) {
        double rho = b->rho[g->h->elements[i].face], rounding = BOUND_ROUNDING * fabs(g->next[i]);
        if (!counts(g, i))
            continue;
        g->value[i] = g->least ? fmax(b->source[i], g->next[i] - rho * beyond - rounding)
                               : g->next[i] + rho * beyond + rounding;
        if (b->irradiance)
            b->irradiance[i] = g->least ? fmax(0, b->irradiance[i] - beyond)
                                        : b->irradiance[i] + beyond + rounding;
    }
    gather_extremes(g);
}

int light_bounds_solve(const struct light_bounds *b)
{
    const struct light_operator *op = b->ranges->op;
    struct bounding g = {.b = b,
                         .h = op->hierarchy,
                         .uncovered = op->uncovered,
                         .value = b->x,
                         .least = b->of == LIGHT_LEAST || b->of == LIGHT_LEAST_LINKED,
                         .linked = b->of == LIGHT_MOST_LINKED || b->of == LIGHT_LEAST_LINKED};
    double beyond = 0, moved;
    atomic_int failed = 0;
    g.failed = &failed;
    g.next = malloc(g.h->count * sizeof *g.next);
    g.most = malloc((g.h->count / RUN + 1) * sizeof *g.most);
    if (!g.next || !g.most) {
        free(g.next);
        free(g.most);
        return -1;
    }
    for (uint32_t i = 0; i < g.h->count; i++)
        g.value[i] = counts(&g, i) ? b->start ? b->start[i] : b->source[i] : 0;
    for (int n = 0; n < POLICIES; n++) {
        gather_extremes(&g);
        if (apply(&g) < 0) {
            free(g.next);
            free(g.most);
            return -1;
        }
        beyond = overshoot(&g, &moved) / (1 - b->rho_most);
        if (beyond <= BOUND_ENOUGH * moved || n == POLICIES - 1)
            break;
        bracket_until(&g, 0.25 * BOUND_ENOUGH * (1 - b->rho_most) * moved);
    }
    finish(&g, beyond);
    free(g.next);
    free(g.most);
    return 0;
}
