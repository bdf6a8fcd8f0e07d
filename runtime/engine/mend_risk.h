/* mend_risk.h - how far faces are off once clusters have been mended, and how sure that is.
 * SPDX-License-Identifier: MIT */
#ifndef MEND_RISK_H
#define MEND_RISK_H

#include "engine/mend_sums.h"

/* Clusters that this rank mends, parents first. */
struct mended_clusters {
    const uint32_t *parent; /* [count] */
    uint32_t count;
    const double *doubted; /* [count * bands]: what of the difference between counts and links is
                            * not believed, a share; below 0: no particle landed there */
};

struct mended_risk {
    const unsigned char *apart; /* [face]: 1: it is left out */
    double value, most; /* set: the L1 error of the others, as a share of all reflected light, and
                         * its upper end (97.5 %) */
};

/* Of the irradiances that clusters and faces have once mended: irradiance[element * bands + band]
 * (W/m2). Returns 0, or -1 on all ranks when any is out of memory. */
int mend_risk_find(const struct mend_sums *m, const struct mended_clusters *clusters,
                   const double *irradiance, struct mended_risk *risk);

#endif
