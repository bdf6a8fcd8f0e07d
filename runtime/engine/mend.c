/* mend.c - the solution plus the measured error, level by level: better than links or particles
 * alone.
 *
 * Links know how light is spread over small places, particles how much there is in large ones. So
 * the tree is gone down from the root. What an element receives is known when its children's turn
 * comes; how it is shared among them is told twice, by the links (q~ of each child) and by the
 * particles that landed there (q^). Taken is
 *     q = q~ + k (q^ - q~):
 * what particles see is believed as far as it stands out of their noise. Both are shares, so none
 * is below 0, and power is neither made nor lost on the way down. Clusters come first, down to
 * faces (mend_clusters.c); here follow their parts, for which
 *     k = max(0, 1 - sum s^2 / sum m^2),   m = q^ - q~,
 * one k for the children of one element, s the standard errors of m, as chance makes them, of a
 * multinomial.
 *
 * sum m^2 of four children is a noisy thing itself. So elements are put in classes, surfaces by how
 * many particles they met: within a class noise is alike, and what is seen of it is what links are
 * worth at that size in this scene; what is seen near by, among an element's kin, is what they are
 * worth there: a shadow's edge on the floor is no reason to doubt a smooth wall. In place of an
 * element's own sum m^2 stands a mean of it and of what class and kin expect. Where a class shows
 * nothing beyond noise, links are left alone, so that good links are not made worse; but an element
 * that is far out is believed for itself.
 *
 * [James and Stein 1961, for k; Efron and Morris 1972, for classes and outliers; Cai 1999, blocks
 * in a tree; shares of a tree's nodes: Polya trees, Lavine 1992; the rest: derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/mend.h"
#include "engine/mend_clusters.h"
#include "hierarchy/levels.h"
#include "kernel/constants.h"
#include "util/thread_pool.h"

/* Sums of m^2 and of s^2, of one element or of a class. */
struct sight {
    double seen, noise, elements;
};

/* How well what a parent's children lack foretells what a child's own children lack: sums, over a
 * class, of the foretold times what is seen, of its square, and of the variance of the first. */
struct trend {
    double product, square, noise;
};

/* What one element adds to the sums of its class; NOTHING to those of none. */
enum { NOTHING = -1 };
struct note {
    int class;
    uint32_t elder; /* sights: the head of its kin */
    union {
        struct trend trend;
        struct sight sight;
    };
};

struct mending {
    struct mend_sums sums;
    const struct tally *before; /* that has mended already; NULL: none */
    double *irradiance;         /* [element * bands + band]: by links, then mended (W/m2) */
    struct levels levels;
    /* of the level that is mended now: elements that have children; what each adds to the sums */
    const uint32_t *parent;
    uint32_t parents;
    struct note *note; /* [parent * bands + band] */
    /* of this level, by the logarithm of their particles */
    struct sight class[MEND_CLASSES];
    struct trend trend[MEND_CLASSES];
    struct sight *kin; /* [place]: of what hangs two levels below it, on this level */
};

enum { RUN = 256 /* elements that a thread takes at once */ };

/* Where the irradiance of an element is. */
static size_t at_element(const struct mending *m, uint32_t element, uint32_t band)
{
    return (size_t)element * m->sums.bands + band;
}

/* What was counted on it, a mean (W). */
static double received(const struct mending *m, uint32_t element, uint32_t band)
{
    return m->sums.received[mend_at(&m->sums, element, band)];
}

/* The mended light of an element over that by links. */
static double correction(const struct mending *m, uint32_t e, uint32_t k)
{
    double linked = m->sums.linked[mend_at(&m->sums, e, k)];
    return linked > 0 ? m->irradiance[at_element(m, e, k)] * m->sums.op->hierarchy->elements[e].area
                            / linked
                      : 1;
}

/* What the children of e lack of `given`, foretold: the correction of e and of its siblings, as a
 * plane over their parent, goes on below. Returns 0 where there are none. */
