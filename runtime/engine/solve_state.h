/* solve_state.h - a solve between two passes, to go on with another day.
 *
 * What is kept: which elements are split, in their order; what oracles see of elements; the light
 * so far; links; and counts. All else follows from the scene, the oracle and the options, of which
 * the head holds hashes, as it does of every part. Invariant: what goes on from a state ends with
 * the bits of what was never put down, on any number of ranks and threads, whatever number made it.
 *
 * Nothing that is read is believed: indices are held against what there is, so that no state leads
 * outside of an array.
 * SPDX-License-Identifier: MIT */
#ifndef SOLVE_STATE_H
#define SOLVE_STATE_H

#include "engine/solve.h"

enum solve_state_word {
    STATE_NAME,
    STATE_VERSION,
    STATE_SCENE,
    STATE_ORACLE,
    STATE_OPTIONS,
    STATE_BUILT, /* elements before the first split; then how many splits, and links of all ranks */
    STATE_SPLITS,
    STATE_LINKS,
    STATE_PASSES,
    STATE_SWEEPS,
    STATE_CHANGING,
    STATE_PAIRS,
    STATE_ROUNDS,
    STATE_RAYS,
    STATE_DECIDED,
    STATE_SECONDS = STATE_DECIDED + 8, /* of refine, iterate, in_rays: the bits of doubles */
    STATE_LINKED = STATE_SECONDS + 3,  /* the bits of a double */
    STATE_CHECKS,                      /* of each part, in their order; [0]: of the head */
    STATE_WORDS = STATE_CHECKS + RAD_STATE_PARTS
};

/* What the parts are in that are not lent as they are. */
struct solve_state {
    uint64_t head[STATE_WORDS];
    uint32_t *split, *mark; /* the parent of each four; [element] */
    double *seen;           /* [element * 3]: radiosity, spread, deviation as oracles see them */
    struct link *links;     /* those that this rank counts; NULL: all that it has */
};

/* Why a solve has no state, as its oracle keeps more; NULL: it has one. */
const char *solve_state_refusal(const struct solve *s);

/* The solve's state, in parts that are good until it goes on; it has links. On all ranks. Returns
 * 0, or -1 with *cause, on all ranks. */
int solve_state_make(struct solve_state *state, const struct solve *s,
                     struct RadStatePart part[RAD_STATE_PARTS], const char **cause);
void solve_state_free(struct solve_state *state);

/* Bring a solve that has no links yet to where the parts were made. Returns 0, or -1 with *cause on
 * all ranks; then there is nothing to go on with. *refused: it is the parts that are at fault. */
int solve_state_take(struct solve *s, const struct refiner *refiner,
                     const struct RadStatePart part[RAD_STATE_PARTS], int *refused,
                     const char **cause);

#endif
