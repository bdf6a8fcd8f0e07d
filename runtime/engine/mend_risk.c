/* mend_risk.c - see mend_risk.h.
 *
 * A cluster's children get shares of its light: of the difference m between counted and linked
 * ones h is not believed (mend_clusters.c). What that leaves of squares, each child's weighed by u,
 * is in the mean
 *     sum u (h^2 m^2 + (1 - 2 h) v) + 4 h (m' C U m) / m' m where h < 1,
 * v the variance of a counted share, C the covariance of the children's: Stein's unbiased estimate,
 * with C as the replicates tell it. A face is off by what it gets wrong at all levels, e_f of its
 * own light a_f. For any w
 *     sum a |e| <= root (sum w) root (sum a^2 e^2 / w) [Cauchy],
 * where normal numbers have root (2 / pi) of that, and as much if w goes with the mean |a e|. So w
 * is what noise makes of each: then the second sum is the first where mending leaves all noise, and
 * next to nothing where links are right. It is one sum over all clusters, whatever their size: what
 * noise shows too much in some and too little in others cancels. So nothing is rounded up to 0
 * before all are added. w is made by what clusters as large are known by in the mean, and not by
 * the replicates of its own: what these show too small by chance would weigh too much.
 *
 * How far off that may be, too, is told by replicates, which alone know how noise is shared by
 * faces: what it has not to do with the truth is sum u (2 h - 1) (n^2 - v), n the noise. The
 * variance of such a sum is 2 tr (U C U C), and the products of each two of 16 replicates, which
 * are independent, tell it; so do differences among their squares how far v is off. Where links are
 * off themselves, by rho of what noise makes, their error meets noise as any other direction does:
 * 1 + 2 rho times that.
 *
 * [Stein 1981; the rest: derived here, coverage: tests/runtime/check_mended_error.c]
 * SPDX-License-Identifier: MIT */
#include "engine/mend_risk.h"
#include <math.h>
#include <stdlib.h>
#include "hierarchy/children_first.h"
#include "kernel/lambert.h"

enum { PAIRS = REPLICATES * (REPLICATES - 1) / 2 };

/* The variance of a mean of replicates is the sum of squares over that; the mean over replicates of
 * such squares, over OTHERS. */
static const double TO_MEAN = REPLICATES * (REPLICATES - 1.0), OTHERS = REPLICATES - 1.0;
/* products of what two replicates differ from the mean by have that of the variance of those of
 * what they differ from the truth by */
static const double OF_PRODUCTS =
    ((REPLICATES - 1.0) * (REPLICATES - 1.0) + 1) / (REPLICATES * (double)REPLICATES);

struct judging {
    const struct mend_sums *m;
    const struct mended_clusters *clusters;
    const double *irradiance;
    double *noise;  /* [place * bands + band]: what noise makes of e^2 */
    double *weight; /* likewise: sum of a^2 / w below an element, over its light's square */
};

/* W: what faces reflect, and sum w. */
struct light_sums {
    double reflected, weight;
};

/* Sums over clusters: of u h^2 m^2; of what goes with v, by replicate; and of products of two. */
struct risk_sums {
    double seen, within[REPLICATES], pair[PAIRS];
};
_Static_assert(sizeof(struct light_sums) == 2 * sizeof(double)
                   && sizeof(struct risk_sums) == (1 + REPLICATES + PAIRS) * sizeof(double),
               "sums are told as they stand");

static double light_of(const struct judging *x, uint32_t e, uint32_t k)
{
    const struct mend_sums *m = x->m;
    return x->irradiance[(size_t)e * m->bands + k] * m->op->hierarchy->elements[e].area;
}

/* A child's share of its parent's mended light. */
static double share_of(const struct judging *x, uint32_t e, uint32_t child, uint32_t k)
{
    const double whole = light_of(x, e, k);
    return whole > 0 ? light_of(x, child, k) / whole : 0;
}

/* What a child's counted share lacks of its mean, by replicate. Returns that mean. */
static double share_noise(const struct mend_sums *m, uint32_t e, uint32_t child, uint32_t k,
                          double noise[REPLICATES])
{
    const size_t values = (size_t)m->places.built * m->bands, at = mend_at(m, child, k),
                 above = mend_at(m, e, k);
    const double whole = m->received[above], share = m->received[at] / whole;
    for (size_t r = 0; r < REPLICATES; r++)
        noise[r] =
            (m->replicate[r * values + at] - share * m->replicate[r * values + above]) / whole;
    return share;
}

