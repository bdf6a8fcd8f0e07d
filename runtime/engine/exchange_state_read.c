/* exchange_state_read.c - a state read back, and nothing of it believed (engine/exchange_state.h).
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "engine/exchange_state.h"
#include "util/array.h"

static int refuse(struct exchange_state *s, const char *cause)
{
    s->cause = cause;
    return -1;
}

static const char damaged[] = "it is damaged";

/* Returns 0, or -1 with the cause of what is no success. */
static int judge(struct exchange_state *s, enum state_read result)
{
    return result == STATE_READ     ? 0
           : result == STATE_SHORT  ? refuse(s, "it is cut short")
           : result == STATE_MEMORY ? -1
                                    : refuse(s, damaged);
}

/* Is it a state of this work? `h` takes the place of what the work says of itself. */
static int read_head(struct exchange_state *s)
{
    const struct state_head *own = &s->head;
    struct state_head h = {.name = ""};
    const enum state_read result = state_get(&s->in, &h, sizeof h);
    if (memcmp(h.name, own->name, sizeof h.name) != 0)
        return refuse(s, "it is no state of view factors");
    if (judge(s, result) < 0)
        return -1;
    if (memcmp(h.version, own->version, sizeof h.version) != 0 || h.order != own->order)
        return refuse(s, "it is of another version of this program, or damaged");
    if (judge(s, state_get_check(&s->in)) < 0)
        return -1;
    if (h.scene != own->scene || h.elements != own->elements)
        return refuse(s, "it is of another scene, or of this one with other sides or copies");
    if (memcmp(&h.tolerance, &own->tolerance, sizeof h.tolerance) != 0)
        return refuse(s, "it is of another tolerance");
    if (h.oracle != own->oracle)
        return refuse(s, "it is of another oracle, or of one with other parameters");
    if (h.rows != own->rows || h.stream != own->stream)
        return refuse(s, h.stream      ? "it is of a product, not of a matrix"
                         : own->stream ? "it is of a matrix, not of a product"
                                       : "it is of other rows");
    if ((h.blocks || h.values) && (h.queue || h.stream))
        return refuse(s, damaged);
    s->head = h;
    return 0;
}

/* Split what was split, in the same order, and mark what was marked. */
static int read_elements(struct exchange_state *s, struct refinement *r)
{
    struct hierarchy *h = r->hierarchy;
    uint32_t split[STATE_CHUNK];
    unsigned char mark[STATE_CHUNK];
    for (uint64_t left = s->head.splits; left > 0;) {
        const size_t count = left < STATE_CHUNK ? (size_t)left : STATE_CHUNK;
        if (judge(s, state_get(&s->in, split, count * sizeof *split)) < 0)
            return -1;
        for (size_t i = 0; i < count; i++) {
            const struct element *e = &h->elements[split[i] < h->count ? split[i] : 0];
            if (split[i] >= h->count || e->children || !e->vertices || e->depth >= r->limits.depth)
                return refuse(s, damaged);
            r->deepest = e->depth + 1 > r->deepest ? e->depth + 1 : r->deepest;
            if (hierarchy_split(h, split[i]) < 0)
                return -1;
        }
        left -= count;
    }
    for (size_t from = 0; from < h->count; from += STATE_CHUNK) {
        const size_t count = h->count - from < STATE_CHUNK ? h->count - from : STATE_CHUNK;
        if (judge(s, state_get(&s->in, mark, count)) < 0)
            return -1;
        for (size_t i = 0; i < count; i++) {
            if (mark[i] >= LINK_MARKS)
                return refuse(s, damaged);
            h->elements[from + i].mark = mark[i];
        }
    }
    return 0;
}

/* Do two elements, neither of which is the other, have faces in common, but for those of one face?
 */
static int is_within(const struct hierarchy *h, uint32_t a, uint32_t b)
{
    const struct face_range r = hierarchy_range(h, a), s = hierarchy_range(h, b);
    return r.from != s.from && r.from < s.to && s.from < r.to;
}

static int is_link(const struct hierarchy *h, const struct link *l)
{
    return link_may_be(l, h->count) && h->elements[l->receiver].vertices
           && h->elements[l->emitter].vertices && !is_within(h, l->receiver, l->emitter);
}

static int read_links(struct exchange_state *s, struct refinement *r)
{
    if (judge(s, state_get_array(&s->in, &r->links, s->head.links, sizeof *r->links)) < 0)
        return -1;
    r->link_count = r->link_capacity = (size_t)s->head.links;
    for (size_t i = 0; i < r->link_count; i++)
        if (!is_link(r->hierarchy, &r->links[i]))
            return refuse(s, damaged);
    return 0;
}

