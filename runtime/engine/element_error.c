/* element_error.c - see element_error.h.
 *
 * Few particles land on one leaf, so of most leaves alone nothing can be said; of whole faces much.
 * So what is said is said of parts: a polygon, a face, an element, each less the finer parts of
 * which something else is said. A statement is that so much of the light which is solved for on a
 * part is error.
 *
 * From the polygon down, an element is a part of its own where its error stands clear of what the
 * statement above it, or none, would make of it: so a face that is off by a sixth everywhere is one
 * part, however its leaves scatter, and one quarter that is off is found though the face is right
 * in the mean. Then, from the finest up, each part is held against no error at all. If it does not
 * stand clear of that it falls to the part around it: where a quarter has made a part of its face
 * the rest of the face may well be right.
 *
 * Clear. Bernstein's inequality: a sum of independent terms of at most w each, its variance V, is
 * off by t or more with a probability below 2 exp(-t^2 / 2 (V + w t / 3)), few terms or many. Each
 * element is asked twice in each band, and all of these together may be wrong once in twenty
 * measurements. V is that of chance if the statement holds, times how far replicates of the polygon
 * differ more than by chance; a whole polygon's is what face_error.c says. A large polygon that is
 * surely wrong to the summary is so here, too.
 *
 * What a statement says of one leaf: of light that is too much, the share is that of the part;
 * light that is missing doubles what is solved for at the most, the rest is spread evenly.
 *
 * [Bernstein 1946, as in Boucheron, Lugosi and Massart 2013, theorem 2.10; Bonferroni; the rest:
 * derived here, tests/runtime/check_element_error.c]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/element_error.h"
#include "engine/leaf_count.h"
#include "engine/polygon_rows.h"
#include "kernel/constants.h"

/* The probability that anything is said to be off of a solution that is right: 5 %, as is usual. */
static const double ELEMENT_ERROR_CHANCE = 0.05;
/* Standard errors. What 95 % are within. */
static const double ELEMENT_ERROR_LIMIT = 1.96;

/* Light reflected by the solution, and that less what is counted (W), over so much area that no
 * solid covers (m2). */
struct part {
    double solved, off, area;
};

/* Of a part, by the number of the element that it is of, or behind all elements of the polygon. */
struct statement {
    struct part part;
    uint32_t above; /* the statement of what is around it */
    int told;       /* it stands clear of noise */
};

struct judging {
    const struct light_operator *op;
    const struct hierarchy *h;
    const struct face_error *faces;
    const struct tally *tally;
    const double *irradiance;
    uint32_t bands, band;
    double squares;        /* of how far out, in standard errors, is clear */
    double *extent, *rho;  /* [polygon]: area, both sides (m2); reflectance in this band */
    struct part *whole;    /* [element, then polygon] */
    struct statement *say; /* the same */
    uint32_t *head;        /* [element]: the statement that holds there */
};

static uint32_t polygon_of(const struct judging *j, uint32_t e)
{
    return j->h->elements[e].vertices ? j->h->faces[j->h->elements[e].face].input : 0;
}

/* The number of the statement on the polygon that an element is of. */
static uint32_t polygon_number(const struct judging *j, uint32_t e)
{
    return j->h->count + polygon_of(j, e);
}

static void add_part(struct part *sum, const struct part *part)
{
    sum->solved += part->solved;
    sum->off += part->off;
    sum->area += part->area;
}

/* ---- noise */

/* The variance (W2) by chance of what a polygon reflects of the light that it receives. */
static double chance(const struct judging *j, uint32_t polygon, double reflected)
{
    double rho = j->rho[polygon];
    return rho > 0 ? rho * rho * tally_chance(j->tally, fmax(reflected, 0) / rho, j->band) : 0;
}

/* Of the whole polygon: the variance that face_error.c found, and times how much that is chance. */
static double variance_found(const struct judging *j, uint32_t polygon, double *times)
{
    const struct part *p = &j->whole[j->h->count + polygon];
    double s = j->faces->deviation[(size_t)polygon * j->bands + j->band] * j->extent[polygon],
           by_chance = chance(j, polygon, p->solved - p->off);
    *times = by_chance > 0 ? s * s / by_chance : 1;
    return s * s;
}

