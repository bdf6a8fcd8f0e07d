/* factor_kinds.c - see factor_kinds.h.
 *
 * Each kind is computed for all links of a bin in one go, on one thread, by that thread's clock; a
 * bin of few links is computed again until the clock can tell. The disc is the bare one: in an
 * oracle the polygon stands in for it where bounding spheres meet.
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "study/factor_kinds.h"
#include "study/fine_factor.h"
#include "terms/form_factor.h"
#include "util/clock.h"
#include "util/device.h"

#define ENOUGH_SECONDS 2e-3                /* the clock's step is below a thousandth of it */
enum { REPEATS = 10000, FINE_LINKS = 30 }; /* the latter of each bin */

struct work {
    struct solved solved;
    RadDevice device;
    const char *where;
    struct progress *progress;
    /* links bin by bin: those of bin b are list[first[b]] .. list[first[b + 1] - 1] */
    size_t *list, first[BINS + 1];
    /* [links]: of the kind at hand, and of the contour; 0 of links of clusters */
    double *factors, *yardstick;
    float *given;       /* [links]: what the solution is given */
    double *irradiance; /* [element * bands + band], by the contour */
};

static int bin_of(const struct element *r, const struct element *s)
{
    double away[3];
    sub3(away, s->centre, r->centre);
    const double ratio = length3(away) / (r->radius + s->radius);
    int bin = 0;
    while (bin < BINS - 1 && ratio >= ldexp(1, bin))
        bin++;
    return bin;
}

static const struct element *receiver_of(const struct solved *s, size_t link)
{
    return &s->elements.elements[s->links.links[link].receiver];
}

static const struct element *emitter_of(const struct solved *s, size_t link)
{
    return &s->elements.elements[s->links.links[link].emitter];
}

static int of_surfaces(const struct solved *s, size_t link)
{
    return receiver_of(s, link)->vertices && emitter_of(s, link)->vertices;
}

/* Counting sort. */
static void sort_links(struct work *w)
{
    const struct solved *s = &w->solved;
    size_t next[BINS];
    for (size_t i = 0; i < s->links.count; i++)
        if (of_surfaces(s, i))
            w->first[1 + bin_of(receiver_of(s, i), emitter_of(s, i))]++;
    for (int b = 0; b < BINS; b++) {
        next[b] = w->first[b];
        w->first[b + 1] += w->first[b];
    }
    for (size_t i = 0; i < s->links.count; i++)
        if (of_surfaces(s, i))
            w->list[next[bin_of(receiver_of(s, i), emitter_of(s, i))]++] = i;
}

static double factor_of(const struct element *r, const struct element *s, int kind)
{
    struct discussion d;
    d.receiver = r;
    d.emitter = s;
    memset(&d.terms, 0, sizeof d.terms);
    return form_factor_of(&d, (enum form_factor_level)(kind + 1));
}

/* Compute the kind for the links of bin b. */
static void evaluate(struct work *w, int kind, int b, struct factor_tally *t)
{
    const struct solved *s = &w->solved;
    int repeats = 0;
    const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    do {
        for (size_t i = w->first[b]; i < w->first[b + 1]; i++) {
            const size_t link = w->list[i];
            w->factors[link] = factor_of(receiver_of(s, link), emitter_of(s, link), kind);
        }
        repeats++;
        t->seconds = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
    } while (t->seconds < ENOUGH_SECONDS && repeats < REPEATS);
    t->evaluations = (double)(w->first[b + 1] - w->first[b]) * repeats;
}

static void compare(struct factor_tally *t, double area, double factor, double yardstick)
{
    const double off = factor - yardstick;
    t->links++;
    t->exchange += area * yardstick;
    t->off += area * fabs(off);
    t->excess += area * off;
    t->worst = fmax(t->worst, fabs(off));
}

/* The contour against area integration, over links spread evenly over the bin. */
static void compare_contour(struct factor_kinds *k, const struct work *w, int b,
                            struct factor_tally *t)
{
    const size_t count = w->first[b + 1] - w->first[b],
                 most = count < FINE_LINKS ? count : FINE_LINKS;
    for (size_t i = 0; i < most; i++) {
        const size_t link = w->list[w->first[b] + count * i / most];
        const struct element *r = receiver_of(&w->solved, link), *e = emitter_of(&w->solved, link);
        double doubt;
        const double fine = fine_factor(r, e, &doubt);
        compare(t, r->area, w->yardstick[link], fine);
        k->doubt += r->area * doubt;
    }
}

/* Over all bins. One evaluation costs there what it does in each, by its share of the links. */
static void add_bins(struct factor_tally *tally, const size_t first[BINS + 1])
{
    struct factor_tally *all = &tally[BINS];
    for (int b = 0; b < BINS; b++) {
        const double links = (double)(first[b + 1] - first[b]);
        all->links += tally[b].links;
        all->exchange += tally[b].exchange;
        all->off += tally[b].off;
        all->excess += tally[b].excess;
        all->worst = fmax(all->worst, tally[b].worst);
        all->evaluations += links;
        if (links > 0)
            all->seconds += links * tally[b].seconds / tally[b].evaluations;
    }
}

