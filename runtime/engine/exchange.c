/* exchange.c - the view factors of a scene.
 *
 * A tree of flat groups (exchange_tree.c) is refined by an oracle with B = 1 on every face; its
 * links become exchange areas of faces (exchange_areas.c). Faces count as in the input: one with
 * two sides, or cut into parts, is one row, a mean over its parts. A row lacks something where
 * light leaves the scene or meets a black back, or by error; which of these, rays say
 * (visibility/environment.h). Rows that sum to 1 within the tolerance need none, unless closure
 * must know: what they lack is less than what they may be wrong by. A row that exceeds 1, or lacks
 * what no ray finds, by more than chance explains has an entry that the rules of points misjudged:
 * all of its entries are looked at again (exchange_again.h).
 * Invariant: of a row that rays find a way out for, the sum and its losses make 1, unless the sum
 * is more.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/exchange.h"
#include "engine/exchange_again.h"
#include "engine/exchange_product.h"
#include "kernel/constants.h"
#include "util/clock.h"
#include "util/ranks_loop.h"
#include "visibility/environment.h"

/* Bytes of values that are kept though they could be made anew, where nobody says. */
#define KEPT ((size_t)1 << 29)

/* The error of half shadow falls with what is left to it. Pairs of faces are not split for it: each
 * is integrated (engine/exchange_sight.h). Those in clear view have all their digits made anew from
 * the link (engine/exchange_blocks.h), which need not have them. */
void exchange_set_tolerance(struct refiner *refiner, double tolerance)
{
    for (int i = -1; (i = refiner_find_role(refiner, ROLE_SHADOW_TOLERANCE, i)) >= 0;)
        (void)refiner_set(refiner, refiner->parameters[i].name,
                          refiner_get(refiner, i) * tolerance / EXCHANGE_TOLERANCE, NULL);
    (void)refiner_set(refiner, "shadow", INFINITY, NULL);
    (void)refiner_set(refiner, "cut_out", INFINITY, NULL);
    (void)refiner_set(refiner, "exact", INFINITY, NULL);
}

struct watcher {
    struct exchange *exchange;
    const struct exchange_options *options;
};

static int tell(struct watcher *w, const char *phase)
{
    const struct exchange_options *o = w->options;
    struct exchange *x = w->exchange;
    const int no_more =
        o->progress && o->progress(o->context, x, x->resumed ? "resumed" : phase) != 0;
    x->cancelled = ranks_any(x->ranks, x->cancelled || no_more);
    x->resumed = 0;
    return x->cancelled;
}

static int tell_share(void *context, double share)
{
    struct watcher *w = context;
    w->exchange->share = share;
    return tell(w, w->exchange->phase);
}

static int watch_round(void *context, const struct refinement *refinement)
{
    struct watcher *w = context;
    (void)refinement;
    return tell(w, "refine") != 0
           || (exchange_state_ask(&w->exchange->state)
               && exchange_state_put(&w->exchange->state, NULL, NULL, 0, 0));
}

/* From a state that waits, or from the start. */
static int refine(struct exchange *x, const struct refiner *refiner, struct watcher *watcher,
                  const struct exchange_aim *how)
{
    const struct limits limits = limits_complete((struct limits){0}, x->ranks);
    if (ranks_any(x->ranks, refinement_open(&x->refinement, &x->tree.h, &x->tree.host, refiner,
                                            limits, watcher->options->threads)
                                < 0))
        return -1;
    x->refinement.watch = watch_round;
    x->refinement.watch_context = watcher;
    x->refinement.deal = ranks_count(x->ranks) > 1 ? x->ranks : NULL;
    exchange_state_open(&x->state, watcher->options->state, &x->tree, &x->refinement, how);
    if (!x->state.waits)
        return refinement_start(&x->refinement);
    if (exchange_state_read(&x->state, &x->refinement) < 0)
        return -1;
    x->resumed = 1;
    /* what has values, of which the first to be told knows how many */
    if (!x->state.head.blocks && tell(watcher, "resumed") != 0)
        return -1;
    return refinement_resume(&x->refinement);
}

