/* cause_sums.c - see cause_sums.h.
 *
 * L1. The modulus of a polygon's difference d is above that of the true one, for noise adds where
 * it should cancel. So each replicate counts with the sign that the other replicates together give
 * it: sum over r of sign(sum of others) d_r. Its mean is |true d| times how often the sign is right
 * rather than wrong: |d| itself where d stands out of its noise, 0 where nothing is there, never
 * more than |d|. What noise hides is left out, and so is told too small rather than too large.
 * [the jackknife's leaving out: Quenouille 1956; derived here]
 *
 * Intervals are Student's, of replicates, which are independent in power and nearly so in L1.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "engine/cause_sums.h"

/* What a visibility that is a mean over the polygon makes after all reflections, and what is left
 * when that is taken from the whole: it differs from place to place, and so does the growth. */
static void part_spread(struct cause_polygon *p, uint32_t bands)
{
    static const enum RadCauseKind pairs[][2] = {{RAD_CAUSE_OPEN_VISIBILITY, RAD_CAUSE_OPEN_SPREAD},
                                                 {RAD_CAUSE_HALF_VISIBILITY, RAD_CAUSE_HALF_SPREAD},
                                                 {RAD_CAUSE_GROUPS_REST, RAD_CAUSE_GROUPS_SPREAD}};
    double n = (double)p->points;
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs && n > 1; i++)
        for (int r = 0; r < REPLICATES; r++) {
            double spread = p->after[pairs[i][0]][r];
            for (uint32_t k = 0; k < bands; k++)
                spread -= p->growth[k] / p->weight * p->sum[pairs[i][0]][k][r];
            spread *= n / (n - 1); /* a covariance of n points */
            p->after[pairs[i][0]][r] -= spread;
            p->after[pairs[i][1]][r] += spread;
        }
}

/* Add the differences of one polygon and band. */
static void add(double power[REPLICATES], double l1[REPLICATES], const double d[REPLICATES])
{
    double all = 0;
    for (int r = 0; r < REPLICATES; r++)
        all += d[r];
    for (int r = 0; r < REPLICATES; r++) {
        double others = all - d[r];
        power[r] += d[r];
        l1[r] += others > 0 ? d[r] : others < 0 ? -d[r] : 0;
    }
}

void cause_sums_add(struct cause_sums *to, struct cause_polygon *polygon, uint32_t bands)
{
    part_spread(polygon, bands);
    for (int c = 0; c < CAUSE_SUMS; c++) {
        for (uint32_t k = 0; k < bands; k++)
            add(to->power[c], to->l1[c], polygon->sum[c][k]);
        add(to->after[c], to->after_l1[c], polygon->after[c]);
    }
    memset(polygon, 0, sizeof *polygon);
}

void cause_sums_join(struct cause_sums *to, const struct cause_sums *from)
{
    for (int c = 0; c < CAUSE_SUMS; c++)
        for (int r = 0; r < REPLICATES; r++) {
            to->power[c][r] += from->power[c][r];
            to->l1[c][r] += from->l1[c][r];
            to->after[c][r] += from->after[c][r];
            to->after_l1[c][r] += from->after_l1[c][r];
        }
    to->traced += from->traced;
    for (int w = 0; w < RAD_WAYS; w++) {
        to->links[w] += from->links[w];
        to->rays[w] += from->rays[w];
    }
}

/* The mean of replicates over `whole`, and its 95 % interval. */
static struct RadMeasure measure(const double value[REPLICATES], double whole)
{
    double variance, mean = replicates_mean(value, &variance) / whole;
    double half = REPLICATES_T * sqrt(variance) / whole;
    return (struct RadMeasure){mean, mean - half, mean + half};
}

/* The same of a sum of moduli, which is no less than that of the sum. */
static struct RadMeasure modulus(const double value[REPLICATES], double whole,
                                 const struct RadMeasure *sum)
{
    struct RadMeasure m = measure(value, whole);
    m.value = fmax(m.value, fabs(sum->value));
    m.low = fmax(m.low, 0);
    m.high = fmax(m.high, m.value);
    return m;
}

static struct RadCause cause(const struct cause_sums *sums, int c, double whole)
{
    struct RadCause found = {.power = measure(sums->power[c], whole),
                             .after = measure(sums->after[c], whole)};
    found.l1 = modulus(sums->l1[c], whole, &found.power);
    found.after_l1 = modulus(sums->after_l1[c], whole, &found.after);
    return found;
}

void cause_sums_report(const struct cause_sums *sums, double whole, struct RadCausesReport *report)
{
    if (!(whole > 0))
        return;
    for (int c = 0; c < RAD_CAUSES; c++)
        report->cause[c] = cause(sums, c, whole);
    report->rays = sums->traced;
    report->together = cause(sums, CAUSE_ALL, whole);
    for (int w = 0; w < RAD_WAYS; w++) {
        report->way[w].links = sums->links[w] / whole / REPLICATES;
        report->way[w].rays = sums->rays[w] / whole / REPLICATES;
    }
}
