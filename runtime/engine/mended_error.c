/* mended_error.c - see mended_error.h.
 *
 * Where light is smooth links know how it is shared among neighbours, and a few particles how much
 * there is: polygons are right long before each has been met often. So what counts is not the noise
 * of what is counted on them, but what mending makes of it, and mending says how much that is, and
 * how sure (mend_risk.c). Never is it thought to be more than the noise of the particles without
 * any link. Of large polygons, which somebody looks at for themselves, it is that: how far these
 * are off is not made up for by many small ones.
 *
 * What is asked for is that the upper end is small enough: of what is known well, as noise where
 * links say nothing, it is a few hundredths above what is likely, of what is known badly far above.
 * Noise of large polygons is known to the replicates' 15 degrees of freedom, of which all may share
 * the same; sums of moduli are off by chance, too, and so is all light, which they are shares of.
 *
 * As for places (ray_split.c), links of an error l and particles of a noise n together have
 * 1 / e^2 = 1 / l^2 + 1 / n^2; r times the particles have 1 / l^2 + r / n^2.
 *
 * Where few particles bring the light of many polygons, as through a hole in a lamp's box, these
 * are off together. The sum of errors is small in the mean then and large by chance, so all
 * reflected light has to be known for itself. [Derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "engine/mend.h"
#include "engine/mended_error.h"
#include "engine/polygon_rows.h"
#include "engine/reflected_light.h"

/* Faces of large polygons: [face]; NULL when out of memory. */
static unsigned char *find_large(const struct solve *s)
{
    const struct hierarchy *h = &s->hierarchy;
    const double least = large_area(&s->problem, h);
    double *area = polygon_areas(&s->problem, h);
    unsigned char *large = area ? malloc((size_t)h->face_count + 1) : NULL;
    for (uint32_t f = 0; large && f < h->face_count; f++)
        large[f] = area[h->faces[f].input] > least;
    free(area);
    return large;
}

static struct mended_error add_large(const struct solve *s, const struct tally *tally,
                                     const struct face_noise *noise,
                                     const struct mended_risk *small)
{
    double variance;
    const double light = reflected_light(&s->problem, tally, &variance),
                 more = small->most - small->value,
                 value = fmin(noise->all, noise->large + small->value),
                 square = noise->large * noise->large / (2 * (REPLICATES - 1))
                          + noise->spread * noise->spread
                          + (light > 0 ? variance / (light * light) : 0);
    return (struct mended_error){value,
                                 value + sqrt(more * more + REPLICATES_T * REPLICATES_T * square)};
}

int mended_error_find(const struct solve *s, const struct tally *tally,
                      const struct face_noise *noise, struct mended_error *error)
{
    struct mended_faces faces = {NULL, NULL};
    unsigned char *large = find_large(s);
    struct mended_risk small = {.apart = large};
    const int failed = ranks_any(s->problem.options.ranks, !large)
                       || mend_faces(&s->operator, tally, s->state.irradiance, &faces, &small) < 0;
    if (!failed)
        *error = add_large(s, tally, noise, &small);
    mended_faces_close(&faces);
    free(large);
    return failed ? -1 : 0;
}

double mended_error_wanted(double error, double noise, double goal)
{
    if (!(error > goal))
        return 0;
    return noise * noise / (goal * goal) - noise * noise / (error * error) + 1;
}

/* What is left may be small enough long before what was foretold of it: then as soon as that is
 * looked at, and each time a quarter more are cast, as asking takes as long as some of them; chosen
 */
double mended_error_growth(const struct mending_goal *goal, double rays, double most)
{
    static const double CLOSER = 1.25;
    return goal->left > 0 ? fmin(most, fmax(CLOSER, 1.02 * (double)goal->plain / rays)) : most;
}

/* How many times the tally tells all reflected light as surely as is wanted. Of light that nobody
 * has seen next to nothing is known. */
static double power_times(const struct solve *s, const struct tally *tally,
                          const struct mending_goal *goal)
{
    double variance;
    const double light = reflected_light(&s->problem, tally, &variance), most = goal->power * light;
    if (!(light > 0))
        return variance > 0 ? 1 / (goal->noise * goal->noise) : 0;
    return most > 0 ? variance / (most * most) : 0;
}

int mended_error_times(const struct solve *s, const struct tally *tally,
                       const struct mending_goal *goal, double *times, double *alone)
{
    const double for_power = power_times(s, tally, goal);
    struct face_noise noise;
    struct mended_error left;
    if (face_noise_find(&s->problem, &s->hierarchy, s->state.irradiance, tally, &noise) < 0)
        return -1;
    *times = *alone = noise.all * noise.all / (goal->noise * goal->noise);
    if (*times > 1 && goal->left > 0 && tally->rays >= goal->plain) {
        if (mended_error_find(s, tally, &noise, &left) < 0)
            return -1;
        *times = fmin(*times, mended_error_wanted(left.most, noise.all, goal->left));
    }
    *times = fmax(*times, for_power);
    *alone = fmax(*alone, for_power);
    return 0;
}
