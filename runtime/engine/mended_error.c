/* mended_error.c - see mended_error.h.
 *
 * Where light is smooth links know how it is shared among neighbours, and a few particles how much
 * there is: polygons are right long before each has been met often. So what counts is not the noise
 * of what is counted on them, but what mending makes of it, and mending says how much that is
 * (mend_clusters.c), as a variance for each face. The mean |e| of faces alike is at most its root,
 * times that of a normal number; where few of them have most of the error it is less by a quarter
 * or a third. Never is it thought to be more than the noise of the particles without any link. Of
 * large polygons, which somebody looks at for themselves, it is that: how far these are off is not
 * made up for by many small ones.
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
#include "kernel/lambert.h"

/* Over this rank's faces, or all where it has the counts of all: what they reflect, and of small
 * polygons the mean |e| (W). */
static void sum_errors(const struct solve *s, const struct tally *tally, const double *area,
                       const struct mended_faces *faces, double sums[2])
{
    const struct hierarchy *h = &s->hierarchy;
    const uint32_t bands = s->problem.bands;
    const double least = large_area(&s->problem, h);
    for (uint32_t f = 0; f < h->face_count; f++) {
        const uint32_t e = h->face_element[f];
        const int large = area[h->faces[f].input] > least;
        for (uint32_t k = 0; k < bands && tally_holds(tally, f); k++) {
            const double reflected = s->problem.reflectance[(size_t)f * bands + k]
                                     * h->elements[e].area
                                     * faces->irradiance[(size_t)e * bands + k];
            sums[0] += reflected;
            sums[1] +=
                large ? 0 : reflected * sqrt(2 / LAMBERT_PI * faces->doubt[(size_t)e * bands + k]);
        }
    }
}

int mended_error_find(const struct solve *s, const struct tally *tally,
                      const struct face_noise *noise, double *error)
{
    struct ranks *ranks = s->problem.options.ranks;
    struct mended_faces faces = {NULL, NULL};
    double *area = polygon_areas(&s->problem, &s->hierarchy), sums[2] = {0, 0};
    const int failed =
        ranks_any(ranks, !area) || mend_faces(&s->operator, tally, s->state.irradiance, &faces) < 0;
    if (!failed) {
        sum_errors(s, tally, area, &faces, sums);
        if (tally->quarters)
            ranks_add(ranks, RANKS_PARTICLES, sums, 2);
        *error = fmin(noise->all, noise->large + (sums[0] > 0 ? sums[1] / sums[0] : 0));
    }
    mended_faces_close(&faces);
    free(area);
    return failed ? -1 : 0;
}

double mended_error_wanted(double error, double noise, double goal)
{
    if (!(error > goal))
        return 0;
    return noise * noise / (goal * goal) - noise * noise / (error * error) + 1;
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
    double left;
    if (face_noise_find(&s->problem, &s->hierarchy, s->state.irradiance, tally, &noise) < 0)
        return -1;
    *times = *alone = noise.all * noise.all / (goal->noise * goal->noise);
    if (*times > 1 && goal->left > 0 && tally->rays >= goal->plain) {
        if (mended_error_find(s, tally, &noise, &left) < 0)
            return -1;
        *times = fmin(*times, mended_error_wanted(left, noise.all, goal->left));
    }
    *times = fmax(*times, for_power);
    *alone = fmax(*alone, for_power);
    return 0;
}
