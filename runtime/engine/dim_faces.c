/* dim_faces.c - see dim_faces.h.
 *
 * A polygon of the share a of the area on which m times the mean irradiance falls is met by a m N
 * of N particles, and known to 1 / sqrt(a m N) of its own light. Where m is small that is little,
 * and links say little too: to the oracle such light is nobody's loss. Whoever looks at that
 * polygon alone sees it. So it is asked from where it is (dim_paths.c): paths start on it, see
 * bright surfaces at once, and their noise is a share of what it receives, however small that is.
 *
 * How sure is what mending says? Of a polygon that particles hardly met, what is left is what links
 * said, and the classes of mend.c tell their errors where most surfaces are bright. So it is
 * thought to be off by the standard error s of the particles, as much as these would let pass; and
 * by what it differs from them where that is more: links as wrong as no others are believed too
 * much. Taken is the mean of both, each by the inverse of its variance.
 *
 * Smaller polygons are nobody's loss in the light of all, but somebody's room in a landscape. They
 * are asked in the same way where few rays have been cast; and those that stay unknown are counted,
 * for no other figure shows them. Of tiles of a bright wall particles know none, and yet links and
 * particles together know them all: mending tells how far off it leaves clusters and faces by the
 * number that met them (mend_clusters.c), and what is right to DIM_GOAL by that is known.
 *
 * What reflects none of the colours that lamps have is dark, for sure, and is not asked. Of light
 * in bands in which a polygon reflects nothing paths say nothing that counts: there it keeps what
 * particles know, or the paths' noise, by much light that ends there, would be taken from all
 * others.
 *
 * A polygon whose paths all meet nothing is one that touches what it is turned to, as a cupboard's
 * back does a wall: it is dark, and no more is asked.
 *
 * Those that are not sure then are behind a second door: what paths end in is as wrong there as the
 * polygon. For them particles are split (dim_split.c); and where these say otherwise than paths by
 * more than the noise of both, paths are thought to be off by that much.
 *
 * Split particles come from the emitters, through all that is bright, where they are as good as
 * any. Of a light guide that a dim room surrounds they are seven times as many as those that
 * mended, and what they counted on all faces and leaves mends these again.
 *
 * Below the polygon all elements keep their shares, and the power of the whole scene, which
 * particles know best, stays: what is added here all the others give in proportion.
 *
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "engine/dim_faces.h"
#include "engine/dim_list.h"
#include "engine/dim_plan.h"
#include "engine/dim_split.h"
#include "engine/face_error.h"
#include "engine/mend.h"
#include "engine/mend_places.h"
#include "engine/own_quarters.h"
#include "engine/reflected_light.h"
#include "hierarchy/children_first.h"
#include "kernel/constants.h"
#include "util/array.h"

enum {
    RAYS_OF_PATH = 4, /* about, before any is traced */
    LOOK = DIM_BLIND  /* paths of a first look at most: chosen, the variance is known to a tenth */
};
#define FIRST 0.125 /* of the rays: those that tell how noisy paths are */

/* What the element receives in a band (W). */
static double power_of(const struct dim_faces *d, uint32_t element, uint32_t band)
{
    return d->tracer->hierarchy->elements[element].area
           * d->solve->mended.irradiance[(size_t)element * d->tracer->bands + band];
}

/* The mean irradiance of a polygon, as it is mended by now. */
static void find_mean(const struct dim_faces *d, const struct dim_polygon *p, double mean[3])
{
    for (uint32_t k = 0; k < d->tracer->bands; k++) {
        mean[k] = 0;
        for (uint32_t i = p->from; i < p->to; i++)
            mean[k] += power_of(d, d->tracer->hierarchy->face_element[d->face[i]], k) / p->area;
    }
}

/* What mending says of a polygon, and how sure that is: by how replicates differ, and as if one
 * more particle might have met it; or by how far it is from what these counted. */
static void weigh(const struct dim_faces *d, const struct tally *tally,
                  const double sum[REPLICATES], struct dim_polygon *p)
{
    const struct tracer *t = d->tracer;
    double one = tally->by_paths ? 0 : tally_power_of_one(tally) / p->area, noise,
           counted = dim_light_of(sum, &noise);
    find_mean(d, p, p->mended);
    for (uint32_t i = p->from; i < p->to; i++)
        for (uint32_t k = 0; k < t->bands; k++) {
            const double rho = t->reflectance[(size_t)d->face[i] * t->bands + k];
            p->reflects[k] |= rho > 0;
            p->light += rho * (power_of(d, t->hierarchy->face_element[d->face[i]], k) / p->area);
        }
    p->variance = fmax(noise + one * one, (p->light - counted) * (p->light - counted));
}

