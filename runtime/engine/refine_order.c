/* refine_order.c - elements and links in an order that what was split and linked decides, not who
 * was first.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/refine.h"
#include "util/thread_pool.h"

enum { SORT_SHARES = 8 };

/* Links to be sorted by receiver, in shares: a share's links of a receiver stand behind those of
 * the shares before it. */
struct sorting {
    const struct refinement *r;
    size_t elements, each, shares; /* each: links of a share */
    struct link *sorted;
    size_t *at;                     /* [share][element]: links there are, then where they go */
    uint64_t (*marked)[LINK_MARKS]; /* [share] */
};

static void count_receivers(const void *sorting, size_t from, size_t to)
{
    const struct sorting *s = sorting;
    size_t share = from / s->each, *count = &s->at[share * s->elements];
    for (size_t i = from; i < to; i++) {
        count[s->r->links[i].receiver]++;
        s->marked[share][s->r->links[i].mark]++;
    }
}

static void place_links(const void *sorting, size_t from, size_t to)
{
    const struct sorting *s = sorting;
    size_t *at = &s->at[from / s->each * s->elements];
    for (size_t i = from; i < to; i++)
        s->sorted[at[s->r->links[i].receiver]++] = s->r->links[i];
}

static int by_emitter(const void *a, const void *b)
{
    const struct link *x = a, *y = b;
    return (x->emitter > y->emitter) - (x->emitter < y->emitter);
}

/* Few links are put in order faster one by one. */
static void sort_few(struct link *links, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        const struct link l = links[i];
        size_t k = i;
        for (; k > 0 && links[k - 1].emitter > l.emitter; k--)
            links[k] = links[k - 1];
        links[k] = l;
    }
}

static void sort_emitters(const void *refinement, size_t from, size_t to)
{
    enum { FEW = 24 };
    const struct refinement *r = refinement;
    for (size_t e = from; e < to; e++) {
        struct link *links = r->links + r->first_link[e];
        const size_t count = r->first_link[e + 1] - r->first_link[e];
        if (count <= FEW)
            sort_few(links, count);
        else
            qsort(links, count, sizeof *links, by_emitter);
    }
}

int refinement_settle(struct refinement *r, uint32_t first)
{
    const uint32_t count = r->hierarchy->count;
    uint32_t *place = malloc((size_t)count * sizeof *place);
    int result = place ? hierarchy_settle(r->hierarchy, first, place) : -1;
    for (size_t i = 0; i < r->link_count && result == 0; i++) {
        struct link *l = &r->links[i];
        l->receiver = place[l->receiver];
        l->emitter = place[l->emitter];
    }
    free(place);
    return result;
}

int refinement_sort(struct refinement *r)
{
    uint64_t marked[SORT_SHARES][LINK_MARKS] = {{0}};
    struct sorting s = {.r = r, .elements = r->hierarchy->count, .marked = marked};
    s.shares = r->threads < SORT_SHARES ? (size_t)r->threads : SORT_SHARES;
    s.each = r->link_count / s.shares + 1;
    size_t *first = malloc((s.elements + 1) * sizeof *first), links = 0;
    s.sorted = malloc((r->link_count + 1) * sizeof *s.sorted);
    s.at = calloc(s.shares * s.elements, sizeof *s.at);
    if (!first || !s.sorted || !s.at) {
        free(first);
        free(s.sorted);
        free(s.at);
        return -1;
    }
    thread_pool_run(r->threads, r->link_count, s.each, count_receivers, &s);
    for (size_t e = 0; e < s.elements; e++) {
        first[e] = links;
        for (size_t share = 0; share < s.shares; share++) {
            size_t count = s.at[share * s.elements + e];
            s.at[share * s.elements + e] = links;
            links += count;
        }
    }
    first[s.elements] = links;
    thread_pool_run(r->threads, r->link_count, s.each, place_links, &s);
    memset(r->marked, 0, sizeof r->marked);
    for (size_t share = 0; share < s.shares; share++)
        for (int m = 0; m < LINK_MARKS; m++)
            r->marked[m] += marked[share][m];
    free(s.at);
    free(r->links);
    free(r->first_link);
    r->links = s.sorted;
    r->link_capacity = r->link_count + 1;
    r->first_link = first;
    thread_pool_run(r->threads, s.elements, 1024, sort_emitters, r);
    return 0;
}
