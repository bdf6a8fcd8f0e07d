/* power_balance.c - see power_balance.h.
 *
 * Where much is reflected a particle that lives long lights all faces: their noise is one, and more
 * particles are a poor cure for it. But one thing of all light is known: what surfaces absorb and
 * what leaves the scene is what is emitted, E. A set of particles has counted Q instead. Light
 * reflected, P, differs from set to set as Q does, or partly so; by how much, b, is the slope of P
 * over Q among the REPLICATES sets. So P - b (Q - E) is light reflected as before, in the mean, and
 * less noisy: all counts of a set and a band are scaled alike to come to it. What a set is taken to
 * have found is what it adds to what all others found by their own slope, n times the mean of all
 * less n - 1 times that of the others: so how sets differ tells the noise of the slope, too, where
 * it hangs on the few particles that it corrects. Where all faces reflect alike nothing is left of
 * the noise of P; where P and Q have nothing in common b is near 0 and costs a thirteenth of the
 * variance.
 *
 * [control variates by regression: Lavenberg and Welch 1981; what a set adds: Tukey 1958, the
 * jackknife]
 * Fails: nothing is gained for how light is spread over faces.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "particles/power_balance.h"
#include "util/thread_pool.h"

/* By replicate, as counted (W): reflected; absorbed or lost. */
struct band_balance {
    double reflected[REPLICATES], ended[REPLICATES], emitted;
};

struct balancing {
    const struct tally *tally;
    const struct tracer *t;
    struct band_balance *of_band; /* [band] */
};

/* For sets of particles: what has come of each; */
static void add_faces(const void *balancing, size_t from, size_t to)
{
    const struct balancing *x = balancing;
    const struct tally *tally = x->tally;
    const double unit = tally_unit(tally); /* corrections are still 0 */
    for (size_t r = from; r < to; r++) {
        /* in sums of its own: a line of memory that two threads write is slow */
        double reflected[3] = {0}, ended[3] = {0};
        for (uint32_t f = 0; f < tally->faces; f++) {
            if (!tally_holds(tally, f))
                continue;
            const size_t at = (r * tally->held + tally_place(tally, f)) * tally->bands;
            for (uint32_t k = 0; k < tally->bands; k++) {
                const double rho = x->t->reflectance[(size_t)f * tally->bands + k],
                             power = unit * (double)tally->face[at + k];
                reflected[k] += rho * power;
                ended[k] += (1 - rho) * power;
            }
        }
        for (uint32_t k = 0; k < tally->bands; k++) {
            x->of_band[k].reflected[r] = reflected[k];
            x->of_band[k].ended[r] = ended[k] + unit * (double)tally->lost[r][k];
        }
    }
}

/* and what they were sent out with. */
static double emitted(const struct tally *tally, const struct tracer *t, uint32_t band)
{
    double sum = 0;
    for (uint32_t f = 0; f < tally->faces; f++)
        sum += t->exitance[(size_t)f * tally->bands + band] * tracer_surface(t, f)->area;
    return sum;
}

/* Sums over the sets, or over some of them (W, W2). */
struct sums {
    double sets, reflected, ended, both, square; /* both, square: about the mean of all */
};

/* The light reflected, as the slope makes it. */
static double balanced(const struct sums *s, double emitted)
{
    const double slope = s->square > 0 ? s->both / s->square : 0;
    return fmax((s->reflected - slope * (s->ended - s->sets * emitted)) / s->sets, 0);
}

/* What is counted too little where so much should be, as a share. */
static double too_little(double balanced, double counted)
{
    return counted > 0 ? fmax(balanced / counted - 1, -1) : 0;
}

/* Squares about the mean without one of n are less by so many times its own about that of all. */
#define LEFT_OUT (REPLICATES / (REPLICATES - 1.0))

void power_balance(struct tally *tally, const struct tracer *t)
{
    struct band_balance of_band[3] = {{{0}, {0}, 0}};
    memset(tally->correction, 0, sizeof tally->correction);
    if (tally->particles == 0)
        return;
    const struct balancing balancing = {tally, t, of_band};
    thread_pool_run(t->threads, REPLICATES, 1, add_faces, &balancing);
    for (uint32_t k = 0; k < tally->bands; k++) {
        struct band_balance b = of_band[k];
        struct sums all = {.sets = REPLICATES};
        if (tally->parted_faces
            || tally->quarters) { /* sums of sums: nobody needs the counts themselves */
            ranks_add(t->ranks, RANKS_PARTICLES, b.reflected, REPLICATES);
            ranks_add(t->ranks, RANKS_PARTICLES, b.ended, REPLICATES);
        }
        b.emitted = emitted(tally, t, k);
        for (int r = 0; r < REPLICATES; r++) {
            all.reflected += b.reflected[r];
            all.ended += b.ended[r];
        }
        const double reflected = all.reflected / REPLICATES, ended = all.ended / REPLICATES;
        for (int r = 0; r < REPLICATES; r++) {
            all.both += (b.ended[r] - ended) * (b.reflected[r] - reflected);
            all.square += (b.ended[r] - ended) * (b.ended[r] - ended);
        }
        const double mean = balanced(&all, b.emitted);
        for (int r = 0; r < REPLICATES; r++) {
            const double p = b.reflected[r] - reflected, q = b.ended[r] - ended;
            const struct sums others = {REPLICATES - 1, all.reflected - b.reflected[r],
                                        all.ended - b.ended[r], all.both - LEFT_OUT * q * p,
                                        all.square - LEFT_OUT * q * q};
            tally->correction[r][k] =
                too_little(REPLICATES * mean - (REPLICATES - 1) * balanced(&others, b.emitted),
                           b.reflected[r]);
        }
        tally->correction[REPLICATES][k] = too_little(mean, reflected);
    }
}