/* Of each polygon what all ranks have counted: [REPLICATES] each. NULL when out of memory. */
static double *count_polygons(const struct dim_faces *d, const struct tally *tally)
{
    double *sum = malloc(((size_t)d->count * REPLICATES + 1) * sizeof *sum);
    if (ranks_any(d->tracer->ranks, !sum)) {
        free(sum);
        return NULL;
    }
    for (size_t j = 0; j < d->count; j++)
        dim_count_replicates(d, tally, &d->polygon[j], &sum[j * REPLICATES]);
    if (tally->quarters)
        ranks_add(d->tracer->ranks, RANKS_PARTICLES, sum, (size_t)d->count * REPLICATES);
    return sum;
}

/* The standard error, as a share, with which none of so many is off by DIM_OFF, but with a chance
 * of DIM_DOUBT; DIM_GOAL of one. */
static double sure_of(uint32_t count)
{
    double low = 0, high = 40; /* standard errors */
    for (int i = 0; i < 60; i++) {
        const double middle = (low + high) / 2;
        if (count * erfc(middle / sqrt(2)) > DIM_DOUBT)
            low = middle;
        else
            high = middle;
    }
    return fmin(DIM_OFF / high, DIM_GOAL);
}

/* Each rank knows what mending leaves of the error of its own faces, and tells it. */
static void tell_doubt(const struct light_operator *op, uint32_t bands, double *doubt)
{
    const uint32_t built = op->hierarchy->built;
    if (!op->shares.common)
        return;
    for (uint32_t e = 0; e < built; e++)
        for (uint32_t k = 0; k < bands; k++)
            if (!op->hierarchy->elements[e].vertices || !mend_is_added(op, e))
                doubt[(size_t)e * bands + k] = 0;
    ranks_add(op->shares.ranks, RANKS_PARTICLES, doubt, (size_t)built * bands);
}

/* The standard error of the polygon's light by what mending leaves of that of its faces, as a share
 * of it: of one cluster as a rule, they are off together. */
static double doubt_of(const struct dim_faces *d, const double *doubt, const struct dim_polygon *p)
{
    const struct tracer *t = d->tracer;
    double off = 0;
    for (uint32_t i = p->from; i < p->to; i++)
        for (uint32_t k = 0; k < t->bands; k++) {
            const size_t at = (size_t)t->hierarchy->face_element[d->face[i]] * t->bands + k;
            off += t->reflectance[(size_t)d->face[i] * t->bands + k]
                   * d->solve->mended.irradiance[at] * tracer_surface(t, d->face[i])->area / p->area
                   * sqrt(doubt[at]);
        }
    return p->light > 0 ? off / p->light : 1;
}

/* Those that are not to be known, as no paths are for them, are counted. Returns 0, or -1 when out
 * of memory. */
static int count_unasked(const struct dim_faces *d, const struct tally *tally,
                         struct dim_count *count)
{
    const struct solve *s = d->solve;
    struct mended_faces faces = {NULL, NULL};
    if (d->count == 0)
        return 0;
    const int failed = mend_faces(&s->operator, tally, s->state.irradiance, &faces, NULL) < 0;
    if (!failed)
        tell_doubt(&s->operator, s->problem.bands, faces.doubt);
    for (uint32_t j = 0; j < d->count && !failed; j++) {
        struct dim_polygon *p = &d->polygon[j];
        p->told = doubt_of(d, faces.doubt, p) <= DIM_GOAL;
        if (p->asked || p->told)
            continue;
        count->unsure++;
        count->area += p->area;
    }
    mended_faces_close(&faces);
    return failed ? -1 : 0;
}

static int is_dim(const struct dim_faces *d, const struct dim_polygon *p)
{
    return !dim_is_known(d, p->light, p->variance, d->sure);
}

static int is_asked(const struct dim_faces *d, const struct dim_polygon *p)
{
    (void)d;
    return p->asked;
}

