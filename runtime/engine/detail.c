/* detail.c - see detail.h.
 *
 * A leaf of links is as large as links need it, which know light by its mean and slope there; a
 * shadow's edge across it is lost, though hundreds of particles land on either side. Quarters of
 * the leaf give particles places to be counted on. Which leaves these are is told by links and by
 * how many particles are to come, never by where these have landed: quarters chosen by that would
 * seem brighter than they are.
 *
 * Quarters start from their parent's light: mean B + g . (centre - parent's centre), and its slope.
 * Where a solid covers a leaf in part, quarters receive by what of them is bare, and reflect what
 * the leaf did. So links alone say what they said. Once the solution is mended, quarters go again
 * where particles had nothing to say of what is reflected that the parent's mean and slope do not.
 * [Derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/detail.h"
#include "engine/own_quarters.h"
#include "kernel/constants.h"
#include "util/thread_pool.h"

/* What a leaf receives, of all bands (W). */
static double received(const struct solve *s, uint32_t leaf)
{
    double sum = 0;
    for (uint32_t k = 0; k < s->problem.bands; k++)
        sum += s->state.irradiance[(size_t)leaf * s->problem.bands + k];
    return sum * s->hierarchy.elements[leaf].area;
}

/* How many quarters, of all sizes, that makes of a leaf of so many parts, about. */
static double quarters_of(double parts)
{
    double sum = 0;
    for (double n = 1; n < parts; n *= 4)
        sum += 4 * n;
    return sum;
}

/* Split until a leaf is worth no more than one part of so many. Returns 0, or -1 when out of
 * memory.
 */
static int split(struct hierarchy *h, uint32_t leaf, double parts)
{
    if (parts <= 1 || h->elements[leaf].depth == UINT8_MAX)
        return 0;
    if (hierarchy_split(h, leaf) < 0)
        return -1;
    uint32_t child = h->elements[leaf].child;
    for (uint32_t c = 0; c < 4; c++)
        if (split(h, child + c, parts * h->elements[child + c].area / h->elements[leaf].area) < 0)
            return -1;
    return 0;
}

/* The light of a new element, from its parent's. */
static void inherit(const struct solve *s, uint32_t i)
{
    const struct element *e = &s->hierarchy.elements[i],
                         *parent = &s->hierarchy.elements[e->parent];
    double off[3];
    sub3(off, e->centre, parent->centre);
    for (uint32_t k = 0; k < s->problem.bands; k++) {
        size_t at = (size_t)i * s->problem.bands + k,
               above = (size_t)e->parent * s->problem.bands + k;
        double bare = s->operator.uncovered[e->parent],
               share = bare > 0 ? s->operator.uncovered[i] / bare : 1;
        double rho = s->problem.reflectance[(size_t)e->face * s->problem.bands + k],
               tilt = dot3(&s->linear.gradient[3 * above], off);
        s->state.radiosity[at] = s->state.radiosity[above] + tilt;
        s->state.irradiance[at] = s->state.irradiance[above] * share + (rho > 0 ? tilt / rho : 0);
        for (size_t c = 0; c < 3; c++)
            s->linear.gradient[3 * at + c] = s->linear.gradient[3 * above + c];
    }
}

/* New elements, and what they are made from. */
struct inheriting {
    const struct solve *s;
    uint32_t first;
};

static void inherit_below(const struct solve *s, uint32_t i)
{
    const struct element *e = &s->hierarchy.elements[i];
    for (uint32_t j = e->child; j < e->child + e->children; j++) {
        inherit(s, j);
        inherit_below(s, j);
    }
}

static void inherit_some(const void *inheriting, size_t from, size_t to)
{
    const struct inheriting *x = inheriting;
    for (uint32_t i = (uint32_t)from; i < to; i++)
        if (x->s->hierarchy.elements[i].child >= x->first)
            inherit_below(x->s, i);
}

