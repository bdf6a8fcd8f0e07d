/* mend_clusters.c - see mend_clusters.h.
 *
 * How a cluster's light is shared among its children is told by links (q~ of each) and by the
 * particles that landed there (q^). Links are off by much in few places, where a shadow's edge or
 * an end of a coarse link lies, and by next to nothing elsewhere. So it would be wrong to believe
 * one share of every difference m = q^ - q~. Believed is k = 1 - h of it,
 *     h = min(1, t s^2 / m^2),   s^2 the square that noise alone would give m:
 * nothing below a threshold t, all far above it. Which t is best for the clusters that about as
 * many particles met is told by these themselves: of d children but one, v for s^2, the squared
 * error that this h leaves is in the mean
 *     h^2 m^2 + (1 - 2 h) v, and 4 h v / d more where h < 1,
 * whatever the errors of links are. Taken is the t of the least sum, and that sum is what mending
 * leaves: each cluster's part of it, as its s^2 is of the class's, is the variance of what its
 * children get, besides that of what it has itself.
 *
 * Noise is told by the replicates, which see correlations that chance does not, and by chance,
 * times how far the replicates of the class differ from chance: the mean of both, as 15 degrees of
 * freedom make the first alone uncertain, and what is uncertain there would be believed. Where few
 * particles land, or should by links, replicates say little, and where none did, nothing: then
 * chance alone. In sums over a class it is the replicates' own, v, which is right in the mean.
 *
 * The scene has no class: its k is believed as far as it is no accident. So is the sum of all light
 * that faces reflect: what a lamp's box lets out is spread over as many clusters as are around it,
 * and in each the links' error may be below its threshold, always to the same side. What the mended
 * sum is off more than the scene would be is taken from faces by how noisy what was counted there
 * is: of all ways to bring a sum to what is known of it the likeliest.
 *
 * Where other particles have mended already, what stands for links is off by what that leaves, a
 * square r^2, by the same estimate. The best mixture of what is as uncertain as that and of a count
 * believes r^2 / (r^2 + s^2) of the difference, and so much is believed at the most: a class of few
 * clusters that are far better known than by those who are counted now may by chance look worse.
 * What the scene receives stays, and what it reflects is held to what the first know of it: they
 * are not split.
 *
 * [Stein 1981, the unbiased estimate of that error; Donoho and Johnstone 1995, a threshold by it;
 * Breiman 1995 and Gao 1998, this h, the garrote]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/mend_clusters.h"
#include "engine/reflected_light.h"
#include "kernel/constants.h"
#include "util/thread_pool.h"

enum { RUN = 256 /* clusters that a thread takes at once */ };

/* Of m^2 over s^2. The first is James and Stein's rule for each alone; beyond the last, four
 * standard deviations, whatever is seen is believed. */
enum { THRESHOLDS = 7 };
static const double threshold[THRESHOLDS] = {1, 1.5, 2, 3, 4, 8, 16};

enum { NOTHING = -1 };

/* Of the children of a cluster, as shares of what was counted there: m^2; s^2 by replicates, as
 * they are and, where few land, as chance has it; and by chance. */
struct note {
    int class; /* NOTHING: none landed there */
    double seen, replicates, noise, chance;
    double before; /* what those who have mended already leave; INFINITY: none, or none landed */
};

/* Sums over a class: of s^2 by replicates and by chance; */
struct class_noise {
    double noise, chance;
};
/* of s^2 by both; of the squared error that each threshold leaves, and of its square. */
struct class_risk {
    double noise, left[THRESHOLDS], square[THRESHOLDS];
};
_Static_assert(sizeof(struct class_noise) == 2 * sizeof(double)
                   && sizeof(struct class_risk) == (1 + 2 * THRESHOLDS) * sizeof(double),
               "sums are told as they stand");

struct clusters {
    const struct mend_sums *sums;
    uint32_t *parent;  /* [count]: those that this rank mends, parents first */
    struct note *note; /* [count * bands] */
    uint32_t count;
    struct class_noise noise[MEND_CLASSES];
    double best[MEND_CLASSES]; /* threshold */
    double left[MEND_CLASSES]; /* what that leaves, over s^2 */
};