/* The variance of what is counted on a part of it that reflects so much. */
static double variance(const struct judging *j, uint32_t polygon, double reflected)
{
    double times;
    variance_found(j, polygon, &times);
    return fmax(times, 1) * chance(j, polygon, reflected);
}

static int is_whole(const struct judging *j, uint32_t polygon, const struct part *part)
{
    return part->area >= (1 - 1e-9) * j->whole[j->h->count + polygon].area;
}

/* Do so many W stand clear of a variance? */
static int is_clear(const struct judging *j, uint32_t polygon, double off, double variance)
{
    double most = j->rho[polygon] * tally_power_of_one(j->tally);
    return off * off > j->squares * (variance + fabs(off) * most / 3);
}

/* Is the part of a polygon off by something else than `foretold` (W)? */
static int is_off(const struct judging *j, uint32_t polygon, const struct part *part,
                  double foretold)
{
    return is_clear(j, polygon, part->off - foretold,
                    variance(j, polygon, part->solved - foretold));
}

/* Is it off at all? */
static int is_wrong(const struct judging *j, uint32_t polygon, const struct part *part)
{
    double times, found = variance_found(j, polygon, &times);
    if (!is_whole(j, polygon, part))
        return is_off(j, polygon, part, 0);
    int large = j->extent[polygon] > FACE_ERROR_LARGE * j->h->elements[0].area;
    return (large && fabs(part->off) > FACE_ERROR_SURE * sqrt(found))
           || is_clear(j, polygon, part->off,
                       fmax(found, times * chance(j, polygon, part->solved)));
}

/* What its modulus is below (W). */
static double limit_of(const struct judging *j, uint32_t polygon, const struct part *part)
{
    double times, found = variance_found(j, polygon, &times);
    if (!is_whole(j, polygon, part))
        found = variance(j, polygon, part->solved - part->off);
    return fabs(part->off) + ELEMENT_ERROR_LIMIT * sqrt(found);
}

/* Of `off` (W) on a part, what falls on a piece of it. */
static double share_of(double off, const struct part *part, const struct part *piece)
{
    double by_light = fmax(off, -part->solved), evenly = off - by_light;
    return (part->solved > 0 ? by_light * (piece->solved / part->solved) : 0)
           + (part->area > 0 ? evenly * (piece->area / part->area) : 0);
}

/* ---- one band */

static void measure_leaves(struct judging *j)
{
    const struct hierarchy *h = j->h;
    for (uint32_t i = 0; i < h->count + j->faces->polygons; i++)
        j->whole[i] = (struct part){0, 0, 0};
    for (uint32_t f = 0; f < h->face_count; f++)
        j->rho[h->faces[f].input] = j->op->problem->reflectance[(size_t)f * j->bands + j->band];
    for (uint32_t e = h->count; e-- > 0;) { /* children follow their parents */
        const struct element *at = &h->elements[e];
        struct part *p = &j->whole[e];
        if (!at->vertices)
            continue;
        if (!at->children) { /* a polygon has what links give to covered leaves, too */
            double rho = j->rho[polygon_of(j, e)];
            p->area = at->area * j->op->uncovered[e];
            p->solved = rho * at->area * j->irradiance[(size_t)e * j->bands + j->band];
            p->off = p->solved - rho * leaf_count(j->tally, h, j->irradiance, e, j->band);
        }
        add_part(&j->whole[at->depth > 0 ? at->parent : polygon_number(j, e)], p);
    }
}

/* From the polygon down: parts that are off by something else than what is around them. */
static void part_elements(struct judging *j)
{
    const struct hierarchy *h = j->h;
    for (uint32_t i = 0; i < h->count + j->faces->polygons; i++)
        j->say[i] = (struct statement){.above = i};
    for (uint32_t i = 0; i < j->faces->polygons; i++)
        j->say[h->count + i].told = is_wrong(j, i, &j->whole[h->count + i]);
    for (uint32_t e = 0; e < h->count; e++) {
        const struct element *at = &h->elements[e];
        if (!at->vertices)
            continue;
        uint32_t above = at->depth > 0 ? j->head[at->parent] : polygon_number(j, e);
        const struct part *around = &j->whole[above];
        double foretold = j->say[above].told ? share_of(around->off, around, &j->whole[e]) : 0;
        j->say[e].told = is_off(j, polygon_of(j, e), &j->whole[e], foretold);
        j->say[e].above = above;
        j->head[e] = j->say[e].told ? e : above;
    }
}