static int foretell(const struct mending *m, uint32_t e, uint32_t k, const double *given,
                    double lack[MEND_CHILDREN])
{
    const struct element *elements = m->sums.op->hierarchy->elements, *at = &elements[e];
    const struct element *parent = &elements[at->parent];
    double own = correction(m, e, k), u[3], v[3], uu = 0, uv = 0, vv = 0, ur = 0, vr = 0, sum = 0;
    if (!at->depth || !(own > 0))
        return 0;
    sub3(u, elements[parent->child].centre, parent->centre);
    cross3(v, parent->normal, u);
    for (uint32_t c = 0; c < parent->children; c++) {
        double off[3], r = correction(m, parent->child + c, k);
        sub3(off, elements[parent->child + c].centre, parent->centre);
        double x = dot3(u, off), y = dot3(v, off);
        uu += x * x;
        uv += x * y;
        vv += y * y;
        ur += x * r;
        vr += y * r;
    }
    double det = uu * vv - uv * uv;
    if (!(det > 0))
        return 0;
    for (uint32_t c = 0; c < at->children; c++) {
        double off[3];
        sub3(off, elements[at->child + c].centre, at->centre);
        double tilt =
            ((vv * ur - uv * vr) * dot3(u, off) + (uu * vr - uv * ur) * dot3(v, off)) / det;
        lack[c] = given[c] * fmin(fmax(tilt / own, -1), 1);
        sum += lack[c];
    }
    for (uint32_t c = 0; c < at->children; c++) /* shares go on to sum to 1 */
        lack[c] -= sum * given[c];
    return 1;
}

/* m^2 and s^2 among the children of e, which some particles met. */
static struct sight see(const struct mending *m, uint32_t e, uint32_t k, const double *given)
{
    const struct element *at = &m->sums.op->hierarchy->elements[e];
    double noise = 0, seen = 0, whole = received(m, e, k);
    for (uint32_t c = 0; c < at->children; c++) {
        uint32_t j = at->child + c;
        double off = received(m, j, k) - given[c] * whole;
        seen += off * off;
        noise += mend_chance(&m->sums, k, given[c], received(m, j, k), whole);
    }
    return (struct sight){seen / (whole * whole), noise / (whole * whole), 1};
}

/* k of one element among its class; `above`: how far squares of its like are above noise. */
static double believed(const struct sight *own, const struct sight *class, double above)
{
    double ratio = class->seen / class->noise, expected = own->noise * fmax(1, above), seen = 0;
    if (ratio > 1 + MEND_EVIDENCE * sqrt(2.0 / class->elements))
        seen = MEND_OWN * own->seen + (1 - MEND_OWN) * expected;
    if (own->seen > MEND_OUTLIER * MEND_OUTLIER * expected)
        seen = own->seen;
    return seen > own->noise ? 1 - own->noise / seen : 0;
}

/* The most that is believed of what is counted: that of the best mixture with what others, whose
 * noise it has once mended, have counted. Particles that carry less than others are thought to be
 * as noisy as those that carry most. Of paths leaves have no counts, and what particles have told
 * of leaves before paths did is not asked for again. */
static double most_believed(const struct mending *m, uint32_t band)
{
    const struct tally *now = m->sums.tally, *before = m->before;
    if (!before || before->by_paths)
        return 1;
    const double noise = tally_power_of_one(now) * now->square[band],
                 others = tally_power_of_one(before) * before->square[band];
    return others > 0 ? others / (others + noise) : 0;
}

/* The shares of the children of e, before any particle below it is looked at. */
static void foretold_shares(const struct mending *m, uint32_t e, uint32_t k,
                            double given[MEND_CHILDREN])
{
    const struct trend *t = &m->trend[mend_class(&m->sums, e, k)];
    double lack[MEND_CHILDREN];
    mend_shares(&m->sums, e, k, given);
    if (!(t->product > MEND_EVIDENCE * sqrt(t->noise)) || !foretell(m, e, k, given, lack))
        return;
    for (uint32_t c = 0; c < m->sums.op->hierarchy->elements[e].children; c++)
        given[c] += fmin(1, t->product / t->square) * lack[c];
}

static struct note note_trend(const struct mending *m, uint32_t e, uint32_t k)
{
    const struct element *at = &m->sums.op->hierarchy->elements[e];
    struct note note = {.class = NOTHING};
    double given[MEND_CHILDREN], lack[MEND_CHILDREN], whole = received(m, e, k);
    mend_shares(&m->sums, e, k, given);
    if (!(whole > 0) || !foretell(m, e, k, given, lack))
        return note;
    note.class = mend_class(&m->sums, e, k);
    note.trend = (struct trend){0, 0, 0};
    for (uint32_t c = 0; c < at->children; c++) {
        double here = received(m, at->child + c, k);
        note.trend.product += lack[c] * (here / whole - given[c]);
        note.trend.square += lack[c] * lack[c];
        note.trend.noise +=
            lack[c] * lack[c] * tally_chance(m->sums.tally, here, k) / (whole * whole);
    }
    return note;
}

