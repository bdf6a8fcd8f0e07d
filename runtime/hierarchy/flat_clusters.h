/* flat_clusters.h - clusters whose faces all lie in one plane, as those of a floor of many faces.
 * SPDX-License-Identifier: MIT */
#ifndef FLAT_CLUSTERS_H
#define FLAT_CLUSTERS_H

#include "hierarchy/hierarchy.h"
#include "kernel/constants.h"

/* So far may the planes of a cluster's faces be apart within the scene, as a share of its size:
 * half of the least that shafts take for rounding (kernel/shaft.h). */
#define FLAT_APART (0.5 * RAY_OFFSET * SHAFT_SLACK)

/* Makes `plane` of a hierarchy. Returns 0, or -1 when out of memory. */
int flat_clusters_find(struct hierarchy *h);

#endif
