/* mend.h - radiosities of links mended by particles, as far as these stand out of their noise.
 * SPDX-License-Identifier: MIT */
#ifndef MEND_H
#define MEND_H

#include "engine/mend_risk.h"
#include "engine/operator.h"
#include "particles/particles.h"

/* What each element receives once mended: irradiance[element * bands + band] (W/m2), whose values
 * by the links are given, are set anew on all surfaces and clusters. The tally has counts of
 * leaves. Returns 0, or -1 when out of memory. */
int mend_irradiance(const struct light_operator *op, const struct tally *tally, double *irradiance);

/* The same of irradiances that other particles, which tallied `before`, have made of those of
 * links; NULL, NULL: none did. The tallies are independent, and each is believed as far as it is
 * surer. What the scene receives stays. `before` needs no counts of leaves. Returns as above. */
int mend_again(const struct light_operator *op, const struct tally *tally,
               const struct tally *before, const double *links, double *irradiance);

/* The same of clusters and faces as wholes: [built * bands], of this rank's. doubt:
 * mend_clusters.h.
 */
struct mended_faces {
    double *irradiance, *doubt;
};

/* By the light of links, which stays. risk: NULL, or how far off they are. Returns 0, or -1 on all
 * ranks when any is out of memory; either way mended_faces_close. */
int mend_faces(const struct light_operator *op, const struct tally *tally, const double *light,
               struct mended_faces *faces, struct mended_risk *risk);
void mended_faces_close(struct mended_faces *faces);

#endif
