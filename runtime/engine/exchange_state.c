/* exchange_state.c - see exchange_state.h.
 * SPDX-License-Identifier: MIT */
#include "engine/exchange_state.h"

#include <stdlib.h>
#include <string.h>

#include "engine/state_identity.h"

static const char NAME[8] = "radvf1";
static const uint64_t ORDER = 0x0102030405060708u;

void exchange_state_open(struct exchange_state *s, const struct RadExchangeState *host,
                         const struct exchange_tree *tree, const struct refinement *refinement,
                         const struct exchange_aim *aim)
{
    memset(s, 0, sizeof *s);
    s->host = host;
    s->tree = tree;
    s->refinement = refinement;
    s->ranks = aim->ranks;
    s->waits = host && host->read;
    s->asked = host && host->asked;
    ranks_tell(s->ranks, RANKS_VALUES, &s->waits, sizeof s->waits);
    ranks_tell(s->ranks, RANKS_VALUES, &s->asked, sizeof s->asked);
    if (!s->waits && !s->asked)
        return;
    struct state_head *h = &s->head;
    memcpy(h->name, NAME, sizeof h->name);
    strncpy(h->version, RADIOSITY_VERSION, sizeof h->version - 1);
    h->order = ORDER;
    h->scene = state_identity_faces(&tree->h);
    h->oracle = state_identity_oracle(refinement->refiner);
    h->tolerance = aim->tolerance;
    h->rows = aim->rows;
    h->stream = aim->stream != 0;
    h->elements = tree->h.count;
}

/* ---- writing */

static size_t splits_of(const struct refinement *r)
{
    return (r->hierarchy->count - r->built) / 4;
}

/* Number the lists that waiting pairs refer to as they come: number[pool_count]. */
static uint32_t number_lists(const struct refinement *r, uint32_t *number)
{
    uint32_t count = 0;
    memset(number, 0, (r->pool_count + (size_t)1) * sizeof *number);
    for (size_t i = 0; i < r->queue_count; i++)
        if (r->queue[i].list && !number[r->queue[i].list])
            number[r->queue[i].list] = ++count;
    return count;
}

static void put_list(struct state_out *out, const struct blockers *b)
{
    struct state_list l = {(uint32_t)b->count, b->handed, b->covered, {0}};
    const size_t held = b->count < BLOCKERS_MAX ? (size_t)b->count : BLOCKERS_MAX;
    memcpy(l.face, b->face, held * sizeof *l.face);
    state_put(out, &l, sizeof l);
}

/* The pairs that wait; each list stands behind the first pair that refers to it. */
static void put_queue(struct state_out *out, const struct refinement *r, const uint32_t *number)
{
    uint32_t seen = 0;
    for (size_t i = 0; i < r->queue_count; i++) {
        const struct pair *p = &r->queue[i];
        const struct state_pair q = {p->receiver, p->emitter, p->both,
                                     p->list ? number[p->list] : 0};
        state_put(out, &q, sizeof q);
        if (q.list > seen)
            put_list(out, &r->pool[p->list].list);
        seen = q.list > seen ? q.list : seen;
    }
}

/* Which element each split was of, and what elements are marked with. */
static void put_elements(struct state_out *out, const struct refinement *r)
{
    const struct hierarchy *h = r->hierarchy;
    uint32_t split[STATE_CHUNK];
    unsigned char mark[STATE_CHUNK];
    size_t splits = splits_of(r);
    for (size_t from = 0; from < splits; from += STATE_CHUNK) {
        const size_t count = splits - from < STATE_CHUNK ? splits - from : STATE_CHUNK;
        for (size_t i = 0; i < count; i++)
            split[i] = h->elements[r->built + 4 * (from + i)].parent;
        state_put(out, split, count * sizeof *split);
    }
    for (size_t from = 0; from < h->count; from += STATE_CHUNK) {
        const size_t count = h->count - from < STATE_CHUNK ? h->count - from : STATE_CHUNK;
        for (size_t i = 0; i < count; i++)
            mark[i] = (unsigned char)h->elements[from + i].mark;
        state_put(out, mark, count);
    }
}

static void put_values(struct state_out *out, const struct exchange_state *s,
                       const struct exchange_areas *m, const struct link *const *links,
                       size_t blocks)
{
    for (size_t i = 0; i < blocks; i++) {
        const struct exchange_block *b = &m->blocks[i];
        if (!exchange_state_keeps(s, links[i]))
            continue;
        state_put(out, &b->error, sizeof b->error);
        state_put(out, m->values + b->at, exchange_state_values(b) * sizeof *m->values);
    }
}

/* Write all of it. Without the memory for that the host hears of no end, as where it fails itself.
 */
static void write_state(struct exchange_state *s, const struct exchange_areas *m,
                        const struct link *const *links, size_t blocks, uint64_t rays)
{
    const struct refinement *r = s->refinement;
    uint32_t *number = malloc((r->pool_count + (size_t)1) * sizeof *number);
    struct state_out *out = malloc(sizeof *out);
    struct state_head head = s->head;
    if (number && out) {
        *out = (struct state_out){.write = s->host->write, .user = s->host->user};
        head.lists = number_lists(r, number);
        head.splits = splits_of(r);
        head.links = r->link_count;
        head.queue = r->queue_count;
        head.blocks = blocks;
        head.values = 0;
        for (size_t i = 0; i < blocks; i++)
            head.values +=
                exchange_state_keeps(s, links[i]) ? exchange_state_values(&m->blocks[i]) : 0;
        head.pairs = r->pairs;
        head.rounds = r->rounds;
        head.rays = s->rays + rays;
        memcpy(head.decided, r->decided, sizeof head.decided);
        state_put(out, &head, sizeof head);
        state_put_check(out);
        put_elements(out, r);
        state_put(out, r->links, r->link_count * sizeof *r->links);
        put_queue(out, r, number);
        state_put_check(out);
        put_values(out, s, m, links, blocks);
        state_put_check(out);
        if (state_put_end(out) == 0)
            (void)s->host->write(s->host->user, NULL, 0);
    }
    free(number);
    free(out);
}

int exchange_state_ask(struct exchange_state *s)
{
    s->wish = RAD_STATE_NONE;
    if (!s->asked)
        return 0;
    if (ranks_number(s->ranks) == 0)
        s->wish = s->host->asked(s->host->user);
    ranks_tell(s->ranks, RANKS_VALUES, &s->wish, sizeof s->wish);
    return s->wish != RAD_STATE_NONE;
}

int exchange_state_put(struct exchange_state *s, const struct exchange_areas *m,
                       const struct link *const *links, size_t blocks, uint64_t lost)
{
    uint64_t rays = rays_count(s->tree->rays).rays - lost;
    ranks_add_counts(s->ranks, RANKS_VALUES, &rays, 1);
    if (ranks_number(s->ranks) == 0 && s->host->write)
        write_state(s, m, links, blocks, rays);
    s->stopped = s->wish == RAD_STATE_STOP;
    return s->stopped;
}
