/* cluster_light.h - light over links that have a cluster at one end.
 *
 * From far away a cluster is a point that sends, towards w, the intensity of its faces,
 *     J(w) = (1/pi) sum_i A_i B_i max(0, n_i . w)                                    (W/sr),
 * and what arrives at a cluster is a beam that each face takes by its own orientation,
 *     H_j += J(w) V / d^2 max(0, -n_j . w)                                           (W/m2),
 * w from the emitter's centre to the receiver's, d their distance, with a factor near 1 for the size of both. [Smits, Arvo, Greenberg 1994, alpha links,
 * with the sums over faces taken as they are and not bounded; Sillion 1995 for the directions]
 * Both sums visit every face below the link's ends: over all links that is each face times the links of its
 * ancestors, no more than a push down the tree, and exact for every orientation.
 * SPDX-License-Identifier: MIT */
#ifndef CLUSTER_LIGHT_H
#define CLUSTER_LIGHT_H

#include <stddef.h>
#include <stdint.h>
#include "hierarchy.h"
#include "refine.h"

struct cluster_beam {
    uint32_t emitter;
    float towards[3]; /* unit vector from the receiver to the emitter */
    float weight;     /* V / d^2 and the sizes' factor (1/m2) */
};

struct cluster_light {
    const struct hierarchy *hierarchy;
    int bands, threads; /* bands: the most that `arrives` has room for */
    struct cluster_beam *beams; /* [count], by receiver */
    size_t count;
    size_t *first;   /* [elements + 1]: the beams of element e are first[e] .. first[e + 1] - 1 */
    uint32_t elements;
    float *arrives;  /* [count * bands]: J V / d^2; before the first cluster_light_send [count], for a radiosity of 1 */
    float *normal[3]; /* [face_count] each, in the tree's order */
    float *sent[3];   /* [bands][face_count]: A B / pi, in the tree's order */
};

/* Take the links that have a cluster at one end from a sorted refinement. Returns 0, or -1 when out of memory. */
int cluster_light_open(struct cluster_light *c, const struct hierarchy *h, const struct refinement *r, int bands, int threads);

/* What each beam brings, with the radiosities [elements * bands] as they are. */
void cluster_light_send(const struct cluster_light *c, int bands, const double *radiosity);

/* Add to h[bands] what the surface e gathers from beams: its own, and, when it is a whole face, its clusters'. */
void cluster_light_gather(const struct cluster_light *c, int bands, uint32_t e, double *h);

/* The sum over the same beams of what they would bring from a radiosity of 1. Only before the first cluster_light_send. */
double cluster_light_row(const struct cluster_light *c, uint32_t e);

void cluster_light_close(struct cluster_light *c);

#endif