/* Where the row's light goes that meets no front: shares of all rays. */
static struct exchange_loss ask_row(const struct exchange *x, uint32_t i,
                                    struct environment_grid grid)
{
    const struct exchange_areas *m = &x->areas;
    double leaves = 0, backs = 0, covered = 0;
    for (uint32_t p = m->first[i]; p != UINT32_MAX; p = m->next[p]) {
        const struct element *e = exchange_tree_face(&x->tree, p);
        struct environment f = environment_of(x->tree.rays, e, grid);
        double ray = e->area / (f.fronts + f.leaves + f.backs + f.covered);
        leaves += ray * f.leaves;
        backs += ray * f.backs;
        covered += ray * f.covered;
    }
    return (struct exchange_loss){leaves / m->area[i], backs / m->area[i], covered / m->area[i]};
}

/* Rays say which ways there are, and how they share it; how much is lost, the row knows better. */
static void share_out(struct exchange_loss *way, double lacks)
{
    double seen = way->leaves + way->backs, left = fmax(lacks, 0);
    way->covered = seen > 0 ? fmin(way->covered, left) : way->covered > 0 ? left : 0;
    left -= way->covered;
    way->leaves *= seen > 0 ? left / seen : 0;
    way->backs *= seen > 0 ? left / seen : 0;
}

static int is_closed(const struct exchange_loss *way)
{
    return !(way->leaves > 0) && !(way->backs > 0) && !(way->covered > 0);
}

/* The account of rows: what they sum to, and what becomes of the light that they lack.
 * closed[i]: row i ought to sum to 1. */
static void account(struct exchange *x, const double *share, unsigned char *closed)
{
    struct exchange_report *r = &x->report;
    const struct exchange_areas *m = &x->areas;
    double all = 0;
    r->low = INFINITY;
    for (uint32_t i = 0; i < m->rows; i++) {
        struct exchange_loss *way = &x->losses[i];
        double defect = fabs(1 - share[i]);
        int open = way->leaves > 0, backs = way->backs > 0;
        closed[i] = (unsigned char)is_closed(way);
        if (!(m->area[i] > 0))
            continue;
        all += m->area[i];
        r->low = fmin(r->low, share[i]);
        r->high = fmax(r->high, share[i]);
        share_out(way, 1 - share[i]);
        r->rows_open += (unsigned)open;
        r->rows_backs += (unsigned)backs;
        r->rows_covered += way->covered > 0;
        r->environment_mean += m->area[i] * way->leaves;
        r->environment_most = fmax(r->environment_most, way->leaves);
        r->backs_mean += m->area[i] * way->backs;
        r->backs_most = fmax(r->backs_most, way->backs);
        if ((closed[i] ? defect : share[i] - 1) > r->worst) {
            r->worst = defect;
            r->worst_row = i;
        }
        if (closed[i]) {
            r->rows_closed++;
            r->defect_mean += defect;
            r->defect_most = fmax(r->defect_most, defect);
        }
    }
    if (isinf(r->low))
        r->low = 0;
    r->defect_mean /= r->rows_closed ? r->rows_closed : 1;
    r->environment_mean /= all > 0 ? all : 1;
    r->backs_mean /= all > 0 ? all : 1;
}

/* Closure changes what open rows sum to a little; their losses still make up for it. */
static int follow_closure(struct exchange *x, double *sums)
{
    const struct exchange_areas *m = &x->areas;
    const struct exchange_closure *c = &x->closure;
    if (!c->scale)
        return 0;
    if (exchange_sums(m, x->threads, c->both ? c->scale : NULL, sums) < 0)
        return -1;
    for (uint32_t i = 0; i < m->rows; i++)
        if (m->area[i] > 0)
            share_out(&x->losses[i], 1 - c->scale[i] * sums[i] / m->area[i]);
    return 0;
}

/* Rows that may have to be asked where their light goes. */
struct asking {
    const struct exchange *exchange;
    const struct exchange_options *options;
    const double *share;        /* [input] */
    const double *before;       /* [input]: by which they were asked already; NULL: they were not */
    struct exchange_loss *ways; /* [input] */
};