/* Others are forgotten. */
static void keep(struct dim_faces *d,
                 int (*stays)(const struct dim_faces *, const struct dim_polygon *))
{
    uint32_t kept = 0;
    for (uint32_t p = 0; p < d->parts; p++) { /* places rise with p */
        if (d->of[p] == NOT_DIM)
            continue;
        const struct dim_polygon at = d->polygon[d->of[p]];
        d->of[p] = stays(d, &at) ? kept : NOT_DIM;
        if (d->of[p] != NOT_DIM)
            d->polygon[kept++] = at;
    }
    d->count = kept;
}

/* What is known of each by now. Returns 0, or -1 when out of memory. */
static int weigh_all(struct dim_faces *d, const struct tally *tally)
{
    double *sum = count_polygons(d, tally);
    const int failed = !sum;
    for (size_t j = 0; j < d->count && sum; j++)
        weigh(d, tally, &sum[j * REPLICATES], &d->polygon[j]);
    free(sum);
    return failed ? -1 : 0;
}

/* The irradiance (all bands, W/m2) that brings DIM_BELIEVED particles to a place as large as large
 * ones. Where paths have mended, and no particles: any. */
static double believed(const struct dim_faces *d, const struct tally *tally)
{
    double met =
        d->large / d->tracer->hierarchy->elements[0].area * (double)tally->particles * REPLICATES;
    return tally->by_paths ? 0 : mended_irradiance(d->solve, 0) * DIM_BELIEVED / met;
}

/* ---- how many, and what they say */

/* A few paths of each; half of what is then planned; then all. */
static int trace_paths(struct dim_faces *d, const struct dim_budget *budget)
{
    uint64_t before = *d->rays;
    double first = fmin(budget->paths * FIRST / RAYS_OF_PATH / d->count, LOOK);
    for (uint32_t j = 0; j < d->count; j++)
        d->polygon[j].wanted = first > 1 ? (uint64_t)first : 1;
    for (int part = 2; part >= 0; part--) {
        const double spent = (double)(*d->rays - before);
        if (part < 2)
            dim_plan(d, fmax(budget->paths - spent, 0), budget->surer - spent);
        for (uint32_t j = 0; j < d->count && part == 1; j++)
            d->polygon[j].wanted -= (d->polygon[j].wanted - d->polygon[j].paths) / 2;
        if (dim_paths_trace(d) < 0)
            return -1;
        for (uint32_t j = 0; j < d->count && part == 2; j++)
            d->polygon[j].looked = d->polygon[j].paths;
    }
    return 0;
}

/* ---- those that are not sure by paths */

static int is_named(const struct dim_count *count, uint32_t polygon)
{
    for (uint32_t i = 0; i < count->unsure && i < RAD_UNSURE_NAMED; i++)
        if (count->named[i] == polygon)
            return 1;
    return 0;
}

/* A group's name is a polygon of it that no other has: those of both sides of tiles have the same.
 */
static uint32_t name_of(const struct dim_faces *d, const struct dim_polygon *p,
                        const struct dim_count *count)
{
    const struct face *faces = d->tracer->hierarchy->faces;
    uint32_t i = p->from;
    while (i + 1 < p->to && is_named(count, faces[d->face[i]].input))
        i++;
    return faces[d->face[i]].input;
}

static void count_unsure(const struct dim_faces *d, struct dim_count *count)
{
    for (uint32_t j = 0; j < d->count; j++) {
        const struct dim_polygon *p = &d->polygon[j];
        if (p->told || dim_is_sure(d, p))
            continue;
        count->area += p->area;
        if (count->unsure < RAD_UNSURE_NAMED)
            count->named[count->unsure] = name_of(d, p, count);
        count->unsure++;
    }
}

/* How little all light that is reflected is known: its variance over its square, 1 at the most. */
static double shared_doubt(double light, double variance)
{
    return variance < light * light ? variance / (light * light) : 1;
}

static int all_sure(const struct dim_faces *d)
{
    for (uint32_t j = 0; j < d->count; j++)
        if (!dim_is_sure(d, &d->polygon[j]))
            return 0;
    return 1;
}

/* Which dim polygon the face is of, or NULL. */
static const struct dim_polygon *polygon_of(const struct dim_faces *d, uint32_t face)
{
    uint32_t of = d->of[d->part[face]];
    return of != NOT_DIM && dim_list_reflects(d, face) ? &d->polygon[of] : NULL;
}

/* The power of two that is nearest. The last digits of a solution are other ones on several ranks:
 * they are not to decide about particles. */