/* s^2 of child j of e by the replicates, off what it has more than given (W2). */
static double noise_of(const struct mend_sums *m, uint32_t e, uint32_t j, uint32_t k, double given,
                       double off)
{
    const size_t values = (size_t)m->places.built * m->bands;
    double seen = 0;
    for (size_t r = 0; r < REPLICATES; r++) {
        const double *of = &m->replicate[r * values];
        const double d = of[mend_at(m, j, k)] - given * of[mend_at(m, e, k)] - off;
        seen += d * d / (REPLICATES * (REPLICATES - 1.0));
    }
    return seen;
}

static struct note note_of(const struct mend_sums *m, uint32_t e, uint32_t k)
{
    const struct element *at = &m->op->hierarchy->elements[e];
    const double whole = m->received[mend_at(m, e, k)],
                 few = FACE_ERROR_FEW * tally_power_of_one(m->tally);
    double given[MEND_CHILDREN];
    struct note note = {NOTHING, 0, 0, 0, 0, INFINITY};
    if (!(whole > 0))
        return note;
    note.class = mend_class(m, e, k);
    mend_shares(m, e, k, given);
    for (uint32_t c = 0; c < at->children; c++) {
        const uint32_t j = at->child + c;
        const double here = m->received[mend_at(m, j, k)], off = here - given[c] * whole,
                     likely = fmax(here, given[c] * whole),
                     noise = noise_of(m, e, j, k, given[c], off) / (whole * whole);
        note.seen += off * off / (whole * whole);
        note.replicates += noise;
        if (m->tally->by_paths) {
            note.noise += noise;
            continue;
        }
        const double chance = mend_chance(m, k, given[c], likely, whole) / (whole * whole),
                     known = likely / (likely + few);
        note.noise += known * noise + (1 - known) * chance;
        note.chance += chance;
    }
    return note;
}

static void note_some(const void *clusters, size_t from, size_t to)
{
    const struct clusters *x = clusters;
    const uint32_t bands = x->sums->bands;
    for (size_t i = from; i < to; i++)
        for (uint32_t k = 0; k < bands; k++)
            x->note[i * bands + k] = note_of(x->sums, x->parent[i], k);
}

/* s^2 */
static double noise_in(const struct clusters *x, const struct note *note)
{
    const struct class_noise *c = &x->noise[note->class];
    return c->chance > 0 ? 0.5 * (note->noise + note->chance * c->noise / c->chance) : note->noise;
}

/* Is it in the sums that this rank makes of its class? */
static int counts(const struct clusters *x, size_t note)
{
    return x->note[note].class != NOTHING
           && mend_is_noted(x->sums, x->parent[note / x->sums->bands]);
}

/* Sums are taken in the order of clusters, whoever took the notes: first of noise, */
static void sum_noise(struct clusters *x)
{
    for (size_t i = 0; i < (size_t)x->count * x->sums->bands; i++)
        if (counts(x, i)) {
            x->noise[x->note[i].class].noise += x->note[i].noise;
            x->noise[x->note[i].class].chance += x->note[i].chance;
        }
    mend_add_up(x->sums, x->noise, (size_t)2 * MEND_CLASSES);
}

/* then of what thresholds would leave; children: one less than there are. */
static void add_risk(struct class_risk *class, const struct note *note, double noise,
                     double children)
{
    class->noise += noise;
    for (int i = 0; i < THRESHOLDS && noise > 0; i++) {
        const double h = fmin(1, threshold[i] * noise / note->seen),
                     left = h * h * note->seen + (1 - 2 * h) * note->replicates
                            + (h < 1 ? 4 * h / children * note->replicates : 0);
        class->left[i] += left;
        class->square[i] += left * left;
    }
}

/* To what is left comes a standard deviation of it, as classes may be small. */
static void choose_thresholds(struct clusters *x)
{
    const struct mend_sums *m = x->sums;
    struct class_risk risk[MEND_CLASSES] = {{0, {0}, {0}}};
    for (size_t i = 0; i < (size_t)x->count * m->bands; i++)
        if (counts(x, i)) {
            const struct element *e = &m->op->hierarchy->elements[x->parent[i / m->bands]];
            add_risk(&risk[x->note[i].class], &x->note[i], noise_in(x, &x->note[i]),
                     fmax(1, e->children - 1.0));
        }
    mend_add_up(m, risk, (size_t)(1 + 2 * THRESHOLDS) * MEND_CLASSES);
    for (int c = 0; c < MEND_CLASSES; c++) {
        const struct class_risk *r = &risk[c];
        int best = 0;
        for (int i = 1; i < THRESHOLDS; i++)
            if (r->left[i] < r->left[best])
                best = i;
        x->best[c] = threshold[best];
        x->left[c] =
            r->noise > 0 ? fmin(1, (fmax(r->left[best], 0) + sqrt(r->square[best])) / r->noise) : 1;
    }
}