/* Must rays say where the light goes of a row of that sum? */
static int is_open_to_ask(const struct asking *a, double share)
{
    return a->options->closure != CLOSURE_NONE || !(fabs(1 - share) <= a->options->tolerance);
}

/* And have they not said so yet? */
static int is_asked(const struct asking *a, size_t i)
{
    return a->exchange->areas.area[i] > 0 && is_open_to_ask(a, a->share[i])
           && !(a->before && is_open_to_ask(a, a->before[i]));
}

/* Of a row, the share that solids stand on. */
static double share_under_bodies(const struct exchange *x, uint32_t i)
{
    const struct exchange_tree *t = &x->tree;
    double covered = 0;
    for (uint32_t p = x->areas.first[i]; p != UINT32_MAX; p = x->areas.next[p])
        covered += t->bodies.covered[t->h.face_element[t->h.order[p]]];
    return covered / x->areas.area[i];
}

/* Rays say what is covered to half a row of so many points; what solids cover is known, also where
 * it falls between them. More than rays found is known of points in something solid on which lies
 * something else: rays from there end between the two, and do not tell that they met backs alone.
 * The backs that they did meet were there. */
static void know_covered(struct exchange_loss *way, double covered, int side)
{
    const double off = 0.5 / side, more = covered - way->covered;
    if (!(covered > 0) || more <= -off)
        return;
    way->covered = covered;
    if (more >= off)
        way->backs = way->backs - more > off ? way->backs - more : 0;
}

/* Where it goes, with what is known of solids: they stand on that share of the row. */
static struct exchange_loss ask_knowing(const struct exchange *x, uint32_t i,
                                        struct environment_grid grid, double covered)
{
    struct exchange_loss way = ask_row(x, i, grid);
    know_covered(&way, covered, grid.side);
    return way;
}

/* Do few points alone tell what of row i's light is covered and what goes elsewhere? A point is
 * covered or not, so that they tell it to one of them, a sixteenth of a part; and where none is,
 * what stands between them shows in that a single ray from one of many meets a back. */
static int is_guessed(const struct exchange *x, uint32_t i, const struct exchange_loss *way,
                      double known)
{
    const int is_known = known > 0 && !(fabs(way->covered - known) > 0);
    if (is_known || is_closed(way))
        return 0;
    if (way->covered > 0)
        return way->leaves > 0 || way->backs > 0;
    return !(way->backs > 0) && ask_row(x, i, environment_glance).covered > 0;
}

/* A row that lacks more than the tolerance, and than one point stands for, where few points show no
 * way out, may have something small stand on it, or see a way out that is small or far. */
static void ask_rows(const void *asking, size_t from, size_t to)
{
    const struct asking *a = asking;
    for (size_t i = from; i < to; i++) {
        struct exchange_loss *way = &a->ways[i];
        if (!is_asked(a, i))
            continue;
        const double covered = share_under_bodies(a->exchange, (uint32_t)i),
                     cell = 1.0 / (environment_fine.side * environment_fine.side);
        if (covered > 1 - cell) { /* rays would start behind what covers it */
            *way = (struct exchange_loss){.covered = 1};
            continue;
        }
        *way = ask_knowing(a->exchange, (uint32_t)i, environment_coarse, covered);
        if (is_guessed(a->exchange, (uint32_t)i, way, covered))
            *way = ask_knowing(a->exchange, (uint32_t)i, environment_middle, covered);
        if (!is_closed(way) || !(1 - a->share[i] > fmax(cell, a->options->tolerance)))
            continue;
        *way = ask_knowing(a->exchange, (uint32_t)i, environment_fine, covered);
    }
}

/* Rays are built when a row is asked that nothing stands before. Returns -1 on all ranks when any
 * has none. */
static int build_rays(struct exchange *x, const struct asking *a)
{
    int failed = 0;
    for (size_t i = 0; i < x->areas.rows; i++)
        if (is_asked(a, i)) {
            failed = rays_build(x->tree.rays, &x->no_rays) < 0;
            break;
        }
    return ranks_any(x->ranks, failed) ? -1 : 0;
}

