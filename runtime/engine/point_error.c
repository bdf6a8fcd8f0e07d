/* point_error.c - see point_error.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/point_error.h"
#include "kernel/constants.h"
#include "kernel/leaf_at.h"
#include "visibility/contact_fraction.h"

/* So many particles per replicate tell how many rays one takes. */
enum { FEELER = 8 };

static int trace_tally(struct tally *tally, const struct tracer *t, uint64_t budget,
                       const struct watch *watch)
{
    if (tally_trace_part(tally, t, FEELER, NULL) < 0)
        return -1;
    double more = tally->rays > 0 ? (double)budget * FEELER / (double)tally->rays - FEELER : 0;
    /* the points of a Sobol' sequence are 2^32 */
    if (more >= 1)
        return tally_trace(tally, t, (uint64_t)fmin(more, 0x1p32 - FEELER), watch);
    tally_add(tally, t->ranks);
    return 0;
}

/* Per element, of all leaves below it that reflect: what the solution has them receive less what
 * particles bring (W), [element * bands + band]; their uncovered area (m2); and how many particles
 * should have met them. Not how many have: parts chosen by that would seem brighter than they are.
 */
struct defects {
    double *power, *area, *expected;
};

static void measure_leaves(const struct point_error *x, const struct tally *tally,
                           struct defects *d)
{
    const struct hierarchy *h = x->tracer->hierarchy;
    uint32_t bands = x->tracer->bands;
    double one = tally->particles > 0 ? tally->power / ((double)tally->particles * REPLICATES) : 0;
    for (uint32_t i = h->count; i-- > 0;) { /* children follow their parents */
        const struct element *e = &h->elements[i];
        d->area[i] = d->expected[i] = 0;
        for (uint32_t k = 0; k < bands; k++)
            d->power[(size_t)i * bands + k] = 0;
        for (int c = 0; c < e->children; c++) {
            uint32_t j = e->child + (uint32_t)c;
            d->area[i] += d->area[j];
            d->expected[i] += d->expected[j];
            for (uint32_t k = 0; k < bands; k++)
                d->power[(size_t)i * bands + k] += d->power[(size_t)j * bands + k];
        }
        if (e->children)
            continue;
        const double *rho = &x->tracer->reflectance[(size_t)e->face * bands],
                     *exitance = &x->tracer->exitance[(size_t)e->face * bands],
                     area = e->area * x->solve->operator.uncovered[i];
        for (uint32_t k = 0; k < bands; k++) {
            if (!(rho[k] > 0))
                continue;
            double solved = area * (x->light->mean[(size_t)i * bands + k] - exitance[k]) / rho[k];
            d->area[i] = area;
            d->expected[i] += one > 0 ? solved / one : 0;
            d->power[(size_t)i * bands + k] = solved - tally_leaf(tally, i, k);
        }
    }
}

/* From the root down: the error of H in the smallest part that enough particles should meet; then
 * what leaves reflect without it. */
static void mend(const struct point_error *x, const struct defects *d, double *reflected)
{
    const struct hierarchy *h = x->tracer->hierarchy;
    uint32_t bands = x->tracer->bands;
    for (uint32_t i = 0; i < h->count; i++) {
        const struct element *e = &h->elements[i];
        int enough = i == 0 || (d->expected[i] >= POINT_ERROR_MET && d->area[i] > 0);
        for (uint32_t k = 0; k < bands; k++)
            reflected[(size_t)i * bands + k] =
                enough ? (d->area[i] > 0 ? d->power[(size_t)i * bands + k] / d->area[i] : 0)
                       : reflected[(size_t)e->parent * bands + k];
    }
    for (uint32_t i = 0; i < h->count; i++) {
        const struct element *e = &h->elements[i];
        for (uint32_t k = 0; k < bands && !e->children; k++) {
            size_t at = (size_t)i * bands + k, face = (size_t)e->face * bands + k;
            reflected[at] = x->light->mean[at] - x->tracer->exitance[face]
                            - x->tracer->reflectance[face] * reflected[at];
        }
    }
}

/* Square of the relative standard error of what is reflected in all, by how replicates differ. */
static double variance_of(const struct tally *tally, const struct tracer *t)
{
    double sum = 0, square = 0;
    for (int r = 0; r < REPLICATES; r++) {
        double all = 0;
        for (uint32_t i = 0; i < tally->faces; i++)
            for (uint32_t k = 0; k < t->bands; k++)
                all += t->reflectance[(size_t)i * t->bands + k] * tally_face(tally, r, i, k);
        sum += all;
        square += all * all;
    }
    double mean = sum / REPLICATES, variance = square / REPLICATES - mean * mean;
    return mean > 0 ? fmax(variance, 0) / (mean * mean * (REPLICATES - 1)) : 0;
}

