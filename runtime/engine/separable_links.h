/* separable_links.h - light over links that have a cluster at one end.
 *
 * Between face j of the receiver and face i of the emitter the kernel is, v = y_i - x_j,
 *     k(x_j, y_i) = (n_j . v) (-n_i . v) / (pi |v|^4).
 * To sum that over all pairs of faces would cost the product of their numbers; so k is taken as a
 * product of one factor per side, it is made separable:
 *     k(x, y) = k(x, s) k(r, y) / k(r, s),
 * with one point and one normal for each side, its pivot (pivots.h): r where the emitter sees its
 * light go to, s where the receiver sees it come from. So the emitter's side is one sum per link,
 * what it sends to r,
 *     J = V / k(r, s) sum_i A_i B_i k(r, y_i)                                        (W),
 * and each face of the receiver takes H_j += J k(x_j, s) by its own place and orientation. What is
 * left of the error is of second order, in the product of the two sizes over the square of the
 * distance: either side may be as large as it likes while the other is small. A face's own size is
 * in k to second order, too. Both sums visit every face below the link's elements: over all links
 * that is each face times the links of its ancestors, no more than a push down the tree.
 * [Smits, Arvo, Greenberg 1994: alpha links are the same with k(x, y) = k(r, s) but for the
 * cosines. The product is one step of the adaptive cross approximation, Bebendorf 2000; the choice
 * of r and s: derived here]
 * SPDX-License-Identifier: MIT */
#ifndef SEPARABLE_LINKS_H
#define SEPARABLE_LINKS_H

#include <stddef.h>
#include <stdint.h>
#include "engine/separable_faces.h"
#include "hierarchy/hierarchy.h"
#include "engine/refine.h"

struct separable_link {
    uint32_t emitter; /* element */
    float scale;      /* V / (pi k(r, s)), k in 1/unit^2 */
    /* where the emitter, or the receiver, is a part of a face: its A k(r, y), and its k(x, s), pi
     * times; for each sweep to take */
    float sends, takes;
    struct pivot r, s;
};

struct separable_links {
    const struct hierarchy *hierarchy;
    int threads;
    int width;                    /* of vectors (kernel/lanes.h) */
    int centres;                  /* 1: a surface takes light at its centre (collocation) */
    struct face_range here;       /* in the tree's order, the faces that light is received for */
    double unit;                  /* m; a power of two */
    struct separable_link *links; /* [count], by receiver */
    size_t count;
    size_t *first; /* [elements + 1]: the links of element e are first[e] .. first[e + 1] - 1 */
    uint32_t elements;
    /* [count * bands]: J; before the first separable_links_send [count], for a radiosity of 1 */
    float *arrives;
    /* [bands][face_count], in the tree's order: irradiance over the faces' own links and their
     * clusters' */
    float *received;
    uint32_t *place;              /* [face_count]: where a face stands in the tree's order */
    float *taken;                 /* [face_count]: the share of what arrives that a face takes, 1 */
    struct separable_faces faces; /* [face_count], in the tree's order */
};

/* Take the links that have a cluster at one end from a sorted refinement. Pivots weigh faces by the
 * radiosities that the oracles see. `centres`: what a surface gathers is taken at its centre, not
 * the mean over it. `here`: the faces, in the tree's order, of which anybody asks what they
 * receive; `bands`: the most that are sent. Returns 0, or -1 when out of memory. */
int separable_links_open(struct separable_links *c, const struct hierarchy *h,
                         const struct refinement *r, int bands, int threads, int centres,
                         struct face_range here);

/* Set J of each link, with the radiosities [elements * bands] as they are. */
void separable_links_send(const struct separable_links *c, int bands, const double *radiosity);

/* Add to h[bands] what the surface e gathers from links: its own, and, when it is a whole face,
 * its clusters'. */
void separable_links_gather(const struct separable_links *c, int bands, uint32_t e, double *h);

/* The row of e over the same links: what they bring from a radiosity of 1. Only before the first
 * separable_links_send. */
double separable_links_row(const struct separable_links *c, uint32_t e);

/* Have a face and its parts take this share of what arrives over links; 1 at first. */
void separable_links_weaken(const struct separable_links *c, uint32_t face, double share);

/* J of link b by a radiosity of 1 on the element e alone, a face below its emitter or the part of a
 * face that is it; and what e, a face below its receiver or the part that is it, takes over J. */
double separable_links_sends(const struct separable_links *c, size_t b, uint32_t e);
double separable_links_takes(const struct separable_links *c, size_t b, uint32_t e);

/* What link b brings to a point x (m) with normal n, over J: k(x, s). */
double separable_links_at(const struct separable_links *c, const struct separable_link *b,
                          const double x[3], const double n[3]);

void separable_links_close(struct separable_links *c);

#endif
