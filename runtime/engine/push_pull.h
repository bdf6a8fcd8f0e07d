/* push_pull.h - light on one face and its parts.
 * SPDX-License-Identifier: MIT */
#ifndef PUSH_PULL_H
#define PUSH_PULL_H

#include "engine/transport.h"

/* What a sweep changes on one face. */
struct change {
    double moved;           /* sum A |dx| over uncovered leaves, all bands */
    double most[3], sum[3]; /* max |dx| / (1 - k) over leaves; sum A k over uncovered leaves */
    double power[3];        /* A x of the face as it is then, over what is uncovered */
};

/* Into h[band], what element e gathers of value[element * bands + band] over its own links; links
 * of groups bring what separable_links_send was last called with. */
void element_gather(const struct light_operator *op, const double *value, uint32_t bands,
                    uint32_t e, double h[3]);

/* Into irradiance[], what the surface e and each of its parts gather over links of their own. Where
 * clusters are linked, separable_links_send comes first. */
void face_gather(const struct light_operator *op, const struct transport *x, uint32_t e);

/* With that, or whatever else stands in irradiance[]: H of the leaves of face e, their x = source +
 * rho H, and means of both above them. */
void face_update(const struct light_operator *op, const struct transport *x, uint32_t e,
                 struct change *change);

/* Set element e of value and irradiance to the means of its children. */
void element_average(const struct light_operator *op, const struct transport *x, uint32_t e);

#endif
