/* discuss.h - the discussions of a round.
 * SPDX-License-Identifier: MIT */
#ifndef DISCUSS_H
#define DISCUSS_H

#include "engine/refine.h"

/* Discuss the pairs from .. to - 1 of the round, those that are to be both ways: into the outcomes.
 */
void discuss_round(const struct refinement *r, size_t from, size_t to);

/* The same of links[round_count], as far as changed[] marks an end (NULL: all): decision[1] of the
 * outcome says whether it was. */
void discuss_again(const struct refinement *r, const struct link *links,
                   const unsigned char *changed);

int discuss_divides(unsigned char decision);

/* What the discussion `there` says of the link back: visibility is the same both ways, also where
 * it hides the pair, whose rays nobody casts twice. And so is the exchange A_r F_rs = A_s F_sr,
 * which a link computes once for both: reciprocity holds to the rounding of a link's F. Of a pair
 * that is split nothing is said: most that the parts ask is their own.
 * Fails: rays to the emitter's light (tools/light_visibility.h) are taken for rays to its area. */
void discuss_reverse(struct link *back, const struct link *there, const struct element *elements);

#endif
