/* discussion.h - what a tool sees of the world: one pair of elements, the data manager and the host.
 *
 * A discussion is one run of an oracle over one pair (receiver, emitter). Tools are
 * `static inline` functions over a discussion, one file each under tools/; they share values
 * only through the data manager, `terms`, which keeps each term with the level of precision
 * it was computed at. A tool that needs a term asks term_NAME(d, level) (terms/NAME.h), which
 * computes the term when it is absent or coarser. [Turbet & Sillion, sections 3 and 4.1]
 *
 * Invariant: a tool reads the pair and the host and writes nothing but terms. So pairs can be
 * discussed in any order and on any thread, and the result is the same.
 *
 * This header is C11 and C++11, needs libm only, and allocates nothing. Units: metres, W/m2.
 * SPDX-License-Identifier: MIT */
#ifndef DISCUSSION_H
#define DISCUSSION_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "geometry.h"

/* Raised whenever a structure below, or the meaning of a generated file's calls, changes. */
#define RUNTIME_ABI 2

#include "catalog.h" /* generated from catalog.dag: answers, levels, struct terms, decisions */

/* Everything a tool calls is inlined into the flat release, so that its local discussion can
 * live in registers; what is too large for that takes elements, never the discussion. */
#if defined __GNUC__
#define TOOL static inline __attribute__((always_inline))
#define OUTLINE static __attribute__((noinline, unused))
#else
#define TOOL static inline
#define OUTLINE static
#endif

/* One node of the hierarchy: a cluster of faces, a face, or a part of a face.
 * Surfaces are convex planar polygons, counter-clockwise seen from the front. */
struct element {
    double centre[3];    /* surface: area centroid; cluster: middle of the bounding box (m) */
    double normal[3];    /* surface: unit normal; cluster: axis of the normal cone */
    double area;         /* m2; cluster: sum over its faces */
    double radius;       /* of the sphere around centre that holds the element (m) */
    double radiosity;    /* B, W/m2, largest band; cluster: area mean. Constant during a round */
    double spread;       /* largest less smallest B below the element, W/m2. Constant during a round */
    double reflectance;  /* rho, largest band; cluster: area mean */
    double importance;   /* Y, what the view makes of irradiance here, 1 where no view asks. Constant during a round */
    double allowance;    /* the error one link may bring here, W/m2, as the account of error set it; INFINITY: any */
    double cone;         /* cluster: cosine of the normal cone's half-angle, -1 for "any way" */
    double vertex[4][3]; /* surface: corners (m); cluster: [0] and [1] are the box's corners */
    uint64_t id;         /* path from the root, hashed: equal in every run, whatever the order */
    uint32_t parent;     /* index in the hierarchy; the root is its own parent */
    uint32_t child;      /* index of the first child, the others follow; 0: not split yet */
    uint32_t face;       /* surface: index of the face it is part of */
    uint8_t children;    /* how many, 0 when not split yet */
    uint8_t vertices;    /* 3 or 4; 0 for a cluster */
    uint8_t black;       /* 1: emits and reflects nothing, now or later */
    uint8_t depth;       /* splits below the face; 0 for faces and clusters */
};

/* A straight line between two points, ends included. */
struct segment {
    double from[3], to[3];
};

enum { SEGMENTS_MAX = 64 }; /* the most that one call of `occluded` is given */

/* What the program around the refiner provides. */
struct host {
    /* Which of `count` (1 to SEGMENTS_MAX) segments meet a face, from either side? Bit i stands for
     * segment i; bits from count on are 0. Called from many threads at once. */
    uint64_t (*occluded)(const struct host *host, int count, const struct segment *segments);
    double area;       /* of all faces, m2 */
    double extent;     /* longest side of the scene's box (m) */
    double exitance;   /* the largest E, W/m2 */
    double irradiance; /* mean irradiance to expect, W/m2: <E>/(1-<rho>), exact in a sphere */
    double radiosity;  /* mean radiosity to expect, W/m2: <E> + <rho> irradiance */
    double importance; /* the largest Y; 1 where no view asks */
    double faces;      /* how many */
    const struct element *const *elements; /* where the hierarchy's elements stand, for `child`; NULL: no clusters here */
    double ray_offset; /* how far off its surface a ray must start (m) */
    double flat;       /* a point this near to a plane lies in it (m) */
};

struct discussion {
    const struct element *receiver, *emitter;
    const struct host *host;
    struct terms terms; /* the data manager; all zero: nothing is known yet */
};

#endif