/* Ask those rows that must be. Returns 0, or -1 on all ranks. */
static int ask(struct exchange *x, const struct asking *a)
{
    if (build_rays(x, a) < 0)
        return -1;
    ranks_loop_run(x->ranks, RANKS_VALUES, x->threads, x->areas.rows, 16, ask_rows, a, x->losses,
                   sizeof *x->losses);
    return 0;
}

/* What rows sum to, shares of their areas, 1 of rows that nobody asks for; and where the light goes
 * that they lack. Returns 0 or -1. */
static int add_rows(struct exchange *x, const struct asking *a, double *sums, double *share)
{
    const struct exchange_areas *m = &x->areas;
    if (exchange_sums(m, x->threads, NULL, sums) < 0)
        return -1;
    for (uint32_t i = 0; i < m->inputs; i++) {
        if (i >= m->rows)
            sums[i] = m->area[i];
        share[i] = m->area[i] > 0 ? sums[i] / m->area[i] : 1;
    }
    return ask(x, a);
}

/* Of what chance explains: rows that are off by more from what known solids leave of them have more
 * on them; chosen. */
static const double UNKNOWN_COVER = 4;

/* Is row i off by more than chance explains? What a row lacks whose light goes elsewhere, too, is
 * not known so well, but of what solids stand on. */
static int is_off(const struct asking *a, uint32_t i)
{
    const double most = EXCHANGE_OFF * a->options->tolerance, lacks = 1 - a->share[i];
    const struct exchange_loss *way = &a->ways[i];
    const double covered = way->covered > 0 ? share_under_bodies(a->exchange, i) : 0;
    if (-lacks > most)
        return 1;
    if (way->leaves > 0 || way->backs > 0 || (way->covered > 0 && !(covered > 0)))
        return 0;
    const double off = fabs(lacks - covered);
    return off > most && (!(covered > 0) || off < UNKNOWN_COVER * most);
}

/* The rows that are: off[inputs]. Returns their number. */
static uint32_t find_off(const struct asking *a, unsigned char *off)
{
    const struct exchange_areas *m = &a->exchange->areas;
    uint32_t count = 0;
    for (uint32_t i = 0; i < m->rows; i++)
        count += off[i] = m->area[i] > 0 && is_off(a, i);
    return count;
}

/* Row sums, a second look at rows that are off, their account, and closure. */
static int close_rows(struct exchange *x, const struct exchange_options *o,
                      const struct exchange_aim *how)
{
    const struct exchange_areas *m = &x->areas;
    const size_t size = (m->inputs + (size_t)1) * sizeof(double);
    double *share = malloc(size), *before = malloc(size), *sums = malloc(size);
    unsigned char *mark = calloc(m->inputs + (size_t)1, 1);
    x->losses = calloc(m->inputs + (size_t)1, sizeof *x->losses);
    struct asking asking = {.exchange = x, .options = o, .share = share, .ways = x->losses};
    int status = ranks_any(x->ranks, !share || !before || !sums || !mark || !x->losses) ? -1 : 0;
    if (status == 0)
        status = add_rows(x, &asking, sums, share);
    if (status == 0 && !o->stream && find_off(&asking, mark)) {
        memcpy(before, share, size);
        x->phase = "again";
        asking.before = before;
        status = exchange_again(&x->areas, &x->refinement, mark, how);
        if (status == 0)
            status = add_rows(x, &asking, sums, share);
    }
    if (status == 0) {
        account(x, share, mark);
        status = exchange_closure_make(&x->closure, o->closure, m, x->threads, sums, mark);
    }
    if (status == 0)
        status = follow_closure(x, sums);
    free(share);
    free(before);
    free(sums);
    free(mark);
    return status;
}