/* What of m is not believed. */
static double doubted(const struct clusters *x, const struct note *note)
{
    if (note->class == NOTHING || !(note->seen > 0))
        return 1;
    const double noise = noise_in(x, note), least = noise > 0 ? noise / (noise + note->before) : 0;
    return fmin(1, fmax(least, x->best[note->class] * noise / note->seen));
}

/* Share out what e receives, mended by now, among its children. */
static void share_out(const struct clusters *x, uint32_t e, uint32_t k, const struct note *note,
                      double *irradiance, double *doubt)
{
    const struct mend_sums *m = x->sums;
    const struct element *elements = m->op->hierarchy->elements, *at = &elements[e];
    const double whole = irradiance[(size_t)e * m->bands + k] * at->area,
                 counted = m->received[mend_at(m, e, k)];
    const double belief = 1 - doubted(x, note);
    double given[MEND_CHILDREN];
    mend_shares(m, e, k, given);
    for (uint32_t c = 0; c < at->children; c++) {
        const uint32_t j = at->child + c;
        double share = given[c];
        if (belief > 0)
            share += belief * (m->received[mend_at(m, j, k)] / counted - given[c]);
        irradiance[(size_t)j * m->bands + k] = share * whole / elements[j].area;
        if (doubt)
            doubt[(size_t)j * m->bands + k] =
                doubt[(size_t)e * m->bands + k]
                + (note->class == NOTHING || !(share > 0)
                       ? 1
                       : x->left[note->class] * noise_in(x, note) / (at->children * share * share));
    }
}

/* What is left of a difference as noisy as that once it is believed as far as it is no accident;
 * where nothing is believed, the most that it may be. */
static double left_of(double off, double noise)
{
    const double least = 1 + MEND_EVIDENCE * sqrt(2);
    return off * off > least * noise ? noise / fabs(off) : sqrt(least * noise);
}

/* What of a difference is believed. */
static double believed(double off, double noise)
{
    return copysign(fmax(0, fabs(off) - left_of(off, noise)), off);
}

/* The variance of what was counted on an element (W2). */
static double noise_of_count(const struct mend_sums *m, uint32_t e, uint32_t k)
{
    return noise_of(m, e, e, k, 0, m->received[mend_at(m, e, k)]);
}

/* stays: it is mended already, and is the sum over its leaves. */
static void mend_scene(const struct mend_sums *m, uint32_t k, int stays, double *irradiance)
{
    const double linked = m->linked[mend_at(m, 0, k)], off = m->received[mend_at(m, 0, k)] - linked,
                 more = stays ? 0 : believed(off, noise_of_count(m, 0, k));
    irradiance[k] = (linked + more) / m->op->hierarchy->elements[0].area;
}

/* Is it a face that this rank adds to sums? */
static int is_own_face(const struct mend_sums *m, uint32_t e)
{
    return m->op->hierarchy->elements[e].vertices && mend_is_added(m->op, e);
}

static double reflectance_of(const struct mend_sums *m, uint32_t e, uint32_t k)
{
    const struct element *at = &m->op->hierarchy->elements[e];
    return m->op->problem->reflectance[(size_t)at->face * m->bands + k];
}

/* By how much all that faces reflect, mended, is above what is believed of it (W). */
static double sum_is_above(const struct mend_sums *m, const double *irradiance)
{
    const struct hierarchy *h = m->op->hierarchy;
    enum { MENDED, LINKED, SUMS };
    double sum[SUMS] = {0}, noise;
    for (uint32_t e = 0; e < h->built; e++)
        for (uint32_t k = 0; k < m->bands && is_own_face(m, e); k++) {
            const double rho = reflectance_of(m, e, k);
            sum[MENDED] += rho * h->elements[e].area * irradiance[(size_t)e * m->bands + k];
            sum[LINKED] += rho * m->linked[mend_at(m, e, k)];
        }
    mend_add_up(m, sum, SUMS);
    const double counted = reflected_light(m->op->problem, m->tally, &noise),
                 off = sum[MENDED] - counted, left = left_of(sum[LINKED] - counted, noise);
    return copysign(fmax(0, fabs(off) - left), off);
}

