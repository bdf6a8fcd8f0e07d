/* face_error.h - the measured error of the light that polygons reflect: a solution held against
 * counted particles.
 * SPDX-License-Identifier: MIT */
#ifndef FACE_ERROR_H
#define FACE_ERROR_H

#include "engine/polygon_counts.h"
#include "radiosity.h"

struct face_error {
    uint32_t polygons, bands;
    double *error;     /* [polygon * bands + band]: mean B of the solution less B counted (W/m2) */
    double *deviation; /* the same: its standard error (W/m2) */
    struct RadMeasure power, l1; /* shares of the reflected light */
    struct RadMeasure noise;     /* the L1 error that chance makes of what is counted itself */
    double reflected;            /* light reflected, as counted, all bands (W) */
    /* where none is counted and some might be: no more is (W, 95 %); nothing is known of errors
     * then, which have no end. 0: some is counted, or none can be */
    double unseen;
    /* by band: its share of the light that the solution reflects, and what chance makes of what is
     * counted in it, as noise.value, but a share of the band's own light: 1 where none is counted,
     * 0 where there is none */
    double band_light[3], band_noise[3];
    /* of polygons above large_area that light meets: the one that is most
     * surely wrong, and its error as a share of what it reflects, as seen, and the least that it
     * surely is (FACE_ERROR_SURE); polygons: there is none */
    uint32_t worst;
    double worst_share, worst_sure;
};

/* Hold the mean irradiances of faces, irradiance[element * bands + band] (W/m2), against a tally
 * that nothing in them comes from. Returns 0, or -1 when out of memory. */
int face_error_open(struct face_error *f, const struct problem *p, const struct hierarchy *h,
                    const double *irradiance, const struct tally *tally);
void face_error_close(struct face_error *f);

/* band_noise of that alone; as it was of bands that are not there, or where no light is. */
int band_noise_find(const struct problem *p, const struct hierarchy *h, const double *irradiance,
                    const struct tally *tally, double noise[3]);

/* Faces together are off by no less than all their light is, which other counts may tell better:
 * raise l1 to what of power is sure. face_error_open does; again once power is known better. */
void face_error_agree(struct face_error *f);

#endif