static int compute(struct exchange *x, const struct scene *scene, const struct refiner *refiner,
                   const struct exchange_options *o)
{
    struct watcher watcher = {x, o};
    const struct exchange_aim how = {.tolerance = o->tolerance,
                                     .rows = o->rows,
                                     .stream = o->stream,
                                     .keep = (o->keep ? o->keep : KEPT) / sizeof(double),
                                     .threads = o->threads,
                                     .tell = tell_share,
                                     .context = &watcher,
                                     .state = &x->state,
                                     .ranks = x->ranks};
    double start = seconds();
    if (refine(x, refiner, &watcher, &how) < 0)
        return -1;
    double middle = seconds();
    x->report.seconds.refine = middle - start;
    if ((!x->resumed && tell(&watcher, "factors") != 0)
        || exchange_areas_open(&x->areas, &x->tree, scene, &x->refinement, &how) < 0)
        return -1;
    if (close_rows(x, o, &how) < 0)
        return -1;
    if (!how.stream)
        refinement_close(&x->refinement);
    x->report.entry_error = exchange_areas_error(&x->areas);
    if (x->report.entry_error < 0)
        return -1;
    x->report.seconds.fill = seconds() - middle;
    x->report.links = x->areas.link_count;
    x->report.pairs = x->areas.value_count;
    x->rays = x->report.rays = rays_count(x->tree.rays).rays;
    ranks_add_counts(x->ranks, RANKS_VALUES, &x->report.rays, 1);
    x->report.rays += x->state.rays;
    x->report.closure_change = x->closure.change;
    x->report.closure_left = x->closure.left;
    return 0;
}

int exchange_open(struct exchange *x, const struct scene *scene, const struct refiner *refiner,
                  const struct exchange_options *options, const char **cause)
{
    *x =
        (struct exchange){.phase = "factors", .threads = options->threads, .ranks = options->ranks};
    if (exchange_tree_open(&x->tree, scene->faces, scene->face_count, options->threads, cause) < 0)
        return -1;
    if (compute(x, scene, refiner, options) == 0)
        return 0;
    const int cancelled = x->cancelled, refused = x->state.cause != NULL;
    *cause = x->state.cause                     ? x->state.cause
             : x->no_rays                       ? x->no_rays
             : x->cancelled || x->state.stopped ? NULL
             : x->refinement.met
                 ? "refinement for view factors does not end; a larger tolerance needs less"
                 : "out of memory for exchange areas; a larger tolerance needs less";
    exchange_close(x);
    x->cancelled = cancelled;
    x->refused = refused;
    return -1;
}

void exchange_close(struct exchange *x)
{
    free(x->losses);
    exchange_closure_free(&x->closure);
    exchange_areas_close(&x->areas);
    refinement_close(&x->refinement);
    exchange_tree_close(&x->tree);
    memset(x, 0, sizeof *x);
}

double exchange_row(const struct exchange *x, uint32_t i, double *restrict row)
{
    const struct exchange_closure *c = &x->closure;
    const struct exchange_areas *m = &x->areas;
    uint32_t n = m->inputs;
    double sum = 0;
    memset(row, 0, n * sizeof *row);
    if (!(m->area[i] > 0))
        return 0;
    double scale = (c->scale && !c->both ? c->scale[i] : 1) / m->area[i];
    (void)exchange_areas_row(m, i, c->both ? c->scale : NULL, row);
    for (uint32_t j = 0; j < n; j++) {
        row[j] *= scale;
        sum += row[j];
    }
    return sum;
}

int exchange_multiply(const struct exchange *x, uint32_t columns, const double *in, double *out)
{
    const struct exchange_closure *c = &x->closure;
    const struct exchange_areas *m = &x->areas;
    size_t size = (size_t)m->inputs * columns;
    double *scaled = malloc((2 * size + 1) * sizeof *scaled);
    if (ranks_any(x->ranks, !scaled)) {
        free(scaled);
        return -1;
    }
    for (size_t k = 0; k < size; k++)
        scaled[k] = in[k] * (c->both ? c->scale[k / columns] : 1);
    int status = exchange_product(m, x->threads, columns, scaled, scaled + size);
    for (size_t k = 0; k < (size_t)m->rows * columns && status == 0; k++) {
        uint32_t i = (uint32_t)(k / columns);
        out[k] = m->area[i] > 0 ? scaled[size + k] * (c->scale ? c->scale[i] : 1) / m->area[i] : 0;
    }
    free(scaled);
    return status;
}