int detail_light(struct solve *s, uint32_t first)
{
    struct hierarchy *h = &s->hierarchy;
    if ((own_quarters(s) ? s->quarters.count : h->count) == first)
        return 0;
    double *gradient =
        realloc(s->linear.gradient, (size_t)h->count * s->problem.bands * 3 * sizeof *gradient);
    if (gradient)
        s->linear.gradient = gradient;
    if (ranks_any(s->problem.options.ranks,
                  !gradient || solve_make_room(s) < 0 || refinement_sort(&s->refinement) < 0))
        return -1;
    for (uint32_t i = first; i < h->count; i++) /* children follow their parents */
        s->operator.uncovered[i] = s->operator.uncovered[h->elements[i].parent];
    solve_measure_contact(s, first, 1);
    if (own_quarters(s)) {
        if (own_quarters_tell(s, s->operator.uncovered, 1) < 0)
            return -1;
        solve_average_contact(s, first);
    }
    const struct inheriting x = {s, first};
    thread_pool_run(s->problem.options.threads, first, 256, inherit_some, &x);
    return 0;
}

/* Split a leaf into so many parts; of several ranks that have their own, its owner makes them. */
static int split_leaf(struct solve *s, uint32_t leaf, double parts)
{
    if (!own_quarters(s))
        return split(&s->hierarchy, leaf, parts);
    return quarters_split(&s->quarters, &s->hierarchy, leaf, parts, own_quarters_mine(s, leaf));
}

/* Into how many parts an element is to be split, by what it receives and covers. */
static double parts_of(const struct solve *s, uint32_t i, double per_watt, double per_m2)
{
    const struct element *e = &s->hierarchy.elements[i];
    return e->vertices && !e->children && !e->black ? per_watt * received(s, i) + per_m2 * e->area
                                                    : 0;
}

/* Split leaves into as many parts as what each receives and covers asks for. */
static int split_leaves(struct solve *s, double per_watt, double per_m2)
{
    struct hierarchy *h = &s->hierarchy;
    uint32_t first = h->count;
    double more = 0;
    if (!s->linear.gradient)
        return 0;
    for (uint32_t i = 0; i < first; i++) /* of several ranks each makes room for its own */
        if (!own_quarters(s) || own_quarters_mine(s, i))
            more += quarters_of(parts_of(s, i, per_watt, per_m2));
    int failed = more > UINT32_MAX || hierarchy_reserve(h, (uint32_t)more) < 0;
    for (uint32_t i = 0; i < first && !failed; i++)
        failed = split_leaf(s, i, parts_of(s, i, per_watt, per_m2)) < 0;
    failed = failed
             || (own_quarters(s)
                 && quarters_place(&s->quarters, h, s->operator.shares.owner,
                                   (size_t)ranks_count(s->problem.options.ranks))
                        < 0);
    return ranks_any(s->problem.options.ranks, failed) ? -1 : detail_light(s, first);
}

/* Of several ranks each makes the quarters of its own faces: as many, about, as any other. Returns
 * 0 or -1, alike. */
static int deal_out(struct solve *s, double per_watt)
{
    const struct hierarchy *h = &s->hierarchy;
    struct ranks *ranks = s->problem.options.ranks;
    if (ranks_count(ranks) == 1)
        return 0;
    double *quarters = calloc(h->face_count, sizeof *quarters);
    if (ranks_any(ranks, !quarters)) {
        free(quarters);
        return -1;
    }
    for (uint32_t i = 0; i < h->count; i++)
        quarters[h->elements[i].face] += quarters_of(parts_of(s, i, per_watt, 0));
    for (uint32_t f = 0; f < h->face_count; f++) /* a face itself is looked at, too */
        quarters[f]++;
    const int result = own_quarters_begin(s, quarters);
    free(quarters);
    return result;
}

