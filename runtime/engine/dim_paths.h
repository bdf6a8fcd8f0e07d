/* dim_paths.h - polygons asked from themselves: paths that start on them and end in a solution.
 *
 * Invariant: a block of paths is summed up by one thread, and blocks in their order, so threads do
 * not show.
 * SPDX-License-Identifier: MIT */
#ifndef DIM_PATHS_H
#define DIM_PATHS_H

#include "engine/quarter_light.h"
#include "particles/tracer.h"
#include "particles/watch.h"

enum { DIM_BLOCK = 64 }; /* paths that are traced at once: no polygon has fewer */

struct dim_polygon {
    uint32_t from, to; /* its faces that reflect, in dim_faces.face */
    double area;       /* of them (m2) */
    double light;      /* what it reflects once mended, mean over it, all bands (W/m2) */
    double variance;   /* s^2 of that */
    double mended[3];  /* mean irradiance once mended (W/m2) */
    double given[3];   /* the same in the solution as it is, by split particles as well */
    int reflects[3];   /* bands: does any of its faces? */
    int asked;         /* 1: may be asked by paths; 0: there are too many */
    int told;          /* 1: known by what mending leaves of its error */
    int planned;       /* 1: is to reach DIM_GOAL */
    uint64_t looked;   /* paths of a first look */
    uint64_t paths, wanted, rays;
    uint64_t sighted;   /* paths that met a front */
    double sum[3];      /* over paths: of what they find, H (W/m2); */
    double all, square; /* of rho H, all bands, and of its square */
    /* by particles that are split (dim_split.h): light, its variance, 0 before there are any, and
     * mean irradiance */
    double split_light, split_variance, split[3];
};

enum { DIM_BLIND = 256 }; /* paths: one that sees so often nothing at all is dark, for sure */

/* Does it see nothing, as what is turned to a wall it touches, or to the void? */
static inline int dim_is_blind(const struct dim_polygon *p)
{
    return p->paths >= DIM_BLIND && p->sighted == 0 && !(p->all > 0);
}

/* Which polygons: large ones (polygon_rows.h); others together, in groups that are as large
 * (dim_parts.h); or others one by one. */
enum dim_size { DIM_LARGE_ONES, DIM_GROUPS, DIM_SMALL_ONES };

#define NOT_DIM UINT32_MAX
struct dim_faces {
    enum dim_size size;
    const struct solve *solve;
    const struct tracer *tracer;
    struct quarter_light light; /* B~ */
    uint32_t *part;             /* [faces]: the polygon it is of, or what it is gathered in */
    uint32_t parts, *of;        /* [parts]: place in `polygon`; or NOT_DIM */
    struct dim_polygon *polygon;
    uint32_t count;
    int lit[3];      /* bands: does any face emit in it? In others all is dark */
    double large;    /* as small as large ones are (m2) */
    uint32_t *face;  /* [faces]: by polygon */
    double *until;   /* [faces]: running sums of their areas in the polygon (m2) */
    double believed; /* where less falls B~ is not asked: irradiance, all bands (W/m2) */
    double unseen;   /* light reflected, mean over the scene, all bands (W/m2) */
    double shared;   /* variance of all light that is reflected, as a share of its square */
    double sure;     /* standard error, as a share of its light, that each is to have in the end */
    const struct watch *watch;
    uint64_t *rays;
};

/* Trace until each polygon has the paths it wants, in whole blocks. Returns 0, or -1 when out of
 * memory or stopped. */
int dim_paths_trace(struct dim_faces *d);

#endif
