/* discussion.h - what a tool sees of the world: one pair of elements, the data manager and the
 * host.
 *
 * A discussion is one run of an oracle over one pair (receiver, emitter). Tools are
 * `static inline` functions over a discussion, one file each under tools/; they share values
 * only through the data manager, `terms`, which keeps each term with the level of precision
 * it was computed at. A tool that needs a term asks term_NAME(d, level) (terms/NAME.h), which
 * computes the term when it is absent or coarser. [Turbet & Sillion, sections 3 and 4.1]
 *
 * Invariant: a tool reads the pair and the host and writes nothing but terms (the list of term
 * blockers among them). So pairs can be discussed in any order and on any thread, and the result is
 * the same.
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
#define RUNTIME_ABI 14

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
    /* The first cache line: what a walk down the clusters asks of each child. */
    double normal[3];    /* surface: unit normal; cluster: axis of the normal cone */
    double area;         /* m2; cluster: sum over its faces */
    double cone;         /* cluster: cosine of the normal cone's half-angle, -1 for "any way" */
    uint32_t child;      /* index of the first child, the others follow; 0: not split yet */
    uint8_t children;    /* how many, 0 when not split yet */
    uint8_t vertices;    /* 3 or 4; 0 for a cluster */
    uint8_t black;       /* 1: emits and reflects nothing, now or later */
    uint8_t depth;       /* splits below the face; 0 for faces and clusters */
    double radius;       /* of the sphere around centre that holds the element (m) */
    double radiosity;    /* B, W/m2, largest band; cluster: area mean. Constant during a round */
    double centre[3];    /* surface: area centroid; cluster: middle of the bounding box (m) */
    double vertex[4][3]; /* surface: corners (m); cluster: [0] and [1] are the box's corners */
    uint64_t id;         /* path from the root, hashed: equal in every run, whatever the order */
    /* largest less smallest B below the element, W/m2. Constant during a round */
    double spread;
    /* half the area mean of |B - its mean| below the element, W/m2: the most that light to a place
     * which sees only a part of the element may differ by. Constant during a round */
    double deviation;
    double reflectance; /* rho, largest band; cluster: of the whitest of its faces */
    /* Y, what the view makes of irradiance here, 1 where no view asks. Constant during a round */
    double importance;
    /* the error one link may bring here, W/m2, as the account of error set it; INFINITY: any */
    double tolerance;
    /* of the lower and the upper solution (W/m2): no point has less B than `lower`; how much nearer
     * the two come where its parts are taken one by one. 0 where nobody asks */
    double lower, gap;
    uint32_t parent; /* index in the hierarchy; the root is its own parent */
    /* surface: index of the face it is part of; of the first of a group's faces */
    uint32_t face;
    /* how far from linear over the element is what all its links bring it together, W/m2, or those
     * of what it is a part of; 0 before any do, INFINITY: any. Constant during a round */
    float bend;
    /* 1: a flat group of faces, given as the surface that is the rectangle around them */
    uint16_t group;
    /* what an oracle has marked it with, 1 to 7, or what it is a part of; 0: nothing. Constant
     * during a round */
    uint16_t mark;
};

/* A straight line between two points, ends included. */
struct segment {
    double from[3], to[3];
};

enum { SEGMENTS_MAX = 64 }; /* the most that one call of `occluded` is given */

/* The convex hull of two surfaces: what light between them may cross (kernel/shaft.h). */
enum { SHAFT_PLANES = 28, SHAFT_ROOM = SHAFT_PLANES + 16 };
struct shaft {
    int planes;
    /* inside: normal . p <= offset, normals of length 1, coordinate by coordinate. Behind the last
     * is room for what a vector may read besides (kernel/shaft_planes.h) */
    double normal[3][SHAFT_ROOM], offset[SHAFT_ROOM];
    double low[3], high[3]; /* box around it, `reach` included (m) */
    /* what is farther from it does not meet it, whatever the tolerances (m) */
    double reach;
    double margin, touch, slack, grow, flat, nests; /* tolerances (m) */
    int points[2]; /* of the two ends: their corners, as far off the surface as rays start */
    double end[2][POLYGON_MAX][3], facing[2][3]; /* and their normals */
};