int detail_leaves(struct solve *s, double landings)
{
    const struct hierarchy *h = &s->hierarchy;
    double whole = 0;
    for (uint32_t i = 0; i < h->count; i++)
        whole += h->elements[i].vertices && !h->elements[i].children ? received(s, i) : 0;
    if (!(whole > 0) || !s->linear.gradient)
        return 0;
    const double per_watt = fmin(landings / MEND_DETAIL, MEND_LEAVES) / whole;
    return deal_out(s, per_watt) < 0 ? -1 : split_leaves(s, per_watt, 0);
}

int detail_places(struct solve *s)
{
    return split_leaves(s, 0, 1 / (PLACE_SHARE * s->hierarchy.elements[0].area));
}

/* Is the mended light of the quarters of an element its own linear function, so that they say
 * nothing? */
static int say_nothing(const struct solve *s, uint32_t parent)
{
    const struct element *elements = s->hierarchy.elements, *at = &elements[parent];
    const double *B = s->mended.radiosity, *gradient = s->mended_gradient,
                 *bare = s->operator.uncovered, *exitance = s->problem.exitance;
    for (uint32_t j = at->child; j < at->child + at->children; j++) {
        double off[3], radius = elements[j].radius;
        if (elements[j].children || fabs(bare[j] - bare[parent]) > DETAIL_SAYS)
            return 0; /* a solid stands on a part */
        sub3(off, elements[j].centre, at->centre);
        for (uint32_t k = 0; k < s->problem.bands; k++) {
            size_t here = (size_t)j * s->problem.bands + k,
                   above = (size_t)parent * s->problem.bands + k;
            double turned[3], emitted = exitance[(size_t)at->face * s->problem.bands + k],
                              most = DETAIL_SAYS * (B[above] - emitted);
            sub3(turned, &gradient[3 * here], &gradient[3 * above]);
            double by_parent = B[above] + dot3(&gradient[3 * above], off);
            if (fabs(B[here] - by_parent) + sqrt(dot3(turned, turned)) * radius > most)
                return 0;
        }
    }
    return 1;
}

/* Move what is kept of an array of `width` numbers per element to the front. */
static void close_up(double *values, size_t width, uint32_t first, uint32_t count,
                     const uint32_t *place)
{
    for (uint32_t i = first; values && i < count; i++)
        if (place[i])
            memmove(&values[place[i] * width], &values[i * width], width * sizeof *values);
}

int detail_merge(struct solve *s, uint32_t first)
{
    struct hierarchy *h = &s->hierarchy;
    uint32_t count = h->count;
    size_t bands = s->problem.bands;
    if ((!own_quarters(s) && count == first) || !s->mended_gradient)
        return 0;
    uint32_t *place = malloc((size_t)count * sizeof *place);
    if (place) {
        for (uint32_t i = count; i-- > first;) { /* children follow their parents */
            uint32_t parent = h->elements[i].parent;
            if (h->elements[parent].child == i && say_nothing(s, parent))
                h->elements[parent].children = 0;
        }
        hierarchy_close_up(h, first, place);
        close_up(s->state.radiosity, bands, first, count, place);
        close_up(s->state.irradiance, bands, first, count, place);
        close_up(s->mended.radiosity, bands, first, count, place);
        close_up(s->mended.irradiance, bands, first, count, place);
        close_up(s->linear.gradient, 3 * bands, first, count, place);
        close_up(s->mended_gradient, 3 * bands, first, count, place);
        close_up(s->operator.uncovered, 1, first, count, place);
        s->started = h->count;
    }
    int failed = !place || refinement_sort(&s->refinement) < 0;
    free(place);
    if (ranks_any(s->problem.options.ranks, failed))
        return -1;
    own_quarters_settle(s);
    return 0;
}

int detail_drop(struct solve *s, uint32_t count)
{
    if (s->hierarchy.count == count)
        return 0;
    hierarchy_drop(&s->hierarchy, count);
    s->started = count;
    return refinement_sort(&s->refinement);
}