static void measure_kind(struct factor_kinds *k, struct work *w, int kind)
{
    struct factor_kind *x = &k->kind[kind];
    for (int b = 0; b < BINS; b++) {
        progress_say(w->progress, "form factors by %s, %zu links, bin %d of %d", x->name, k->links,
                     b + 1, BINS);
        evaluate(w, kind, b, &x->tally[b]);
        if (kind == KIND_CONTOUR)
            compare_contour(k, w, b, &x->tally[b]);
        for (size_t i = w->first[b]; kind != KIND_CONTOUR && i < w->first[b + 1]; i++) {
            const size_t link = w->list[i];
            compare(&x->tally[b], receiver_of(&w->solved, link)->area, w->factors[link],
                    w->yardstick[link]);
        }
    }
    add_bins(x->tally, w->first);
}

/* sum A rho |H - H*| over the faces as far as nothing covers them, over sum A rho H*. */
static double reflected_off(const struct work *w)
{
    const struct RadFace *faces = radGetSceneFaces(w->solved.scene);
    const struct RadMaterial *materials = radGetSceneMaterials(w->solved.scene);
    const struct RadElements *e = &w->solved.elements;
    struct RadSceneReport scene;
    double off = 0, all = 0;
    if (radGetSceneReport(w->solved.scene, &scene) < 0)
        return NAN;
    for (uint32_t i = 0; i < scene.faces; i++) {
        const size_t at = e->face_element[i];
        const double area = faces[i].black ? 0 : e->elements[at].area * e->uncovered[at];
        for (uint32_t k = 0; k < e->bands; k++) {
            const double rho = materials[faces[i].material].reflectance[k];
            off += area * rho
                   * fabs(e->irradiance[at * e->bands + k] - w->irradiance[at * e->bands + k]);
            all += area * rho * w->irradiance[at * e->bands + k];
        }
    }
    return all > 0 ? off / all : 0;
}

/* The light over the form factors of the kind at hand. */
static int solve_kind(struct factor_kind *x, struct work *w, int kind)
{
    struct solved *s = &w->solved;
    for (size_t i = 0; i < s->links.count; i++)
        w->given[i] = (float)fmin(w->factors[i], FLT_MAX);
    progress_say(w->progress, "light over form factors by %s", x->name);
    if (radSolveWithFactors(s->solution, w->given) < 0)
        return report_device(w->device, w->where);
    struct RadReport report;
    radGetElements(s->solution, &s->elements);
    radGetReport(s->solution, &report);
    if (kind == KIND_CONTOUR)
        memcpy(w->irradiance, s->elements.irradiance,
               (size_t)s->elements.count * s->elements.bands * sizeof *w->irradiance);
    x->capped = report.rows.moved;
    x->reflected = reflected_off(w);
    return 0;
}

static int measure(struct factor_kinds *k, struct work *w)
{
    static const char *const names[KINDS] = {"inverse_square", "disc",    "hemicube", "point",
                                             "rays",           "polygon", "contour"};
    static const char *const looks_at[KINDS] = {
        "1 pair of points",           "1 pair of points", "a hemicube, 128 wide",
        "1 point and the edges",      "512 rays",         "1 to 9 points, or edges by edges",
        "edges by edges, or 9 points"};
    _Static_assert(FORM_FACTOR_RAYS_EACH == 256 && FORM_FACTOR_PIXELS == 128, "as looks_at says");
    sort_links(w);
    k->links = w->first[BINS];
    k->left_out = w->solved.links.count - k->links;
    if (k->links == 0)
        return report_error(w->where, 0,
                            "there is no link between two surfaces, so nothing to measure; does "
                            "anything see a light?");
    for (int kind = KINDS - 1; kind >= 0; kind--) { /* the yardstick first */
        struct factor_kind *x = &k->kind[kind];
        x->name = names[kind];
        x->looks_at = looks_at[kind];
        double *own = w->factors;
        if (kind == KIND_CONTOUR)
            w->factors = w->yardstick;
        measure_kind(k, w, kind);
        const int status = solve_kind(x, w, kind);
        w->factors = own;
        if (status < 0)
            return -1;
    }
    const double exchange = k->kind[KIND_CONTOUR].tally[BINS].exchange;
    k->doubt = exchange > 0 ? k->doubt / exchange : 0;
    return 0;
}

int factor_kinds_measure(struct factor_kinds *k, const struct solved *solved, RadDevice device,
                         const char *where, struct progress *progress)
{
    const size_t links = solved->links.count + 1;
    struct work w = {
        .solved = *solved, .device = device, .where = where, .progress = progress, .first = {0}};
    memset(k, 0, sizeof *k);
    w.list = malloc(links * sizeof *w.list);
    w.factors = calloc(links, sizeof *w.factors);
    w.yardstick = calloc(links, sizeof *w.yardstick);
    w.given = malloc(links * sizeof *w.given);
    w.irradiance =
        malloc((size_t)solved->elements.count * solved->elements.bands * sizeof *w.irradiance);
    const int status = w.list && w.factors && w.yardstick && w.given && w.irradiance
                           ? measure(k, &w)
                           : report_error(where, 0, "out of memory");
    free(w.list);
    free(w.factors);
    free(w.yardstick);
    free(w.given);
    free(w.irradiance);
    return status;
}
