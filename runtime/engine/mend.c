/* mend.c - the solution plus the measured error, level by level: better than links or particles
 * alone.
 *
 * Links know how light is spread over small places, particles how much there is in large ones. So
 * the tree is gone down from the root. What an element receives is known when its children's turn
 * comes; how it is shared among them is told twice, by the links (q~ of each child) and by the
 * particles that landed there (q^). Taken is
 *     q = q~ + k (q^ - q~),   k = max(0, 1 - sum s^2 / sum m^2),   m = q^ - q~,
 * one k for the children of one element, s the standard errors of m: what particles see is believed
 * as far as it stands out of their noise. Both are shares, so none is below 0, and power is neither
 * made nor lost on the way down. The root takes k of what it lacks, a class of its own.
 *
 * sum m^2 of two or four children is a noisy thing itself. So elements are put in classes, clusters
 * or surfaces by how many particles they met: within a class noise is alike, and what is seen of it
 * is what links are worth at that size in this scene; what is seen near by, among an element's kin,
 * is what they are worth there: a shadow's edge on the floor is no reason to doubt a smooth wall.
 * In place of an element's own sum m^2 stands a mean of it and of what class and kin expect. Where
 * a class shows nothing beyond noise, links are left alone, so that good links are not made worse;
 * but an element that is far out is believed for itself.
 *
 * s^2 above the faces and among them is told by the replicates, which see correlations that chance
 * does not; below, and where few particles land and replicates would say little, it is that of
 * chance, of a multinomial.
 *
 * [James and Stein 1961, for k; Efron and Morris 1972, for classes and outliers; Cai 1999, blocks
 * in a tree; shares of a tree's nodes: Polya trees, Lavine 1992; the rest: derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/leaf_count.h"
#include "engine/mend.h"
#include "engine/mend_places.h"
#include "hierarchy/children_first.h"
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

enum { CLASSES = 48 };

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
    const struct light_operator *op;
    const struct tally *tally;
    uint32_t bands;
    struct mend_places places; /* of the elements that are mended here */
    double *irradiance;        /* [element * bands + band]: by links, then mended (W/m2) */
    double *linked;            /* [place * bands + band]: power by links (W) */
    double *received;          /* the same, counted, mean of all replicates */
    double *replicate;         /* [REPLICATES][places.built * bands]: by each (W) */
    struct levels levels;
    /* of the level that is mended now: elements that have children; what each adds to the sums */
    const uint32_t *parent;
    uint32_t parents;
    struct note *note; /* [parent * bands + band] */
    /* of this level, by the logarithm of their particles */
    struct sight class[CLASSES];
    struct trend trend[CLASSES];
    struct sight *kin; /* [place]: of what hangs two levels below it, on this level */
};

enum { CHILDREN = 255, RUN = 256 /* elements that a thread takes at once */ };

/* Where the irradiance of an element is, and what is known of it while it is mended. */
static size_t at_element(const struct mending *m, uint32_t element, uint32_t band)
{
    return (size_t)element * m->bands + band;
}
static size_t place(const struct mending *m, uint32_t element, uint32_t band)
{
    return (size_t)mend_place(&m->places, element) * m->bands + band;
}

/* q~ of each child of e in a band. */
static void shares_by_links(const struct mending *m, uint32_t e, uint32_t k, double given[CHILDREN])
{
    const struct element *elements = m->op->hierarchy->elements, *at = &elements[e];
    double linked = 0;
    for (uint32_t c = 0; c < at->children; c++)
        linked += m->linked[place(m, at->child + c, k)];
    for (uint32_t c = 0; c < at->children; c++) {
        uint32_t j = at->child + c;
        given[c] = linked > 0 ? m->linked[place(m, j, k)] / linked : elements[j].area / at->area;
    }
}

/* The mended light of an element over that by links. */
static double correction(const struct mending *m, uint32_t e, uint32_t k)
{
    double linked = m->linked[place(m, e, k)];
    return linked > 0
               ? m->irradiance[at_element(m, e, k)] * m->op->hierarchy->elements[e].area / linked
               : 1;
}

