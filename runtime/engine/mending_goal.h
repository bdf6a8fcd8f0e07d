/* mending_goal.h - when particles are enough.
 * SPDX-License-Identifier: MIT */
#ifndef MENDING_GOAL_H
#define MENDING_GOAL_H

#include <stdint.h>

struct mending_goal {
    double noise;    /* theirs in the L1 error of polygons, a share of the reflected light */
    double left;     /* or what mending leaves of it at the most, the same; 0: not looked at */
    double power;    /* and the standard error of all reflected light, the same; 0: any */
    uint64_t plain;  /* rays, about, before that is looked at */
    uint64_t most;   /* rays, about: no more, whatever they have reached */
    double places;   /* error on places, root mean square as ray_split.h; 0: not looked at */
    uint64_t least;  /* rays, about, before that is looked at */
    double expected; /* rays that may be needed for it; 0: nothing is known */
    double linked;   /* squared error on places of links that these are finer than; 0: not known */
    int own;         /* 1: quarters may stay with the ranks that own their faces (own_quarters.h) */
    int look;        /* 1: polygons that are too dim for particles stay as they are */
};

#endif
