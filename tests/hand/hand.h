/* hand.h - the hand-written releases: the yardstick for what dagc makes of the same oracles.
 *
 * bf and bf_guarded share the elements and the ray caster with the rest of the project and nothing
 * else: no tool, no term, no generated code. power shares the geometry, too: form factors, points
 * of rays, shafts and outlines, which are longer than all that is here. Same formulas in the same
 * order, so that decisions and link values agree to the bit. (The paper's "BF release", Turbet &
 * Sillion, section 4.4.)
 * SPDX-License-Identifier: MIT */
#ifndef HAND_H
#define HAND_H

#include "oracle.h"

extern const struct oracle hand_bf, hand_bf_guarded, hand_power;
extern const struct oracle *const hand_releases[]; /* all of them; ends with NULL */

/* The form factor of two polygons, each clipped at the other's plane. */
double hand_form_factor(const struct element *r, const struct element *s);

/* The visible fraction by 4, 16 or 64 rays. */
double hand_visibility(const struct element *r, const struct element *s, const struct host *host,
                       int rays);

/* Does nothing of the one face anything of the other? Of a pair that holds a cluster. */
int hand_apart(const struct element *r, const struct element *s, const struct host *host);

/* What bf and bf_guarded do to a pair that holds a cluster. */
enum decision hand_open_clusters(const struct element *r, const struct element *s,
                                 const struct host *host);

#endif
