/* sight_casting.h - what of a convex polygon convex solids hide from one point.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_CASTING_H
#define SIGHT_CASTING_H

#include "engine/sight_bodies.h"

/* The corners that a shadow may have in the polygon; what has more is cut out face by face. */
enum { SHADOW_CORNERS = 64 };

/* A line: outside of the shadow where a u + b v > c. a, b: of length one. */
struct body_line {
    double a, b, c;
};

/* What of the polygon a body hides: convex, counter-clockwise. by[i]: whose the edge is that
 * begins at corner i: the polygon's side, or POLYGON_MAX and the place of a line. */
struct body_shadow {
    int n, by[SHADOW_CORNERS];
    double p[SHADOW_CORNERS][2];
};

/* A point's shadows that have an edge through the polygon. */
struct casting {
    double from[3], most;             /* the point; how high what casts shadows may be */
    double near;                      /* to a plane: the point may be on either side */
    double own, per, away;            /* how large the polygon is, 1 / own; how far */
    double grow;                      /* how much more than the one before each shadow does */
    int sides;                        /* of the polygon */
    double corner[2][POLYGON_MAX];    /* its */
    double side[POLYGON_MAX][4];      /* planes from the point through its sides */
    int64_t out[SIGHT_BODY_CORNERS];  /* of corners: bits of the planes they are outside of */
    double height[SIGHT_BODY_PLANES]; /* of the point over planes */
    /* of edges: the line that the plane of the point and the edge cuts out of the polygon's, a u +
     * b v - c above on the edge's right; what rounding moves that by; bits of the polygon's corners
     * that are for sure below and above */
    double line[4][SIGHT_BODY_EDGES + LANES_MOST];
    int64_t under[SIGHT_BODY_EDGES + LANES_MOST], over[SIGHT_BODY_EDGES + LANES_MOST];
    int count, first[SIGHT_BODIES + 1]; /* shadows; where their lines begin, and the last's end */
    struct body_shadow shadow[SIGHT_BODIES];
    struct body_line cut[SIGHT_BODY_EDGES];
};

/* What of the polygon a body hides. */
enum rest { REST_UNTOLD, REST_NONE, REST_ALL, REST_SOME };

/* Of a point, whose place in the plane's coordinates is `from`, over the plane, and which is `up`
 * off its own face. */
void sight_casting_open(struct casting *c, const struct sight_bodies *b,
                        const struct outline_cell *cell, const double from[3], double up);

/* A body's shadow, grown by so much: what of the polygon all edges of its outline leave. It counts
 * when it is some. */
enum rest sight_casting_add(struct casting *c, const struct sight_bodies *b,
                            const struct sight_body *body, const struct outline_cell *cell,
                            double grow);

#endif