struct half_watch {
    const struct watch *watch;
    int half;
};

static int tell_half(void *context, double share)
{
    const struct half_watch *h = context;
    return h->watch->tell(h->watch->context, (h->half + share) / HALVES);
}

int point_error_open(struct point_error *x, const struct solve *s, const struct tracer *t,
                     const struct element_light *light, uint64_t budget, uint64_t stream,
                     const struct watch *watch, uint64_t *rays)
{
    size_t count = t->hierarchy->count, values = count * t->bands;
    *x = (struct point_error){.solve = s, .tracer = t, .light = light};
    struct defects d = {malloc(values * sizeof *d.power), malloc(count * sizeof *d.area),
                        malloc(count * sizeof *d.expected)};
    int failed = !d.power || !d.area || !d.expected;
    for (int half = 0; half < HALVES && !failed; half++) {
        struct tally tally = {0};
        struct half_watch part = {watch, half};
        struct watch told = {tell_half, &part};
        x->reflected[half] = malloc(values * sizeof *x->reflected[half]);
        failed = !x->reflected[half]
                 || tally_open(&tally, t, stream * HALVES + (uint64_t)half, 1) < 0
                 || trace_tally(&tally, t, budget / HALVES, watch ? &told : NULL) < 0;
        if (!failed) {
            measure_leaves(x, &tally, &d);
            mend(x, &d, x->reflected[half]);
            x->variance += variance_of(&tally, t) / HALVES;
            *rays += tally.rays;
        }
        tally_close(&tally);
    }
    free(d.power);
    free(d.area);
    free(d.expected);
    if (failed)
        point_error_close(x);
    return failed ? -1 : 0;
}

void point_error_close(struct point_error *x)
{
    for (int half = 0; half < HALVES; half++)
        free(x->reflected[half]);
    *x = (struct point_error){0};
}

static double turned(double shift, int i, double step)
{
    double u = shift + i * step;
    return u - floor(u);
}

int point_error_measure(const struct point_error *x, const struct place *at,
                        const struct path_rays *count, struct dice *dice, struct point_sample *out,
                        uint64_t *rays)
{
    const struct tracer *t = x->tracer;
    const struct element *elements = t->hierarchy->elements;
    uint32_t bands = t->bands;
    double h[HALVES][3] = {{0, 0, 0}, {0, 0, 0}}, shift[5], weight[4], fronts = 0;
    for (int half = 0; half < HALVES; half++) {
        for (int d = 0; d < 5; d++)
            shift[d] = dice_throw(dice);
        for (int i = 0; i < (int)count->cosine; i++) {
            double q[3] = {at->p[0], at->p[1], at->p[2]}, end[3];
            int64_t met = path_onward(t, at->face, q, turned(shift[0], i, 0.7548776662466927),
                                      turned(shift[1], i, 0.5698402909980532), count, h[half], end);
            if (met < 0)
                continue;
            uint32_t leaf = leaf_at(elements, t->hierarchy->face_element[met], end, weight);
            for (uint32_t k = 0; k < bands; k++)
                h[half][k] += (x->reflected[half][(size_t)leaf * bands + k]
                               + element_light_slope(x->light, leaf, k, end))
                              / count->cosine;
            fronts++;
        }
        *rays += (uint64_t)count->cosine;
        for (int i = 0; i < (int)count->light; i++) {
            const double u[3] = {turned(shift[2], i, 0.8191725133961645),
                                 turned(shift[3], i, 0.6710436067037893),
                                 turned(shift[4], i, 0.5497004779019703)};
            *rays += (uint64_t)path_to_light(t, at->face, at->p, u, count, h[half]);
        }
    }
    if (fronts * CONTACT_RAYS <= (CONTACT_RAYS - CONTACT_BACKS) * HALVES * count->cosine) {
        *rays += CONTACT_RAYS;
        if (contact_covers(t->rays, tracer_surface(t, at->face), at->p))
            return 1;
    }
    for (uint32_t k = 0; k < bands; k++) {
        out->solved[k] = element_light_at(x->light, at->leaf, k, at->p)
                         - t->exitance[(size_t)at->face * bands + k];
        for (int half = 0; half < HALVES; half++)
            out->error[half][k] =
                out->solved[k] - t->reflectance[(size_t)at->face * bands + k] * h[half][k];
    }
    return 0;
}