/* From the finest up: each with what no finer one has said of; what is not wrong for itself falls
 * to what is around it. */
static void judge_parts(struct judging *j)
{
    const struct hierarchy *h = j->h;
    for (uint32_t e = 0; e < h->count; e++)
        if (h->elements[e].vertices && !h->elements[e].children)
            add_part(&j->say[j->head[e]].part, &j->whole[e]);
    for (uint32_t e = h->count; e-- > 0;) {
        struct statement *s = &j->say[e];
        if (!h->elements[e].vertices || !s->told)
            continue;
        s->told = is_wrong(j, polygon_of(j, e), &s->part);
        if (!s->told)
            add_part(&j->say[s->above].part, &s->part);
    }
    for (uint32_t i = 0; i < j->faces->polygons; i++)
        j->say[h->count + i].told = is_wrong(j, i, &j->say[h->count + i].part);
}

static void tell_leaves(const struct judging *j, struct element_error *x)
{
    for (uint32_t e = 0; e < j->h->count; e++) {
        const struct part *piece = &j->whole[e];
        if (!j->h->elements[e].vertices || j->h->elements[e].children || !(piece->area > 0))
            continue;
        uint32_t at = j->head[e];
        while (at < j->h->count && !j->say[at].told)
            at = j->say[at].above;
        const struct part *part = &j->say[at].part;
        size_t i = (size_t)e * j->bands + j->band;
        if (j->say[at].told)
            x->error[i] = share_of(part->off, part, piece) / piece->area;
        x->limit[i] = -share_of(-limit_of(j, polygon_of(j, e), part), part, piece) / piece->area;
    }
}

/* ---- all of them */

static int judging_open(struct judging *j)
{
    size_t n = (size_t)j->h->count + j->faces->polygons;
    j->extent = polygon_areas(j->op->problem, j->h);
    j->rho = calloc((size_t)j->faces->polygons + 1, sizeof *j->rho);
    j->whole = malloc(n * sizeof *j->whole);
    j->say = malloc(n * sizeof *j->say);
    j->head = malloc((size_t)j->h->count * sizeof *j->head);
    return j->extent && j->rho && j->whole && j->say && j->head ? 0 : -1;
}

static void judging_close(struct judging *j)
{
    free(j->extent);
    free(j->rho);
    free(j->whole);
    free(j->say);
    free(j->head);
}

static void judge(struct judging *j, struct element_error *x)
{
    const struct hierarchy *h = j->h;
    double asked = j->faces->polygons;
    for (uint32_t e = 0; e < h->count; e++)
        asked += h->elements[e].vertices > 0;
    j->squares = 2 * log(2 * (2 * asked * j->bands) / ELEMENT_ERROR_CHANCE);
    for (j->band = 0; j->band < j->bands; j->band++) {
        measure_leaves(j);
        part_elements(j);
        judge_parts(j);
        tell_leaves(j, x);
    }
}

int element_error_open(struct element_error *x, const struct light_operator *op,
                       const struct face_error *faces, const struct tally *tally,
                       const double *irradiance)
{
    const struct hierarchy *h = op->hierarchy;
    const size_t values = (size_t)h->count * faces->bands;
    struct judging j = {.op = op,
                        .h = h,
                        .faces = faces,
                        .tally = tally,
                        .irradiance = irradiance,
                        .bands = faces->bands};
    *x = (struct element_error){calloc(values, sizeof *x->error), calloc(values, sizeof *x->limit)};
    int failed = judging_open(&j) < 0 || !x->error || !x->limit;
    if (failed)
        element_error_close(x);
    else
        judge(&j, x);
    judging_close(&j);
    return failed ? -1 : 0;
}

void element_error_close(struct element_error *x)
{
    free(x->error);
    free(x->limit);
    *x = (struct element_error){0};
}
