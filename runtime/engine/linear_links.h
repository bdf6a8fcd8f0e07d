/* linear_links.h - what linear elements have beside the links: a basis per surface, eight moments
 * per link, and rows.
 *
 * Links that have a cluster at one end stay constant: each face of the receiver takes what it takes
 * without slopes, and of the emitter the means are sent (separable_links.h).
 *
 * Visibility is one number per link: a shadow that falls across a leaf shows no slope, and the
 * slopes that a link in half shadow has are those of its light, evenly thinned.
 * SPDX-License-Identifier: MIT */
#ifndef LINEAR_LINKS_H
#define LINEAR_LINKS_H

#include "engine/linear_coupling.h"
#include "engine/operator.h"

/* What the rows of a leaf come to: radiosity 1 everywhere makes the irradiance row + b1 phi_1 + b2
 * phi_2 there. */
struct linear_row {
    double above[2], own[2]; /* b1, b2, over its ancestors' links and its own, before any scale */
    double flat[2];          /* slopes to be taken off what it receives, per mean */
    double scale;            /* in [0, 1], for what is left of the slopes */
};

struct linear_links {
    struct linear_basis *basis; /* [element], of surfaces */
    /* [link], in the refinement's order; 0 where a cluster is, and of faint links */
    float (*moment)[LINEAR_MOMENTS];
    double faint;           /* W: links that carry less stay constant */
    struct linear_row *row; /* [element], of leaves */
    const struct light_operator *of;
    unsigned char *nonnegative; /* [link]: 1: the kernel has been made so */
    int limited;                /* 1: all have been */
};

/* Bases and moments over the links of the operator's refinement, sorted. Returns 0, or -1 when out
 * of memory. */
int linear_links_open(struct linear_links *l, const struct light_operator *op);

/* Make the kernels of links nonnegative: of those whose receiver is marked, or, with NULL, of all.
 * Returns how many were made so. */
size_t linear_links_limit(struct linear_links *l, const unsigned char *receivers);

/* The rows of the leaves below surface e, as sum_links of row_sums.c leaves them for constants:
 * [0] of their mean, into the operator's row_scale and row_above, slopes into l->row. */
void linear_links_rows(const struct linear_links *l, const struct light_operator *op, uint32_t e,
                       const double above[3]);

/* Once the rows are scaled: set flat and scale of the leaves' rows. */
void linear_links_scale(struct linear_links *l, const struct light_operator *op);

/* Add to h[band][3] what element e gathers over its own links between surfaces from `sent`
 * [(element * bands + band) * 3]. */
void linear_links_gather(const struct linear_links *l, const struct light_operator *op,
                         uint32_t bands, uint32_t e, const double *sent, double h[3][3]);

/* The part of a linear function over e, b[3], that is on its part `child`. */
void linear_links_restrict(const struct linear_links *l, const struct hierarchy *h, uint32_t e,
                           uint32_t child, const double b[3], double on_child[3]);

/* What the part `child` of e gets of an irradiance of e, b[3]: the barer, the more. */
void linear_links_hand_down(const struct linear_links *l, const struct light_operator *op,
                            uint32_t e, uint32_t child, const double b[3], double on_child[3]);

void linear_links_close(struct linear_links *l);

#endif
