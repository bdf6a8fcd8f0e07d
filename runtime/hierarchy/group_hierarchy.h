/* group_hierarchy.h - a hierarchy with flat groups of faces between clusters and faces.
 *
 * Groups are surfaces: 3 or 4 vertices, an outline around their faces, marked as `group`. Those
 * whose faces tile their outline are solid: they stand in a shaft as one face.
 * SPDX-License-Identifier: MIT */
#ifndef GROUP_HIERARCHY_H
#define GROUP_HIERARCHY_H

#include "hierarchy/hierarchy.h"

/* Over the faces of `plain`, which are borrowed from where it has them; every face has B = 1 and
 * reflects nothing. `flat`: how far from its plane a group's faces may reach (m). Depends on the
 * faces alone. Returns 0, or -1 when out of memory. */
int hierarchy_build_groups(struct hierarchy *h, const struct hierarchy *plain, double flat);

#endif