/* A list into the next place of the pool: of faces and of groups that stand as one. */
static int read_list(struct exchange_state *s, struct refinement *r)
{
    const struct hierarchy *h = r->hierarchy;
    struct state_list l;
    if (judge(s, state_get(&s->in, &l, sizeof l)) < 0)
        return -1;
    if (l.count > BLOCKERS_TOO_MANY || l.handed > 1 || l.covered > 1)
        return refuse(s, damaged);
    struct pooled *p = &r->pool[r->pool_count];
    *p = (struct pooled){.list = {.count = (int)l.count,
                                  .known = BLOCKERS_INHERITED,
                                  .handed = (unsigned char)l.handed,
                                  .covered = (unsigned char)l.covered}};
    for (uint32_t i = 0; i < l.count && i < BLOCKERS_MAX; i++) {
        if (l.face[i] >= h->built || !h->solid[l.face[i]])
            return refuse(s, damaged);
        p->list.face[i] = l.face[i];
    }
    r->pool_count++;
    return 0;
}

static int read_queue(struct exchange_state *s, struct refinement *r)
{
    const uint32_t elements = r->hierarchy->count;
    for (uint64_t i = 0; i < s->head.queue; i++) {
        struct state_pair p;
        if (judge(s, state_get(&s->in, &p, sizeof p)) < 0)
            return -1;
        const uint32_t next = r->pool_count ? r->pool_count : 1; /* [0] is unused */
        if (p.receiver >= elements || p.emitter >= elements || p.list > next || p.both > 1
            || (p.both && p.receiver == p.emitter))
            return refuse(s, damaged);
        if (array_reserve(&r->queue, r->queue_count + 1, &r->queue_capacity, sizeof *r->queue) < 0)
            return -1;
        if (p.list == next) {
            if (next >= PAIR_LISTS
                || array_reserve(&r->pool, (size_t)next + 1, &r->pool_capacity, sizeof *r->pool)
                       < 0)
                return -1;
            r->pool_count = next;
            if (read_list(s, r) < 0)
                return -1;
        }
        r->queue[r->queue_count++] =
            (struct pair){p.receiver, p.emitter, p.both & 1u, p.list % PAIR_LISTS, 0};
        if (p.list)
            r->pool[p.list].references++;
    }
    const uint64_t lists = r->pool_count ? r->pool_count - 1 : 0;
    return lists == s->head.lists ? 0 : refuse(s, damaged);
}

static int read_end(struct exchange_state *s)
{
    return judge(s, state_get_check(&s->in)) < 0 || judge(s, state_get_end(&s->in)) < 0 ? -1 : 0;
}

/* What rank 0 reads, all are told: the same pieces, so that all refuse it or none does. */
static size_t read_told(void *state, void *bytes, size_t size)
{
    struct exchange_state *s = state;
    uint64_t count = ranks_number(s->ranks) == 0 ? s->host->read(s->host->user, bytes, size) : 0;
    ranks_tell(s->ranks, RANKS_VALUES, &count, sizeof count);
    ranks_tell(s->ranks, RANKS_VALUES, bytes, (size_t)count);
    return (size_t)count;
}

int exchange_state_read(struct exchange_state *s, struct refinement *r)
{
    s->in = (struct state_in){read_told, s, 0};
    if (read_head(s) < 0 || read_elements(s, r) < 0 || read_links(s, r) < 0 || read_queue(s, r) < 0
        || judge(s, state_get_check(&s->in)) < 0 || (!s->head.blocks && read_end(s) < 0))
        return -1;
    r->pairs = s->head.pairs;
    r->rounds = s->head.rounds;
    memcpy(r->decided, s->head.decided, sizeof r->decided);
    s->rays = s->head.rays;
    return 0;
}

static int read_block(struct exchange_state *s, struct exchange_block *b, double *values)
{
    const uint64_t count = exchange_state_values(b);
    if (judge(s, state_get(&s->in, &b->error, sizeof b->error)) < 0
        || judge(s, state_get(&s->in, values, count * sizeof *values)) < 0)
        return -1;
    int good = isfinite(b->error);
    for (uint64_t k = 0; k < count; k++)
        good = good && isfinite(values[k]);
    return good ? 0 : refuse(s, damaged);
}

int64_t exchange_state_read_values(struct exchange_state *s, const struct exchange_areas *m,
                                   const struct link *const *links)
{
    const uint64_t blocks = s->head.blocks;
    uint64_t values = 0;
    for (uint64_t i = 0; i < blocks && i < m->block_count; i++)
        values += exchange_state_keeps(s, links[i]) ? exchange_state_values(&m->blocks[i]) : 0;
    if (blocks > m->block_count || values != s->head.values)
        return refuse(s, damaged);
    for (uint64_t i = 0; i < blocks; i++)
        if (exchange_state_keeps(s, links[i])
            && read_block(s, &m->blocks[i], m->values + m->blocks[i].at) < 0)
            return -1;
    return blocks && read_end(s) < 0 ? -1 : (int64_t)blocks;
}
