/* coplanar_groups.h - which faces lie in one plane.
 * SPDX-License-Identifier: MIT */
#ifndef COPLANAR_GROUPS_H
#define COPLANAR_GROUPS_H

#include "hierarchy/hierarchy.h"

struct coplanar_groups {
    uint32_t *order;           /* [faces]: by group, and by number within it */
    struct face_range *groups; /* [count], of order; fronts and far sides are never in one */
    uint32_t count;
};

/* Group the faces of a hierarchy: within a group all corners lie in one plane to `flat` (m), and
 * all fronts look the same way. Returns 0, or -1 when out of memory. */
int coplanar_groups_find(struct coplanar_groups *g, const struct hierarchy *plain, double flat);
void coplanar_groups_free(struct coplanar_groups *g);

#endif
