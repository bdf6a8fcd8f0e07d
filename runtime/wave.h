/* wave.h - tools and terms over a block of pairs: what tools/NAME.wave.h and terms/NAME.wave.h
 * define, and what is promised to them.
 *
 * A graph that runs in waves (dagc --release=wave) asks a node's question of all pairs that have
 * reached it, by one call. A tool that the catalog calls `wave` brings the function for that; any
 * other is asked pair by pair in a loop. For tool NAME(p : real, q : count):
 *
 *     static inline void wave_NAME(struct discussion *block, const uint16_t *at, int count,
 *                                  const double *p, const int *q, unsigned char *answers);
 *
 * The pairs are block[at[0]] .. block[at[count - 1]], each once, in any order; p[k] and q[k] belong
 * to block[at[k]]. answers[k] becomes what tool_NAME(&block[at[k]], p[k], q[k]) would answer, and
 * the terms of block[at[k]] what it would leave there: to the bit, and whatever other pairs there
 * are. A term with `wave` in the catalog brings, for its levels (or without the last parameter),
 *
 *     static inline void wave_term_NAME(struct discussion *block, const uint16_t *at, int count,
 *                                       enum NAME_level level);
 *
 * after which term_NAME(&block[at[k]], level) finds it there. Graphs call it for what arguments
 * read, and tools as they like.
 *
 * count is from 1 to WAVE_PAIRS; all pairs have one host. Nothing but terms is written, and the
 * lists of blockers of each pair. No memory is allocated; a stack of 512 KiB is at hand.
 * SPDX-License-Identifier: MIT */
#ifndef WAVE_H
#define WAVE_H

#include "discussion.h"

enum { WAVE_PAIRS = 256 }; /* as PAIRS of dagc/emit/emit_wave.c */

#endif