/* v of a class over that of shares s of one thing, s (1 - s). */
static void find_classes(const struct judging *x, double over[MEND_CLASSES])
{
    const struct mend_sums *m = x->m;
    double sum[2 * MEND_CLASSES] = {0}, *seen = sum, *alike = sum + MEND_CLASSES;
    for (size_t i = 0; i < (size_t)x->clusters->count * m->bands; i++) {
        const uint32_t e = x->clusters->parent[i / m->bands], k = (uint32_t)(i % m->bands);
        const struct element *at = &m->op->hierarchy->elements[e];
        const int class = mend_class(m, e, k);
        if (x->clusters->doubted[i] < 0 || !mend_is_noted(m, e))
            continue;
        for (uint32_t j = at->child; j < at->child + at->children; j++) {
            double noise[REPLICATES];
            const double share = share_noise(m, e, j, k, noise);
            for (int r = 0; r < REPLICATES; r++)
                seen[class] += noise[r] * noise[r] / TO_MEAN;
            alike[class] += share * (1 - share);
        }
    }
    mend_add_up(m, sum, (size_t)2 * MEND_CLASSES);
    for (int c = 0; c < MEND_CLASSES; c++)
        over[c] = alike[c] > 0 ? seen[c] / alike[c] : 0;
}

/* What noise makes of e^2, down to faces. A share is between what links and what counts say. */
static void find_noise(const struct judging *x, const double over[MEND_CLASSES])
{
    const struct mend_sums *m = x->m;
    for (size_t i = 0; i < (size_t)x->clusters->count * m->bands; i++) {
        const uint32_t e = x->clusters->parent[i / m->bands], k = (uint32_t)(i % m->bands);
        const struct element *at = &m->op->hierarchy->elements[e];
        const double class = over[mend_class(m, e, k)];
        double given[MEND_CHILDREN];
        mend_shares(m, e, k, given);
        for (uint32_t c = 0; c < at->children; c++) {
            const double share = 0.5 * (given[c] + share_of(x, e, at->child + c, k));
            const int known = share > 0 && x->clusters->doubted[i] >= 0;
            x->noise[mend_at(m, at->child + c, k)] =
                x->noise[mend_at(m, e, k)] + (known ? class * fmax(0, 1 - share) / share : 1);
        }
    }
}

/* a^2 / w of faces, over the square of the light that falls there (which e is a share of, too);
 * returns sums over all. */
static struct light_sums weigh_faces(const struct judging *x, const unsigned char *apart)
{
    const struct mend_sums *m = x->m;
    const struct hierarchy *h = m->op->hierarchy;
    struct light_sums sums = {0, 0};
    for (uint32_t e = 0; e < h->built; e++)
        for (uint32_t k = 0; k < m->bands; k++) {
            const struct element *at = &h->elements[e];
            if (!at->vertices || !mend_is_added(m->op, e))
                continue;
            const double noise = sqrt(x->noise[mend_at(m, e, k)]),
                         reflected = light_of(x, e, k)
                                     * m->op->problem->reflectance[(size_t)at->face * m->bands + k];
            sums.reflected += reflected;
            if (apart[at->face] || !(noise > 0))
                continue;
            x->weight[mend_at(m, e, k)] = reflected / noise;
            sums.weight += reflected * noise;
        }
    mend_add_up(m, &sums, 2);
    return sums;
}

static void sum_weights(const struct judging *x, uint32_t e)
{
    const struct mend_sums *m = x->m;
    const struct element *at = &m->op->hierarchy->elements[e];
    for (uint32_t j = at->child + at->children; j-- > at->child;)
        for (uint32_t k = 0; k < m->bands; k++)
            x->weight[mend_at(m, e, k)] += x->weight[mend_at(m, j, k)];
}

static void add_weights(const void *judging, uint32_t e)
{
    const struct judging *x = judging;
    if (mend_is_added(x->m->op, e) && !mend_is_shared(x->m->op, e))
        sum_weights(x, e);
}

/* Up from faces, as mend_sums.c adds light. */
static void gather_weights(const struct judging *x)
{
    const struct mend_sums *m = x->m;
    const struct hierarchy *h = m->op->hierarchy;
    children_first_clusters(h, add_weights, x);
    if (!m->places.at)
        return;
    ranks_add(m->op->shares.ranks, RANKS_PARTICLES, x->weight, (size_t)m->places.told * m->bands);
    for (uint32_t e = h->built; e-- > 0;) /* children follow their parents */
        if (mend_is_shared(m->op, e))
            sum_weights(x, e);
}