/* The faces that may stand between the two elements of a pair, in ascending order. */
enum { BLOCKERS_MAX = 8, BLOCKERS_TOO_MANY = BLOCKERS_MAX + 1 };
enum { BLOCKERS_UNKNOWN, BLOCKERS_INHERITED, BLOCKERS_OWN };
struct blockers {
    int count;            /* or BLOCKERS_TOO_MANY */
    unsigned char known;  /* not at all; of a pair that holds this one; of this pair */
    unsigned char handed; /* own: good for the pairs below this one */
    /* own: no light can pass, one of the faces covers the shaft or they do not face each other */
    unsigned char covered;
    /* asked for by a tool that had its answer without it: to be found for the pairs below, if
     * there are any. Zero at first */
    unsigned char wanted;
    uint32_t face[BLOCKERS_MAX];
};

enum { HOST_HIDDEN = -1 }; /* what `candidates` says of a shaft that lets no light pass */

/* What the program around the refiner provides. */
struct host {
    /* Which of `count` (1 to SEGMENTS_MAX) segments meet a face, from either side? Bit i stands for
     * segment i; bits from count on are 0. Called from many threads at once. */
    uint64_t (*occluded)(const struct host *host, int count, const struct segment *segments);
    double area;             /* of all faces, m2 */
    double extent;           /* longest side of the scene's box (m) */
    double exitance;         /* the largest E, W/m2 */
    double reflectance;      /* the largest rho */
    double mean_reflectance; /* of all faces by area, > 0; 1 where none reflects */
    double irradiance;       /* mean irradiance to expect, W/m2: <E>/(1-<rho>), exact in a sphere */
    double radiosity;        /* mean radiosity to expect, W/m2: <E> + <rho> irradiance */
    double importance;       /* the largest Y; 1 where no view asks */
    double impact; /* what the largest importance stands for, W per W; 1 where nobody asks */
    double rank;   /* W: what this pass leaves to later ones; 0: nothing */
    double faces;  /* how many */
    /* where the hierarchy's elements stand, for `child`; NULL: no clusters here */
    const struct element *const *elements;
    double ray_offset; /* how far off its surface a ray must start (m) */
    double flat;       /* a point this near to a plane lies in it (m) */

    /* For the tools that look into a shaft; NULL: the host has none of it, and they answer
     * too_complex. Lists in `faces` up to `most` faces that may meet the shaft and returns how
     * many; more than `most` when there may be more; HOST_HIDDEN when it has proved that faces stop
     * all light in the shaft. It may list a face too many, never one too few; kernel/shaft.h
     * helps. */
    int (*candidates)(const struct host *host, const struct shaft *shaft, int most,
                      uint32_t *faces);
    /* 1: `candidates` lists none too many, either: each is held against the shaft by shaft_meets,
     * with the corners that `corners` gives, so that nobody need do it again */
    int exact;
    /* The corners of a face that `candidates` listed. */
    void (*corners)(const struct host *host, uint32_t face, struct polygon *polygon);
    /* Optical depth of the scene's clusters along a segment, sum of kappa l, but for those that
     * hold one of two faces (tools/extinction.h). NULL: 0. */
    double (*optical_depth)(const struct host *host, const struct segment *segment,
                            uint32_t receiver, uint32_t emitter);
};

struct discussion {
    const struct element *receiver, *emitter;
    const struct host *host;
    struct terms terms; /* the data manager; all zero: nothing is known yet */
    /* where term blockers keeps its list; may hold an inherited one. NULL: nothing is kept */
    struct blockers *blockers;
};

#endif
