/* exchange_state.h - the work on exchange areas as it stands, as bytes, to go on with another day.
 *
 * Between two rounds of refinement the state is the splits in their order, links and waiting pairs
 * with their lists; while values are computed, also the values of the first blocks, of which those
 * of groups in clear view are left out: they are made anew in next to no time. All else follows
 * from the scene and the options. Invariant: what goes on from a state ends with the bits of what
 * was never put down.
 *
 * Nothing that is read is believed: indices are held against what there is, so that no state, by
 * whomever it was made, leads outside of an array.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_STATE_H
#define EXCHANGE_STATE_H

#include "engine/exchange_areas.h"
#include "engine/state_stream.h"
#include "radiosity.h"

/* What a state begins with: no gaps, this machine's order of bytes. */
struct state_head {
    char name[8], version[16]; /* the library's */
    uint64_t order;            /* of bytes */
    uint64_t scene, oracle;    /* hashes of what it is of */
    double tolerance;
    uint64_t rows, stream;                /* of struct exchange_aim */
    uint64_t elements;                    /* before the first split */
    uint64_t splits, links, queue, lists; /* so many follow */
    uint64_t blocks, values;              /* that are done; 0: none is begun */
    uint64_t pairs, rounds, rays, decided[8];
};

/* A waiting pair, and a list that pairs refer to, which stands behind the first that does. */
struct state_pair {
    uint32_t receiver, emitter, both, list; /* list: from 1, in order; 0: none */
};
struct state_list {
    uint32_t count, handed, covered, face[BLOCKERS_MAX];
};

_Static_assert(sizeof(struct link) == 16 && sizeof(struct state_head) % 8 == 0, "no gaps");

enum { STATE_CHUNK = 4096 }; /* splits, and marks, of a piece */

struct exchange_state {
    const struct RadExchangeState *host; /* borrowed; NULL: nobody wants any, or rank 0 knows */
    struct ranks *ranks;                 /* borrowed */
    int waits, asked; /* on rank 0 there is one to go on from; somebody is to be asked */
    enum RadStateWish wish;
    struct state_head head; /* of this work; once it is read also of that */
    const struct exchange_tree *tree;
    const struct refinement *refinement;
    struct state_in in;
    uint64_t rays;     /* that were cast before this run */
    int stopped;       /* somebody wanted no more */
    const char *cause; /* why what was read is no good, a constant string; NULL: it is, or it was
                          memory that failed */
};

/* For work that this refinement begins, by these; `host` may be NULL. All are borrowed. Of several
 * ranks rank 0's host is asked, and what it reads all are told. */
void exchange_state_open(struct exchange_state *s, const struct RadExchangeState *host,
                         const struct exchange_tree *tree, const struct refinement *refinement,
                         const struct exchange_aim *aim);

/* Read one into a refinement that has not begun. Returns 0, or -1: see `cause`. */
int exchange_state_read(struct exchange_state *s, struct refinement *refinement);

/* Read the values of the first blocks, as far as they were done: into m->values and the blocks'
 * errors. Returns how many blocks; -1: see `cause`. */
int64_t exchange_state_read_values(struct exchange_state *s, const struct exchange_areas *m,
                                   const struct link *const *links);

/* Ask whether a state is wanted, which `wish` is then. Returns nonzero when one is. */
int exchange_state_ask(struct exchange_state *s);

/* Write what is wanted, which rank 0 does; m NULL: between two rounds, else the first blocks are
 * done, and all ranks have them. `lost`: rays cast by this rank for what is not in it, which will
 * be cast again. Returns nonzero when the work is to be put down. */
int exchange_state_put(struct exchange_state *s, const struct exchange_areas *m,
                       const struct link *const *links, size_t blocks, uint64_t lost);

/* How many values a block has; and does a link's block leave them in a state? */
static inline uint64_t exchange_state_values(const struct exchange_block *b)
{
    return (uint64_t)b->rows * b->columns;
}

static inline int exchange_state_keeps(const struct exchange_state *s, const struct link *link)
{
    return !exchange_link_clear(s->tree, link);
}

#endif