static double near_power(double x)
{
    int exponent;
    double half = frexp(x, &exponent);
    return ldexp(1, 2 * half * half < 1 ? exponent - 1 : exponent);
}

/* What split particles are to carry: as much as there is light of the band over the mean irradiance
 * of all, and all bands no more than those that are not split; how little at the least is
 * tally_split's to know. Of dim polygons, what is known by now. */
static void set_windows(const struct dim_faces *d, float *window)
{
    const struct hierarchy *h = d->tracer->hierarchy;
    const uint32_t bands = d->tracer->bands;
    const double mean = mended_irradiance(d->solve, 0);
    for (uint32_t e = 0; e < h->count; e++) {
        const struct element *at = &h->elements[e];
        const struct dim_polygon *p = at->vertices ? polygon_of(d, at->face) : NULL;
        double here[3], all = 0;
        for (uint32_t k = 0; k < bands; k++) {
            here[k] = d->solve->mended.irradiance[(size_t)e * bands + k];
            if (p)
                here[k] = p->mended[k] > 0 ? here[k] * dim_mean(d, p, k) / p->mended[k]
                                           : dim_mean(d, p, k);
            all += here[k];
        }
        for (uint32_t k = 0; k < bands; k++)
            window[(size_t)e * bands + k] =
                (float)near_power(fmax(here[k] / fmax(all, mean), (double)FLT_MIN));
    }
}

/* Split particles serve all polygons and come from the emitters all the way: often a few paths more
 * make sure, for far less, what the budget of paths has left. Returns what is left of `rays`, or -1
 * when out of memory or stopped. */
static double trace_rest(struct dim_faces *d, double rays)
{
    for (double may = DIM_REST * rays; !all_sure(d);) {
        const double rest = dim_plan_rest(d);
        const uint64_t before = *d->rays;
        if (!(rest > 0) || rest > may)
            break;
        if (dim_paths_trace(d) < 0)
            return -1;
        const double spent = (double)(*d->rays - before);
        may -= spent;
        rays -= spent;
    }
    return fmax(rays, 0);
}

/* Noise of two counts together; 1: there was none of the light, 0: there is none. */
static double both_noises(double a, double b)
{
    return !(a > 0 && a < 1) ? b : !(b > 0 && b < 1) ? a : a * b / hypot(a, b);
}

/* Paths, and where these leave some unsure split particles; but these are not asked for fewer rays
 * than mending took: they would know less. */
static int trace_all(struct dim_faces *d, struct solve *s, const struct dim_budget *budget,
                     const struct tally *tally, double band_noise[3])
{
    const double mending = (double)tally->rays;
    uint64_t before = *d->rays;
    if (trace_paths(d, budget) < 0)
        return -1;
    double rays = budget->both - (double)(*d->rays - before);
    if (rays < mending || all_sure(d))
        return 0;
    rays = trace_rest(d, rays);
    if (rays < mending || all_sure(d))
        return rays < 0 ? -1 : 0;
    if (own_quarters_share(s) < 0) /* split particles ask every leaf what they are to carry */
        return -1;
    struct ranks *ranks = d->tracer->ranks;
    float *window = malloc((size_t)d->tracer->hierarchy->count * d->tracer->bands * sizeof *window);
    if (ranks_any(ranks, !window)) {
        free(window);
        return -1;
    }
    set_windows(d, window);
    struct tally split;
    const double *links = s->state.irradiance;
    double noise[3] = {0, 0, 0};
    int failed = dim_split_trace(d, window, rays, all_sure, &split) < 0
                 || band_noise_find(&s->problem, d->tracer->hierarchy, links, &split, noise) < 0;
    failed = ranks_any(ranks, failed)
             || mend_again(&s->operator, & split, tally, links, s->mended.irradiance) < 0;
    for (uint32_t k = 0; k < d->tracer->bands && !failed; k++)
        band_noise[k] = both_noises(band_noise[k], noise[k]);
    tally_close(&split);
    free(window);
    return failed ? -1 : 0;
}

/* ---- what becomes of the solution */

/* What it is to have; of light that it does not reflect, what it has. */
static double mean_of(const struct dim_faces *d, const struct dim_polygon *p, uint32_t band)
{
    return p->reflects[band] ? dim_mean(d, p, band) : p->given[band];
}

struct changing {
    const struct dim_faces *d;
    double others[3], *irradiance;
};