/* Its parent's parent, as far up as they are of one face: the head of its kin. */
static uint32_t elder(const struct mending *m, uint32_t e)
{
    const struct element *elements = m->sums.op->hierarchy->elements;
    for (int up = 0; up < 2 && elements[e].depth > 0; up++)
        e = elements[e].parent;
    return e;
}

static void add_sight(struct sight *sum, const struct sight *own)
{
    sum->seen += own->seen;
    sum->noise += own->noise;
    sum->elements++;
}

static struct note note_sight(const struct mending *m, uint32_t e, uint32_t k)
{
    double given[MEND_CHILDREN];
    if (!(received(m, e, k) > 0))
        return (struct note){.class = NOTHING};
    foretold_shares(m, e, k, given);
    return (struct note){
        .class = mend_class(&m->sums, e, k), .elder = elder(m, e), .sight = see(m, e, k, given)};
}

/* How far m^2 is above noise among elements like this one: of its kin, as far as they are many
 * enough to tell, and of its class. */
static double above_noise(const struct mending *m, uint32_t e, uint32_t k)
{
    const struct sight *class = &m->class[mend_class(&m->sums, e, k)],
                       *kin = &m->kin[mend_place(&m->sums.places, elder(m, e))];
    double n = kin->elements;
    return (MEND_KIN * class->seen / class->noise + n * kin->seen / kin->noise) / (MEND_KIN + n);
}

/* Share out what e receives, mended by now, among its children. */
static void share_out(const struct mending *m, uint32_t e, uint32_t k)
{
    const struct element *elements = m->sums.op->hierarchy->elements, *at = &elements[e];
    double given[MEND_CHILDREN], whole = m->irradiance[at_element(m, e, k)] * at->area;
    double counted = received(m, e, k), belief = 0;
    foretold_shares(m, e, k, given);
    if (counted > 0) {
        struct sight own = see(m, e, k, given);
        belief = fmin(most_believed(m, k),
                      believed(&own, &m->class[mend_class(&m->sums, e, k)], above_noise(m, e, k)));
    }
    for (uint32_t c = 0; c < at->children; c++) {
        uint32_t j = at->child + c;
        double share = given[c];
        if (belief > 0)
            share += belief * (received(m, j, k) / counted - given[c]);
        m->irradiance[at_element(m, j, k)] = share * whole / elements[j].area;
    }
}

static void note_trends(const void *mending, size_t from, size_t to)
{
    const struct mending *m = mending;
    for (size_t i = from; i < to; i++)
        for (uint32_t k = 0; k < m->sums.bands; k++)
            m->note[i * m->sums.bands + k] = note_trend(m, m->parent[i], k);
}

static void note_sights(const void *mending, size_t from, size_t to)
{
    const struct mending *m = mending;
    for (size_t i = from; i < to; i++)
        for (uint32_t k = 0; k < m->sums.bands; k++)
            m->note[i * m->sums.bands + k] = note_sight(m, m->parent[i], k);
}

static void share_all_out(const void *mending, size_t from, size_t to)
{
    const struct mending *m = mending;
    for (size_t i = from; i < to; i++)
        for (uint32_t k = 0; k < m->sums.bands; k++)
            share_out(m, m->parent[i], k);
}

/* Sums are taken in the order of elements, whoever took the notes. */
static void add_trends(struct mending *m)
{
    memset(m->trend, 0, sizeof m->trend);
    for (size_t i = 0; i < (size_t)m->parents * m->sums.bands; i++) {
        const struct note *note = &m->note[i];
        if (note->class == NOTHING)
            continue;
        struct trend *t = &m->trend[note->class];
        t->product += note->trend.product;
        t->square += note->trend.square;
        t->noise += note->trend.noise;
    }
}

static void add_sights(struct mending *m)
{
    const size_t notes = (size_t)m->parents * m->sums.bands;
    memset(m->class, 0, sizeof m->class);
    for (size_t i = 0; i < notes; i++)
        if (m->note[i].class != NOTHING)
            m->kin[mend_place(&m->sums.places, m->note[i].elder)] = (struct sight){0, 0, 0};
    for (size_t i = 0; i < notes; i++) {
        const struct note *note = &m->note[i];
        if (note->class == NOTHING)
            continue;
        const struct sight *own = &note->sight;
        if (mend_is_noted(&m->sums, m->parent[i / m->sums.bands]))
            add_sight(&m->class[note->class], own);
        add_sight(&m->kin[mend_place(&m->sums.places, note->elder)], own);
    }
}

