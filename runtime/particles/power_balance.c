/* power_balance.c - see power_balance.h.
 *
 * Where much is reflected a particle that lives long lights all faces: their noise is one, and more
 * particles are a poor cure for it. But one thing of all light is known: what surfaces absorb and
 * what leaves the scene is what is emitted, E. A set of particles has counted Q instead. Light
 * reflected, P, differs from set to set as Q does, or partly so; by how much, b, is the slope of P
 * over Q among the REPLICATES sets. So P - b (Q - E) is light reflected as before, in the mean, and
 * less noisy: all counts of a set and a band are scaled alike to come to it. A set takes the slope
 * of all others, lest sets agree because they have chosen it. Where all faces reflect alike nothing
 * is left of the noise of P; where P and Q have nothing in common b is near 0 and costs a
 * thirteenth of the variance.
 *
 * [control variates by regression: Lavenberg and Welch 1981]
 * Fails: nothing is gained for how light is spread over faces.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "particles/power_balance.h"
#include "util/thread_pool.h"

/* By replicate, as counted (W): reflected; absorbed or lost. */
struct balance {
    double reflected[REPLICATES], ended[REPLICATES], emitted;
};

struct balancing {
    const struct tally *tally;
    const struct tracer *t;
    struct balance *balance; /* [band] */
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
            x->balance[k].reflected[r] = reflected[k];
            x->balance[k].ended[r] = ended[k] + unit * (double)tally->lost[r][k];
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

/* What is counted too little, as a share; the slope is both / square. */
static double correct(const struct balance *b, double ended, double reflected, double both,
                      double square)
{
    const double slope = square > 0 ? both / square : 0;
    return reflected > 0 ? fmax(slope * (b->emitted - ended) / reflected, -1) : 0;
}

/* Squares about the mean without one of n are less by so many times its own about that of all. */
#define LEFT_OUT (REPLICATES / (REPLICATES - 1.0))

void power_balance(struct tally *tally, const struct tracer *t)
{
    struct balance balance[3] = {{{0}, {0}, 0}};
    memset(tally->correction, 0, sizeof tally->correction);
    if (tally->particles == 0)
        return;
    const struct balancing balancing = {tally, t, balance};
    thread_pool_run(t->threads, REPLICATES, 1, add_faces, &balancing);
    for (uint32_t k = 0; k < tally->bands; k++) {
        struct balance b = balance[k];
        double reflected = 0, ended = 0, both = 0, square = 0;
        if (tally->parted_faces
            || tally->quarters) { /* sums of sums: nobody needs the counts themselves */
            ranks_add(t->ranks, RANKS_PARTICLES, b.reflected, REPLICATES);
            ranks_add(t->ranks, RANKS_PARTICLES, b.ended, REPLICATES);
        }
        b.emitted = emitted(tally, t, k);
        for (int r = 0; r < REPLICATES; r++) {
            reflected += b.reflected[r] / REPLICATES;
            ended += b.ended[r] / REPLICATES;
        }
        for (int r = 0; r < REPLICATES; r++) {
            both += (b.ended[r] - ended) * (b.reflected[r] - reflected);
            square += (b.ended[r] - ended) * (b.ended[r] - ended);
        }
        for (int r = 0; r < REPLICATES; r++)
            tally->correction[r][k] =
                correct(&b, b.ended[r], b.reflected[r],
                        both - LEFT_OUT * (b.ended[r] - ended) * (b.reflected[r] - reflected),
                        square - LEFT_OUT * (b.ended[r] - ended) * (b.ended[r] - ended));
        tally->correction[REPLICATES][k] = correct(&b, ended, reflected, both, square);
    }
}