static void change_element(const void *changing, uint32_t e)
{
    const struct changing *x = changing;
    const struct dim_faces *d = x->d;
    const struct element *at = &d->tracer->hierarchy->elements[e];
    const struct dim_polygon *p = at->vertices ? polygon_of(d, at->face) : NULL;
    for (uint32_t k = 0; k < d->tracer->bands; k++) {
        double *H = &x->irradiance[(size_t)e * d->tracer->bands + k], sum = 0;
        if (at->vertices) {
            double mean = p ? mean_of(d, p, k) : 0;
            if (p && !(p->given[k] > 0))
                *H = mean; /* nothing is known of how it is spread */
            else
                *H *= p ? mean / p->given[k] : x->others[k];
            continue;
        }
        for (uint32_t c = 0; c < at->children; c++)
            sum += power_of(d, at->child + c, k);
        *H = sum / at->area;
    }
}

/* Change them, and all others by one factor; then clusters as their children. */
static void change(const struct dim_faces *d, double *irradiance)
{
    struct changing x = {.d = d, .irradiance = irradiance};
    for (uint32_t j = 0; j < d->count; j++)
        find_mean(d, &d->polygon[j], d->polygon[j].given);
    for (uint32_t k = 0; k < d->tracer->bands; k++) {
        double before = 0, after = 0, whole = power_of(d, 0, k);
        for (uint32_t j = 0; j < d->count; j++) {
            before += d->polygon[j].given[k] * d->polygon[j].area;
            after += mean_of(d, &d->polygon[j], k) * d->polygon[j].area;
        }
        x.others[k] = before < whole ? fmax(whole - after, 0) / (whole - before) : 1;
    }
    children_first(d->tracer->hierarchy, d->tracer->threads, change_element, &x);
}

int dim_faces_mend(struct solve *s, const struct tracer *t, const struct tally *tally,
                   enum dim_size size, const struct dim_budget *budget, const struct watch *watch,
                   uint64_t *rays, struct dim_count *count, double band_noise[3])
{
    /* so many that each is believed, at the least: dim_belief.c */
    const double most = size != DIM_SMALL_ONES
                            ? UINT32_MAX
                            : budget->paths / (DIM_ENOUGH * DIM_BLOCK * RAYS_OF_PATH);
    struct dim_faces d = {.solve = s, .tracer = t, .size = size, .watch = watch, .rays = rays};
    *count = (struct dim_count){0};
    double variance;
    const double light = reflected_light(&s->problem, tally, &variance);
    if (tally->particles == 0 || !(light > 0 || variance > 0))
        return 0;
    int failed = dim_list_open(&d, (uint32_t)most) < 0;
    if (!failed) {
        count->large = d.count;
        d.shared = size != DIM_SMALL_ONES ? shared_doubt(light, variance) : 0;
        d.sure = size != DIM_SMALL_ONES ? sure_of(d.count) : DIM_GOAL;
        failed = weigh_all(&d, tally) < 0;
        keep(&d, is_dim);
        failed = failed || (size == DIM_SMALL_ONES && count_unasked(&d, tally, count) < 0);
        keep(&d, is_asked);
        d.believed = believed(&d, tally);
        failed = failed || (d.count > 0 && quarter_light_open(&d.light, s) < 0);
        for (uint32_t i = 0; i < t->hierarchy->face_count && !failed; i++)
            for (uint32_t k = 0; k < t->bands; k++)
                d.unseen += t->reflectance[(size_t)i * t->bands + k]
                            * power_of(&d, t->hierarchy->face_element[i], k)
                            / t->hierarchy->elements[0].area;
        failed = failed || (d.count > 0 && trace_all(&d, s, budget, tally, band_noise) < 0);
    }
    if (!failed && d.count > 0)
        change(&d, s->mended.irradiance);
    if (!failed)
        count_unsure(&d, count);
    int changed = failed ? -1 : (int)d.count;
    dim_list_close(&d);
    quarter_light_close(&d.light);
    return changed;
}

void dim_count_add(struct dim_count *to, const struct dim_count *c)
{
    for (uint32_t i = 0; i < c->unsure && to->unsure + i < RAD_UNSURE_NAMED; i++)
        to->named[to->unsure + i] = c->named[i];
    to->large += c->large;
    to->unsure += c->unsure;
    to->area += c->area;
    const size_t named = to->unsure < RAD_UNSURE_NAMED ? to->unsure : RAD_UNSURE_NAMED;
    qsort(to->named, named, sizeof *to->named, compare_words);
}
