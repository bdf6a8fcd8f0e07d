/* error_places.h - where to measure the error of radiosities: densities over all surfaces that
 * reflect, and points drawn from them.
 *
 * Invariant: each density is over area_line's line, so that it integrates to 1 over their area;
 * the even one is positive everywhere.
 * SPDX-License-Identifier: MIT */
#ifndef ERROR_PLACES_H
#define ERROR_PLACES_H

#include "engine/element_light.h"
#include "particles/area_line.h"
#include "particles/spread.h"

enum error_place {
    PLACES_EVEN,
    PLACES_LIT,    /* where particles land */
    PLACES_DETAIL, /* where a leaf does not tell what its neighbours are */
    PLACES_WRONG,  /* where error has been found */
    PLACES
};

struct error_places {
    const struct tracer *tracer;
    const struct element_light *light;
    struct area_line line;
    struct spread even, lit, wrong;
    struct {
        uint32_t *leaf;  /* [count] */
        double *until;   /* [count]: running sums, to 1 */
        double *density; /* [elements]: of leaves */
        uint32_t count;
    } detail;
};

/* A point of a surface. */
struct place {
    double p[3]; /* m, just in front of the face */
    double u;    /* on the line */
    uint32_t face, leaf;
};

/* All but PLACES_WRONG, which is even until it is made of what has been measured. landings: how
 * many particles make PLACES_LIT; the rays are added to *rays. The tracer and the light are
 * borrowed. Returns 0, or -1 when out of memory; to be closed in any case. */
int error_places_open(struct error_places *x, const struct tracer *t,
                      const struct element_light *light, uint32_t landings, uint64_t stream,
                      uint64_t *rays);
void error_places_close(struct error_places *x);

/* The point of a density that v in [0, 1) stands for, or one nearby. */
struct place error_places_draw(const struct error_places *x, enum error_place density, double v,
                               struct dice *dice);

double error_places_density(const struct error_places *x, enum error_place density,
                            const struct place *at);

#endif
