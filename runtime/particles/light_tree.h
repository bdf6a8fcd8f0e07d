/* light_tree.h - emitters chosen by what they may send to a point: by power, distance and angles.
 *
 * A binary tree over the emitters, halved where they reach farthest. From the root down one of two
 * children is taken by the power below it, times a bound of the cosines at both ends, over the
 * square of the distance; each node is taken for the sphere around it. What stands between is not
 * known. [Conty Estevez and Kulla 2018]
 * SPDX-License-Identifier: MIT */
#ifndef LIGHT_TREE_H
#define LIGHT_TREE_H

#include <stdint.h>
#include "hierarchy/hierarchy.h"

struct light_node {
    double centre[3], radius; /* m */
    double axis[3];           /* unit vector: their mean normal */
    double across, along; /* sine and cosine of the cone of normals around it; along <= 0: any */
    double power;         /* W, all bands */
};

/* The node of the emitters from .. to - 1 is followed by that of the first half, rounded down, and
 * all below it; then by that of the others. */
struct light_tree {
    struct light_node *node; /* [2 count - 1], the root first */
    uint32_t *face;          /* [count] */
    uint32_t *place;         /* [faces]: of each among them; UINT32_MAX: does not emit */
    uint32_t count;
};

/* exitance: [face * bands + band] (W/m2). Returns 0, or -1 when out of memory. */
int light_tree_open(struct light_tree *tree, const struct hierarchy *h, const double *exitance,
                    uint32_t bands);
void light_tree_close(struct light_tree *tree);

/* The emitter that u in [0, 1) stands for, as seen from p (m) above a plane of unit normal n.
 * Returns its chance; 0: there is none that may shine there. */
double light_tree_choose(const struct light_tree *tree, const double p[3], const double n[3],
                         double u, uint32_t *face);

/* The chance of a face, as light_tree_choose would return it; 0 also for what does not emit. */
double light_tree_chance(const struct light_tree *tree, const double p[3], const double n[3],
                         uint32_t face);

#endif