static void settle_sum(const struct mend_sums *m, double *irradiance)
{
    const struct hierarchy *h = m->op->hierarchy;
    const double above = sum_is_above(m, irradiance);
    double noise = 0; /* of what is counted, face by face (W2) */
    if (above == 0)
        return;
    for (uint32_t e = 0; e < h->built; e++)
        for (uint32_t k = 0; k < m->bands && is_own_face(m, e); k++) {
            const double rho = reflectance_of(m, e, k);
            noise += rho * rho * noise_of_count(m, e, k);
        }
    mend_add_up(m, &noise, 1);
    for (uint32_t e = 0; e < h->built && noise > 0; e++)
        for (uint32_t k = 0; k < m->bands && is_own_face(m, e); k++) {
            double *light = &irradiance[(size_t)e * m->bands + k];
            const double less = above * reflectance_of(m, e, k) * noise_of_count(m, e, k) / noise
                                / h->elements[e].area;
            *light = fmax(*light - less, 0.5 * *light);
        }
}

/* How far faces are off then. */
static int find_risk(const struct clusters *x, const double *irradiance, struct mended_risk *risk)
{
    const struct mend_sums *m = x->sums;
    const size_t notes = (size_t)x->count * m->bands;
    double *h = malloc((notes + 1) * sizeof *h);
    const struct mended_clusters clusters = {x->parent, x->count, h};
    if (ranks_any(m->op->shares.ranks, !h)) {
        free(h);
        return -1;
    }
    for (size_t i = 0; i < notes; i++)
        h[i] = x->note[i].class == NOTHING ? -1 : doubted(x, &x->note[i]);
    const int failed = mend_risk_find(m, &clusters, irradiance, risk);
    free(h);
    return failed;
}

static int clusters_open(struct clusters *x)
{
    const struct mend_sums *m = x->sums;
    const struct hierarchy *h = m->op->hierarchy;
    x->parent = malloc(((size_t)h->built + 1) * sizeof *x->parent);
    for (uint32_t e = 0; x->parent && e < h->built; e++)
        if (!h->elements[e].vertices && mend_is_added(m->op, e))
            x->parent[x->count++] = e;
    x->note = malloc(((size_t)x->count * m->bands + 1) * sizeof *x->note);
    return ranks_any(m->op->shares.ranks, !x->parent || !x->note) ? -1 : 0;
}

/* What is told of clusters by counts, and by them all. Returns 0 or -1, alike. */
static int find_clusters(struct clusters *x)
{
    if (clusters_open(x) < 0)
        return -1;
    thread_pool_run(x->sums->op->problem->options.threads, x->count, RUN, note_some, x);
    sum_noise(x);
    choose_thresholds(x);
    return 0;
}

static void clusters_close(struct clusters *x)
{
    free(x->parent);
    free(x->note);
}

/* What others have left of each cluster's error. Returns 0 or -1, alike. */
static int find_before(struct clusters *x, const struct mend_sums *before)
{
    struct clusters b = {.sums = before};
    const int failed = find_clusters(&b) < 0;
    for (size_t i = 0; i < (size_t)x->count * x->sums->bands && !failed; i++)
        if (b.note[i].class != NOTHING)
            x->note[i].before = b.left[b.note[i].class] * noise_in(&b, &b.note[i]);
    clusters_close(&b);
    return failed ? -1 : 0;
}

int mend_clusters(const struct mend_sums *m, const struct mend_sums *before, double *irradiance,
                  double *doubt, struct mended_risk *risk)
{
    struct clusters x = {.sums = m};
    int failed = find_clusters(&x) < 0 || (before && find_before(&x, before) < 0);
    for (uint32_t k = 0; k < m->bands && !failed; k++) {
        if (doubt)
            doubt[k] = 0;
        if (mend_is_here(&m->places, 0))
            mend_scene(m, k, before != NULL, irradiance);
    }
    for (size_t i = 0; i < x.count && !failed; i++) /* they get light from those before them */
        for (uint32_t k = 0; k < m->bands; k++)
            share_out(&x, x.parent[i], k, &x.note[i * m->bands + k], irradiance, doubt);
    failed = failed || (risk && find_risk(&x, irradiance, risk) < 0);
    if (!failed)
        settle_sum(before ? before : m, irradiance);
    clusters_close(&x);
    return failed ? -1 : 0;
}
