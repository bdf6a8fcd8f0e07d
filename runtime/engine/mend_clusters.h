/* mend_clusters.h - the light of clusters, and of faces as wholes, mended.
 * SPDX-License-Identifier: MIT */
#ifndef MEND_CLUSTERS_H
#define MEND_CLUSTERS_H

#include "engine/mend_risk.h"
#include "engine/mend_sums.h"

/* What the scene receives, and how it is shared out among clusters down to faces:
 * irradiance[element * bands + band] (W/m2). doubt: NULL, or likewise the square of the error that
 * is left, over that of the irradiance, in the mean of clusters as large. risk: NULL, or found.
 * before: NULL, or the links' light and counts of others, which have mended it to these
 * irradiances: then what the scene receives stays, and they say what it reflects. Returns 0, or -1
 * on all ranks when any is out of memory. */
int mend_clusters(const struct mend_sums *m, const struct mend_sums *before, double *irradiance,
                  double *doubt, struct mended_risk *risk);

#endif
