/* tracer.h - what light paths are traced through: faces, materials, rays and the table of emitters;
 * and the random numbers they are traced by.
 *
 * Invariant: a tracer is read only, so any number of threads may trace through it; random numbers
 * come from the path's index alone, so what is traced does not depend on them.
 * SPDX-License-Identifier: MIT */
#ifndef TRACER_H
#define TRACER_H

#include <stdint.h>
#include "hierarchy/hierarchy.h"
#include "hierarchy/quarters.h"
#include "kernel/hash.h"
#include "particles/light_tree.h"
#include "particles/sobol_sequence.h"
#include "util/ranks.h"
#include "visibility/rays.h"

/* Faces that emit, to be chosen by the power they send. */
struct lights {
    uint32_t *face; /* [count] */
    double *until;  /* [count]: running sums of A sum_k E_k (W) */
    uint32_t count;
    double power; /* W, all bands */
};

struct tracer {
    const struct hierarchy *hierarchy;    /* borrowed, as all that follows */
    const struct quarters *quarters;      /* what of it others have; NULL: nothing */
    const struct rays *rays;              /* over its faces */
    const double *exitance, *reflectance; /* [face * bands + band]: E (W/m2), rho */
    uint32_t bands;                       /* 1 or 3 */
    int threads;
    struct ranks *ranks; /* who trace together, each its part; NULL: one process */
    /* where there are quarters that others have: [face], the rank that counts there; [ranks + 1],
     * where each one's begin in hierarchy->order */
    const uint16_t *owner;
    const size_t *stretch;
    struct lights lights;         /* owned, as the next */
    struct light_tree light_tree; /* the same emitters, for paths */
    struct sobol_sequence sobol;
};

/* lights, light_tree and sobol are made of the rest. Returns 0, or -1 when out of memory. */
int tracer_open(struct tracer *t);
void tracer_close(struct tracer *t);

/* The emitter that the share u in [0, 1) of all power falls to; there must be one. */
uint32_t lights_choose(const struct lights *l, double u);

/* One path's random numbers: coordinates of a point of a sequence, as far as these go; then what
 * chance gives. */
struct dice {
    uint64_t state;
    const struct sobol_sequence *sobol; /* NULL: chance alone */
    const uint32_t *shift;              /* [SOBOL_COORDINATES] */
    uint32_t index;                     /* of the point */
    int used;                           /* coordinates of it */
};

static inline struct dice dice_of(uint64_t stream, uint64_t path)
{
    return (struct dice){.state = hash64(hash64(stream * HASH_STEP + 1) + path * HASH_STEP)};
}

/* The same, with a point of a sequence. */
static inline struct dice dice_of_point(const struct tracer *t, uint64_t stream, uint64_t path,
                                        const uint32_t *shift, uint64_t index)
{
    struct dice d = dice_of(stream, path);
    d.sobol = &t->sobol;
    d.shift = shift;
    d.index = (uint32_t)index;
    return d;
}

/* In [0, 1). */
static inline double dice_throw(struct dice *d)
{
    if (d->sobol && d->used < SOBOL_COORDINATES) {
        const int c = d->used++;
        return sobol_sequence_at(d->sobol, d->index, c, d->shift[c]);
    }
    return (double)(hash64(d->state += HASH_STEP) >> 11) * 0x1p-53;
}

/* From the point of the face that p is just in front of, in the direction by the cosine that (u, v)
 * in [0, 1)^2 stand for: the face whose front is met, with p moved just in front of it; or what is
 * below 0, as rays_meet says. `at`: where it is met, in its plane; may be NULL. */
int64_t tracer_step(const struct tracer *t, uint32_t face, double p[3], double u, double v,
                    double at[3]);

/* rho of a face, the band where it is largest; 0 of one that no light comes to. */
double tracer_reflectance(const struct tracer *t, uint32_t face);

/* A point spread evenly over the face by (u, v) in [0, 1)^2, just in front of it. */
void tracer_point(const struct tracer *t, uint32_t face, double u, double v, double p[3]);

/* The point of the face that p is just in front of: directions that tracer_step takes start there,
 * and end in such points. */
void tracer_on_surface(const struct tracer *t, uint32_t face, const double p[3], double on[3]);

/* How probable it is that tracer_step goes from p to y, which has that normal and lies in its plane
 * (1/m2), if nothing is in the way. */
double tracer_density(const struct tracer *t, uint32_t face, const double p[3], const double y[3],
                      const double normal[3]);

static inline const struct element *tracer_surface(const struct tracer *t, uint32_t face)
{
    return hierarchy_surface(t->hierarchy, face);
}

#endif