/* What the children of e lack of `given`, foretold: the correction of e and of its siblings, as a
 * plane over their parent, goes on below. Returns 0 where there are none. */
static int foretell(const struct mending *m, uint32_t e, uint32_t k, const double *given,
                    double lack[CHILDREN])
{
    const struct element *elements = m->op->hierarchy->elements, *at = &elements[e];
    const struct element *parent = &elements[at->parent];
    double own = correction(m, e, k), u[3], v[3], uu = 0, uv = 0, vv = 0, ur = 0, vr = 0, sum = 0;
    if (!at->vertices || !at->depth || !(own > 0))
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

/* s^2 of a child that has the share `given` of `whole`, of which `here` were counted there, if
 * chance alone spread particles (W2). */
static double noise_of_chance(const struct mending *m, uint32_t k, double given, double here,
                              double whole)
{
    return (1 - given) * (1 - given) * tally_chance(m->tally, here, k)
           + given * given * tally_chance(m->tally, fmax(whole - here, 0), k);
}

/* The same of child j of e by replicates, off what it has more than given. Where few land, or
 * should by links, these say little, and where none did, nothing: then as far by chance. */
static double noise_of_replicates(const struct mending *m, uint32_t e, uint32_t j, uint32_t k,
                                  double given, double off)
{
    double seen = 0, whole = m->received[place(m, e, k)];
    for (int r = 0; r < REPLICATES; r++) {
        const double *of = &m->replicate[(size_t)r * m->places.built * m->bands];
        double d = of[place(m, j, k)] - given * of[place(m, e, k)] - off;
        seen += d * d / (REPLICATES * (REPLICATES - 1.0));
    }
    if (m->tally->by_paths)
        return seen;
    double likely = fmax(m->received[place(m, j, k)], given * whole),
           believed = likely / (likely + FACE_ERROR_FEW * tally_power_of_one(m->tally));
    return believed * seen + (1 - believed) * noise_of_chance(m, k, given, likely, whole);
}

/* m^2 and s^2 among the children of e, which some particles met. */
static struct sight see(const struct mending *m, uint32_t e, uint32_t k, const double *given)
{
    const struct hierarchy *h = m->op->hierarchy;
    const struct element *at = &h->elements[e];
    double noise = 0, seen = 0, whole = m->received[place(m, e, k)];
    for (uint32_t c = 0; c < at->children; c++) {
        uint32_t j = at->child + c;
        double off = m->received[place(m, j, k)] - given[c] * whole;
        seen += off * off;
        noise += j < h->built ? noise_of_replicates(m, e, j, k, given[c], off)
                              : noise_of_chance(m, k, given[c], m->received[place(m, j, k)], whole);
    }
    return (struct sight){seen / (whole * whole), noise / (whole * whole), 1};
}

/* The class of an element in a band. */
static int class_of(const struct mending *m, uint32_t e, uint32_t k)
{
    double particles = m->received[place(m, e, k)] / tally_power_of_one(m->tally);
    int class = particles > 1 ? (int)log2(particles) : 0;
    return class < CLASSES ? class : CLASSES - 1;
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

/* The shares of the children of e, before any particle below it is looked at. */
static void foretold_shares(const struct mending *m, uint32_t e, uint32_t k, double given[CHILDREN])
{
    const struct trend *t = &m->trend[class_of(m, e, k)];
    double lack[CHILDREN];
    shares_by_links(m, e, k, given);
    if (!(t->product > MEND_EVIDENCE * sqrt(t->noise)) || !foretell(m, e, k, given, lack))
        return;
    for (uint32_t c = 0; c < m->op->hierarchy->elements[e].children; c++)
        given[c] += fmin(1, t->product / t->square) * lack[c];
}

static struct note note_trend(const struct mending *m, uint32_t e, uint32_t k)
{
    const struct element *at = &m->op->hierarchy->elements[e];
    struct note note = {.class = NOTHING};
    double given[CHILDREN], lack[CHILDREN], whole = m->received[place(m, e, k)];
    shares_by_links(m, e, k, given);
    if (!(whole > 0) || !foretell(m, e, k, given, lack))
        return note;
    note.class = class_of(m, e, k);
    note.trend = (struct trend){0, 0, 0};
    for (uint32_t c = 0; c < at->children; c++) {
        double here = m->received[place(m, at->child + c, k)];
        note.trend.product += lack[c] * (here / whole - given[c]);
        note.trend.square += lack[c] * lack[c];
        note.trend.noise += lack[c] * lack[c] * tally_chance(m->tally, here, k) / (whole * whole);
    }
    return note;
}

/* Its parent's parent, as far up as they are of one face: the head of its kin. */
static uint32_t elder(const struct mending *m, uint32_t e)
{
    const struct element *elements = m->op->hierarchy->elements;
    for (int up = 0; up < 2 && elements[e].vertices && elements[e].depth > 0; up++)
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
    double given[CHILDREN];
    if (!(m->received[place(m, e, k)] > 0))
        return (struct note){.class = NOTHING};
    foretold_shares(m, e, k, given);
    return (struct note){
        .class = class_of(m, e, k), .elder = elder(m, e), .sight = see(m, e, k, given)};
}

/* How far m^2 is above noise among elements like this one: of its kin, as far as they are many
 * enough to tell, and of its class. */
static double above_noise(const struct mending *m, uint32_t e, uint32_t k)
{
    const struct sight *class = &m->class[class_of(m, e, k)],
                       *kin = &m->kin[mend_place(&m->places, elder(m, e))];
    double n = kin->elements;
    return (MEND_KIN * class->seen / class->noise + n * kin->seen / kin->noise) / (MEND_KIN + n);
}

/* Share out what e receives, mended by now, among its children. */
static void share_out(const struct mending *m, uint32_t e, uint32_t k)
{
    const struct element *elements = m->op->hierarchy->elements, *at = &elements[e];
    double given[CHILDREN], whole = m->irradiance[at_element(m, e, k)] * at->area;
    double counted = m->received[place(m, e, k)], belief = 0;
    foretold_shares(m, e, k, given);
    if (counted > 0) {
        struct sight own = see(m, e, k, given);
        belief = believed(&own, &m->class[class_of(m, e, k)], above_noise(m, e, k));
    }
    for (uint32_t c = 0; c < at->children; c++) {
        uint32_t j = at->child + c;
        double share = given[c];
        if (belief > 0)
            share += belief * (m->received[place(m, j, k)] / counted - given[c]);
        m->irradiance[at_element(m, j, k)] = share * whole / elements[j].area;
    }
}

static void note_trends(const void *mending, size_t from, size_t to)
{
    const struct mending *m = mending;
    for (size_t i = from; i < to; i++)
        for (uint32_t k = 0; k < m->bands; k++)
            m->note[i * m->bands + k] = note_trend(m, m->parent[i], k);
}

static void note_sights(const void *mending, size_t from, size_t to)
{
    const struct mending *m = mending;
    for (size_t i = from; i < to; i++)
        for (uint32_t k = 0; k < m->bands; k++)
            m->note[i * m->bands + k] = note_sight(m, m->parent[i], k);
}

static void share_all_out(const void *mending, size_t from, size_t to)
{
    const struct mending *m = mending;
    for (size_t i = from; i < to; i++)
        for (uint32_t k = 0; k < m->bands; k++)
            share_out(m, m->parent[i], k);
}

/* Sums are taken in the order of elements, whoever took the notes. */
static void add_trends(struct mending *m)
{
    memset(m->trend, 0, sizeof m->trend);
    for (size_t i = 0; i < (size_t)m->parents * m->bands; i++) {
        const struct note *note = &m->note[i];
        if (note->class == NOTHING)
            continue;
        struct trend *t = &m->trend[note->class];
        t->product += note->trend.product;
        t->square += note->trend.square;
        t->noise += note->trend.noise;
    }
}

/* Is the sight of an element for its class this rank's to add? */
static int is_noted(const struct mending *m, uint32_t e)
{
    return !m->op->shares.common || shares_counts(&m->op->shares, e);
}

static void add_sights(struct mending *m)
{
    const size_t notes = (size_t)m->parents * m->bands;
    memset(m->class, 0, sizeof m->class);
    for (size_t i = 0; i < notes; i++)
        if (m->note[i].class != NOTHING)
            m->kin[mend_place(&m->places, m->note[i].elder)] = (struct sight){0, 0, 0};
    for (size_t i = 0; i < notes; i++) {
        const struct note *note = &m->note[i];
        if (note->class == NOTHING)
            continue;
        const struct sight *own = &note->sight;
        if (is_noted(m, m->parent[i / m->bands]))
            add_sight(&m->class[note->class], own);
        add_sight(&m->kin[mend_place(&m->places, note->elder)], own);
    }
}

/* The same of all ranks, where each has notes of its own: three numbers for each class. */
static void add_up(const struct mending *m, void *classes)
{
    _Static_assert(sizeof(struct trend) == 3 * sizeof(double)
                       && sizeof(struct sight) == 3 * sizeof(double),
                   "sums are told as they stand");
    if (m->op->shares.common)
        ranks_add(m->op->shares.ranks, RANKS_PARTICLES, classes, 3 * CLASSES);
}

/* Clusters get their light from those before them. */
static void mend_level(struct mending *m, uint32_t level)
{
    const int threads = level > 0 ? m->op->problem->options.threads : 1;
    m->parent = &m->levels.parent[m->levels.from[level]];
    m->parents = m->levels.from[level + 1] - m->levels.from[level];
    thread_pool_run(threads, m->parents, RUN, note_trends, m);
    add_trends(m);
    add_up(m, m->trend);
    thread_pool_run(threads, m->parents, RUN, note_sights, m);
    add_sights(m);
    add_up(m, m->class);
    thread_pool_run(threads, m->parents, RUN, share_all_out, m);
}

static void mend_root(struct mending *m, uint32_t k)
{
    const struct hierarchy *h = m->op->hierarchy;
    double noise = 0, off = m->received[place(m, 0, k)] - m->linked[place(m, 0, k)];
    for (int r = 0; r < REPLICATES; r++) {
        double d = m->replicate[(size_t)r * m->places.built * m->bands + place(m, 0, k)]
                   - m->received[place(m, 0, k)];
        noise += d * d / (REPLICATES * (REPLICATES - 1.0));
    }
    const struct sight own = {off * off, noise, 1};
    double belief = believed(&own, &own, own.seen / own.noise);
    m->irradiance[at_element(m, 0, k)] =
        (m->linked[place(m, 0, k)] + belief * off) / h->elements[0].area;
}

/* Powers of leaves and faces, of which others tell theirs; */
static void fill_some(const void *mending, size_t from, size_t to)
{
    const struct mending *m = mending;
    const struct hierarchy *h = m->op->hierarchy;
    for (uint32_t e = (uint32_t)from; e < to; e++) {
        const struct element *at = &h->elements[e];
        const int added = mend_is_added(m->op, e);
        for (uint32_t k = 0; k < m->bands && mend_is_here(&m->places, e); k++) {
            m->linked[place(m, e, k)] =
                at->children || !added ? 0 : at->area * m->irradiance[at_element(m, e, k)];
            m->received[place(m, e, k)] = at->children || !at->vertices || !added
                                              ? 0
                                              : leaf_count(m->tally, h, m->irradiance, e, k);
            for (int r = 0; r < REPLICATES && e < h->built; r++)
                m->replicate[(size_t)r * m->places.built * m->bands + place(m, e, k)] =
                    at->vertices && added ? tally_face(m->tally, r, at->face, k) : 0;
        }
    }
}

static void sum_children(const struct mending *m, uint32_t e)
{
    const struct hierarchy *h = m->op->hierarchy;
    const struct element *at = &h->elements[e];
    for (uint32_t j = at->child + at->children; j-- > at->child;)
        for (uint32_t k = 0; k < m->bands; k++) {
            m->linked[place(m, e, k)] += m->linked[place(m, j, k)];
            m->received[place(m, e, k)] += m->received[place(m, j, k)];
            for (int r = 0; r < REPLICATES && j < h->built; r++) {
                double *of = &m->replicate[(size_t)r * m->places.built * m->bands];
                of[place(m, e, k)] += of[place(m, j, k)];
            }
        }
}

/* sums from there up, of what is this rank's alone; */
static void add_children(const void *mending, uint32_t e)
{
    const struct mending *m = mending;
    if (mend_is_added(m->op, e) && !mend_is_shared(m->op, e))
        sum_children(m, e);
}

/* and then of what all have: each rank tells of its own, to zeros, and all sum in one order, so
 * that these have the bits of one process. */
static void add_told(const struct mending *m)
{
    struct ranks *ranks = m->op->shares.ranks;
    const size_t values = (size_t)m->places.told * m->bands;
    if (!m->places.at)
        return;
    ranks_add(ranks, RANKS_PARTICLES, m->linked, values);
    ranks_add(ranks, RANKS_PARTICLES, m->received, values);
    for (size_t r = 0; r < REPLICATES; r++)
        ranks_add(ranks, RANKS_PARTICLES, &m->replicate[r * m->places.built * m->bands], values);
    for (uint32_t e = m->op->hierarchy->built; e-- > 0;) /* children follow their parents */
        if (mend_is_shared(m->op, e))
            sum_children(m, e);
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
    if (m->op->shares.common)
        ranks_most(m->op->shares.ranks, RANKS_PARTICLES, &count, 1);
    return (uint32_t)count;
}

static int open_all(struct mending *m)
{
    const struct light_operator *op = m->op;
    int failed = levels_open(&m->levels, op->hierarchy) < 0;
    failed |= mend_places_open(&m->places, op) < 0;
    if (ranks_any(op->shares.ranks, failed))
        return -1;
    if (m->places.at)
        mend_places_levels(op, &m->levels);
    const size_t values = (size_t)m->places.count * m->bands + 1;
    m->linked = malloc(values * sizeof *m->linked);
    m->received = malloc(values * sizeof *m->received);
    m->kin = malloc(((size_t)m->places.count + 1) * sizeof *m->kin);
    m->replicate =
        malloc(((size_t)REPLICATES * m->places.built * m->bands + 1) * sizeof *m->replicate);
    m->note = malloc(((size_t)widest(&m->levels) * m->bands + 1) * sizeof *m->note);
    failed = !m->linked || !m->received || !m->replicate || !m->kin || !m->note;
    return ranks_any(op->shares.ranks, failed) ? -1 : 0;
}

static void close_all(struct mending *m)
{
    mend_places_close(&m->places);
    levels_close(&m->levels);
    free(m->note);
    free(m->kin);
    free(m->linked);
    free(m->received);
    free(m->replicate);
}

int mend_irradiance(const struct light_operator *op, const struct tally *tally, double *irradiance)
{
    const struct hierarchy *h = op->hierarchy;
    const int threads = op->problem->options.threads;
    struct mending m = {.op = op, .tally = tally, .bands = tally->bands, .irradiance = irradiance};
    const int failed = open_all(&m) < 0;
    if (!failed) {
        thread_pool_run(threads, h->count, RUN, fill_some, &m);
        children_first(h, threads, add_children, &m);
        add_told(&m);
        for (uint32_t k = 0; k < m.bands && mend_is_here(&m.places, 0); k++)
            mend_root(&m, k);
        const uint32_t count = levels_of_all(&m);
        for (uint32_t level = 0; level < count; level++)
            mend_level(&m, level);
    }
    close_all(&m);
    return failed ? -1 : 0;
}
