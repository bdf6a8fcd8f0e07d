/* polygon_counts.h - the light that polygons reflect, as particles counted it beside what was
 * solved, and how noisy the counts are.
 *
 * A value is a polygon's in one band. Its count R^ is the truth R with a noise of deviation s.
 * Values of about as many particles, 4^k to 4^(k + 1), are class k.
 * SPDX-License-Identifier: MIT */
#ifndef POLYGON_COUNTS_H
#define POLYGON_COUNTS_H

#include <math.h>

#include "engine/noisy_sum.h"
#include "engine/polygon_rows.h"
#include "kernel/lambert.h"

struct polygon_counts {
    struct polygon_rows rows; /* the polygons whose values are here */
    uint32_t bands;
    size_t values;        /* polygons * bands */
    double *solved;       /* [values]: R~, of the solution (W) */
    double *replicate;    /* [REPLICATES][values]: R^ of each (W) */
    double *mean;         /* [values]: R^ */
    double *deviation;    /* [values]: s (W) */
    double *count;        /* [values]: particles by the solution, as far as what came allows that */
    unsigned char *class; /* [values] */
    double *most;     /* [rows]: what of one particle is reflected at the most, in the mean (W) */
    double reflected; /* sum of R^, of all ranks (W) */
};

/* Of the mean irradiances of faces, irradiance[element * bands + band] (W/m2), and a tally that
 * nothing in them comes from. Returns NULL when out of memory. */
struct polygon_counts *polygon_counts_open(const struct problem *p, const struct hierarchy *h,
                                           const double *irradiance, const struct tally *tally);
void polygon_counts_close(struct polygon_counts *c);

/* The mean |x| of a normal x of mean 0. */
static inline double mean_modulus(double deviation)
{
    return sqrt(2 / LAMBERT_PI) * deviation;
}

/* The sum of |s z| over all values, z normal and independent, as a share of the reflected light. */
struct RadMeasure polygon_counts_noise(const struct polygon_counts *c);

/* The L1 error of polygons that the noise of the tally alone makes, as a share of the reflected
 * light; what polygons above large_area have of it; and its standard deviation, if polygons have no
 * noise in common. Returns 0, or -1 when out of memory. */
struct face_noise {
    double all, large, spread;
};
int face_noise_find(const struct problem *p, const struct hierarchy *h, const double *irradiance,
                    const struct tally *tally, struct face_noise *noise);

#endif
