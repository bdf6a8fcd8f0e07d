/* sight_look.h - what points of one face see of another past what stands between.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHT_LOOK_H
#define SIGHT_LOOK_H

#include "engine/sight_between.h"
#include "engine/sight_bodies.h"

struct sight_look {
    const struct exchange_tree *tree;
    struct sight sight;            /* of the face that is looked at */
    struct sight_between *between; /* borrowed, as what follows */
    struct sight_bodies *bodies;
    int by_bodies; /* 1: what is in `between` is in `bodies` */
    uint32_t on;   /* the element that points are on, or that they are on a part of */
    int joined;    /* 1: a solid that stands on it touches what is looked at, or holds it */
};

/* What stands between, for points to look past it. Returns -1 when it is too much. */
int sight_look_place(struct sight_look *look);

/* The form factor from a point x with normal n to what it sees of the face; *whole: to all of it.
 * In [0, 1]. */
double sight_look_from(const struct sight_look *look, const double x[3], const double n[3],
                       double *whole);

#endif
