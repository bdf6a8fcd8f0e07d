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
#include "engine/cause_sums.h"

/* 97.5 % of Student's t with REPLICATES - 1 degrees of freedom. */
#define T_QUANTILE 2.131449545559323
_Static_assert(REPLICATES == 16, "T_QUANTILE is that of 15 degrees of freedom");

void cause_sums_add(struct cause_sums *to, const struct cause_polygon *polygon, uint32_t bands)
{
    for (int c = 0; c < CAUSE_SUMS; c++)
        for (uint32_t k = 0; k < bands; k++) {
            const double *d = polygon->sum[c][k];
            double all = 0;
            for (int r = 0; r < REPLICATES; r++)
                all += d[r];
            for (int r = 0; r < REPLICATES; r++) {
                double others = all - d[r];
                to->power[c][r] += d[r];
                to->l1[c][r] += others > 0 ? d[r] : others < 0 ? -d[r] : 0;
            }
        }
}

void cause_sums_join(struct cause_sums *to, const struct cause_sums *from)
{
    for (int c = 0; c < CAUSE_SUMS; c++)
        for (int r = 0; r < REPLICATES; r++) {
            to->power[c][r] += from->power[c][r];
            to->l1[c][r] += from->l1[c][r];
            to->after[c][r] += from->after[c][r];
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
    double mean = 0, square = 0;
    for (int r = 0; r < REPLICATES; r++)
        mean += value[r] / REPLICATES;
    for (int r = 0; r < REPLICATES; r++)
        square += (value[r] - mean) * (value[r] - mean);
    double half = T_QUANTILE * sqrt(square / (REPLICATES * (REPLICATES - 1))) / whole;
    mean /= whole;
    return (struct RadMeasure){mean, mean - half, mean + half};
}

static struct RadCause cause(const struct cause_sums *sums, int c, double whole)
{
    struct RadCause found = {measure(sums->power[c], whole), measure(sums->l1[c], whole),
                             measure(sums->after[c], whole)};
    found.l1.value = fmax(found.l1.value, fabs(found.power.value));
    found.l1.low = fmax(found.l1.low, 0);
    found.l1.high = fmax(found.l1.high, found.l1.value);
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