/* Of a cluster that particles met. */
static void add_known(const struct judging *x, uint32_t e, uint32_t k, double h,
                      struct risk_sums *sums)
{
    const struct mend_sums *m = x->m;
    const struct element *at = &m->op->hierarchy->elements[e];
    double given[MEND_CHILDREN], all = 0, along[REPLICATES] = {0}, weighed[REPLICATES] = {0};
    mend_shares(m, e, k, given);
    for (uint32_t c = 0; c < at->children; c++) {
        double noise[REPLICATES];
        const uint32_t j = at->child + c;
        const double off = share_noise(m, e, j, k, noise) - given[c], share = share_of(x, e, j, k),
                     u = share > 0 ? x->weight[mend_at(m, j, k)] / (share * share) : 0;
        sums->seen += u * h * h * off * off;
        all += off * off;
        for (int r = 0, pair = 0; r < REPLICATES; r++) {
            const double unsure = u * (2 * h - 1) * noise[r];
            sums->within[r] -= unsure * noise[r];
            along[r] += off * noise[r];
            weighed[r] += u * off * noise[r];
            for (int s = 0; s < r; s++)
                sums->pair[pair++] += unsure * noise[s];
        }
    }
    for (int r = 0; r < REPLICATES && h < 1 && all > 0; r++)
        sums->within[r] += 4 * h * along[r] * weighed[r] / all;
}

static void add_clusters(const struct judging *x, struct risk_sums *sums)
{
    const struct mend_sums *m = x->m;
    for (size_t i = 0; i < (size_t)x->clusters->count * m->bands; i++) {
        const uint32_t e = x->clusters->parent[i / m->bands], k = (uint32_t)(i % m->bands);
        if (!mend_is_noted(m, e))
            continue;
        if (x->clusters->doubted[i] < 0) /* each may be off by all that it has */
            sums->seen += x->weight[mend_at(m, e, k)];
        else
            add_known(x, e, k, x->clusters->doubted[i], sums);
    }
    mend_add_up(m, sums, 1 + REPLICATES + PAIRS);
}

/* The variance of products of two replicates. */
static double products_variance(const double pair[PAIRS])
{
    double mean = 0, square = 0;
    for (int i = 0; i < PAIRS; i++)
        mean += pair[i] / PAIRS;
    for (int i = 0; i < PAIRS; i++)
        square += (pair[i] - mean) * (pair[i] - mean);
    return square / (PAIRS * OF_PRODUCTS);
}

static void conclude(const struct light_sums *light, const struct risk_sums *sums,
                     struct mended_risk *risk)
{
    double variance;
    const double within = replicates_mean(sums->within, &variance),
                 left = sums->seen + within / OTHERS, squares = variance / (OTHERS * OTHERS),
                 products = products_variance(sums->pair) / (REPLICATES * (double)REPLICATES),
                 deviation = sqrt(2 * products * (1 + 2 * fmax(0, left / light->weight)) + squares),
                 normal = 2 / LAMBERT_PI * light->weight;
    risk->value = sqrt(normal * fmax(0, left + deviation)) / light->reflected;
    risk->most = sqrt(normal * fmax(0, left + REPLICATES_T * deviation)) / light->reflected;
}

int mend_risk_find(const struct mend_sums *m, const struct mended_clusters *clusters,
                   const double *irradiance, struct mended_risk *risk)
{
    const size_t values = (size_t)m->places.built * m->bands + 1;
    struct judging x = {.m = m, .clusters = clusters, .irradiance = irradiance};
    struct risk_sums *sums = calloc(1, sizeof *sums);
    x.noise = calloc(values, sizeof *x.noise);
    x.weight = calloc(values, sizeof *x.weight);
    risk->value = risk->most = 0;
    const int failed = ranks_any(m->op->shares.ranks, !sums || !x.noise || !x.weight);
    if (!failed) {
        double over[MEND_CLASSES];
        find_classes(&x, over);
        find_noise(&x, over);
        const struct light_sums light = weigh_faces(&x, risk->apart);
        gather_weights(&x);
        add_clusters(&x, sums);
        if (light.weight > 0 && light.reflected > 0)
            conclude(&light, sums, risk);
    }
    free(x.noise);
    free(x.weight);
    free(sums);
    return failed ? -1 : 0;
}