_Static_assert(sizeof(struct trend) == 3 * sizeof(double)
                   && sizeof(struct sight) == 3 * sizeof(double),
               "sums are told as they stand");

static void mend_level(struct mending *m, uint32_t level)
{
    const int threads = m->sums.op->problem->options.threads;
    m->parent = &m->levels.parent[m->levels.from[level]];
    m->parents = m->levels.from[level + 1] - m->levels.from[level];
    thread_pool_run(threads, m->parents, RUN, note_trends, m);
    add_trends(m);
    mend_add_up(&m->sums, m->trend, (size_t)3 * MEND_CLASSES);
    thread_pool_run(threads, m->parents, RUN, note_sights, m);
    add_sights(m);
    mend_add_up(&m->sums, m->class, (size_t)3 * MEND_CLASSES);
    thread_pool_run(threads, m->parents, RUN, share_all_out, m);
}

/* The most parents that a level has. */
static uint32_t widest(const struct levels *l)
{
    uint32_t most = 0;
    for (int i = 0; i < LEVELS; i++)
        if (l->from[i + 1] - l->from[i] > most)
            most = l->from[i + 1] - l->from[i];
    return most;
}

/* How many levels any rank has. */
static uint32_t levels_of_all(const struct mending *m)
{
    double count = 0;
    for (uint32_t i = 0; i < LEVELS; i++)
        if (m->levels.from[i + 1] > m->levels.from[i])
            count = i + 1;
    if (m->sums.op->shares.common)
        ranks_most(m->sums.op->shares.ranks, RANKS_PARTICLES, &count, 1);
    return (uint32_t)count;
}

static int open_levels(struct levels *l, const struct light_operator *op)
{
    if (ranks_any(op->shares.ranks, levels_open(l, op->hierarchy) < 0))
        return -1;
    if (op->shares.common)
        mend_places_levels(op, l);
    return 0;
}

int mend_irradiance(const struct light_operator *op, const struct tally *tally, double *irradiance)
{
    return mend_again(op, tally, NULL, NULL, irradiance);
}

int mend_again(const struct light_operator *op, const struct tally *tally,
               const struct tally *before, const double *links, double *irradiance)
{
    struct mending m = {.before = before, .irradiance = irradiance};
    struct mend_sums earlier = {0};
    int failed = open_levels(&m.levels, op) < 0
                 || mend_sums_open(&m.sums, op, tally, MEND_LEAVES, irradiance) < 0
                 || (before && mend_sums_open(&earlier, op, before, MEND_FACES, links) < 0)
                 || mend_clusters(&m.sums, before ? &earlier : NULL, irradiance, NULL, NULL) < 0;
    mend_sums_close(&earlier);
    if (!failed) {
        m.kin = malloc(((size_t)m.sums.places.count + 1) * sizeof *m.kin);
        m.note = malloc(((size_t)widest(&m.levels) * m.sums.bands + 1) * sizeof *m.note);
        failed = ranks_any(op->shares.ranks, !m.kin || !m.note);
    }
    const uint32_t count = failed ? 0 : levels_of_all(&m);
    for (uint32_t level = 1; level < count; level++)
        mend_level(&m, level);
    free(m.note);
    free(m.kin);
    mend_sums_close(&m.sums);
    levels_close(&m.levels);
    return failed ? -1 : 0;
}

int mend_faces(const struct light_operator *op, const struct tally *tally, const double *light,
               struct mended_faces *faces, struct mended_risk *risk)
{
    const size_t values = (size_t)op->hierarchy->built * tally->bands + 1;
    struct mend_sums sums;
    faces->irradiance = calloc(values, sizeof *faces->irradiance);
    faces->doubt = calloc(values, sizeof *faces->doubt);
    if (ranks_any(op->shares.ranks, !faces->irradiance || !faces->doubt))
        return -1;
    const int failed = mend_sums_open(&sums, op, tally, MEND_FACES, light) < 0
                       || mend_clusters(&sums, NULL, faces->irradiance, faces->doubt, risk) < 0;
    mend_sums_close(&sums);
    return failed ? -1 : 0;
}

void mended_faces_close(struct mended_faces *faces)
{
    free(faces->irradiance);
    free(faces->doubt);
}
