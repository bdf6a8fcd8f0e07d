/* pattern_search.c - see pattern_search.h. The pattern search of Hooke and Jeeves, "Direct search"
 * solution of numerical and statistical problems, J. ACM 8, 1961.
 *
 * Each number is tried a step up and a step down, and what lowers the value is kept. If anything
 * did, the same move is made once more, all numbers at once, and tried around there: that is how
 * valleys are followed that lie along no axis. If nothing did, the step is halved. Where one valley
 * is known beforehand, that along which all numbers rise alike, it is a direction as each number
 * is. Places are whole numbers, so that one comes back to places exactly, and each is evaluated
 * once.
 * SPDX-License-Identifier: MIT */
#include "util/pattern_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A place and its value. */
struct place {
    int at[PATTERN_NUMBERS];
    double value;
};

struct run {
    const struct pattern_search *search;
    struct place *seen; /* [found.evaluations] */
    struct pattern_found found;
    /* 1 or -1: the one that lowered the value last, of each number and of all together */
    int direction[PATTERN_NUMBERS + 1];
};

/* Value at a place. Returns 0, or -1: the search is at its end. */
static int look_at(struct run *r, struct place *p)
{
    const struct pattern_search *s = r->search;
    size_t bytes = (size_t)s->count * sizeof *p->at;
    for (int i = 0; i < r->found.evaluations; i++)
        if (memcmp(r->seen[i].at, p->at, bytes) == 0) {
            p->value = r->seen[i].value;
            return 0;
        }
    r->found.end = PATTERN_SPENT;
    if (r->found.evaluations >= s->evaluations)
        return -1;
    r->found.end = PATTERN_STOPPED;
    if (s->value(s->user, p->at, &p->value) < 0)
        return -1;
    r->seen[r->found.evaluations++] = *p;
    if (p->value < r->found.value) {
        r->found.value = p->value;
        memcpy(r->found.at, p->at, bytes);
    }
    return 0;
}

/* Move number i, or all where i is their count. Returns whether they stay in their ranges. */
static int move(const struct pattern_search *s, struct place *p, int i, int by)
{
    int first = i < s->count ? i : 0, last = i < s->count ? i : s->count - 1;
    for (int k = first; k <= last; k++) {
        p->at[k] += by;
        if (p->at[k] < s->low[k] || p->at[k] > s->high[k])
            return 0;
    }
    return 1;
}

/* Go from `p`, whose value is known, to what is lower along each direction in turn. Returns 0, or
 * -1: the search is at its end. */
static int explore(struct run *r, struct place *p, int step)
{
    const struct pattern_search *s = r->search;
    int directions = s->count + (s->together && s->count > 1);
    for (int k = 0; k < directions; k++) {
        int i = directions > s->count ? (k + s->count) % directions : k; /* all, then each */
        for (int turn = 0; turn < 2; turn++) {
            struct place next = *p;
            if (move(s, &next, i, step * r->direction[i])) {
                if (look_at(r, &next) < 0)
                    return -1;
                if (next.value < p->value) {
                    *p = next;
                    break;
                }
            }
            r->direction[i] = -r->direction[i];
        }
    }
    return 0;
}

/* Where the same move leads once more, kept in the ranges. */
static struct place again(const struct pattern_search *s, const struct place *from,
                          const struct place *to)
{
    struct place p = *to;
    for (int i = 0; i < s->count; i++) {
        p.at[i] += to->at[i] - from->at[i];
        p.at[i] = p.at[i] < s->low[i] ? s->low[i] : p.at[i] > s->high[i] ? s->high[i] : p.at[i];
    }
    return p;
}

/* Until no step is left. Returns 0, or -1: the search is at its end. */
static int descend(struct run *r, struct place base)
{
    for (int step = r->search->step; step > 0;) {
        struct place p = base;
        if (explore(r, &p, step) < 0)
            return -1;
        if (!(p.value < base.value)) {
            step /= 2;
            continue;
        }
        while (p.value < base.value) {
            struct place next = again(r->search, &base, &p);
            base = p;
            if (look_at(r, &next) < 0 || explore(r, &next, step) < 0)
                return -1;
            p = next;
        }
    }
    return 0;
}

struct pattern_found pattern_search(const struct pattern_search *search, const int *start)
{
    struct run r = {.search = search, .found = {.value = INFINITY}};
    struct place base = {.value = INFINITY};
    for (int i = 0; i < search->count; i++)
        base.at[i] = r.found.at[i] = start[i];
    for (int i = 0; i <= search->count; i++)
        r.direction[i] = 1;
    r.seen = malloc(((size_t)search->evaluations + 1) * sizeof *r.seen);
    if (!r.seen)
        r.found.end = PATTERN_MEMORY;
    else if (look_at(&r, &base) == 0 && descend(&r, base) == 0)
        r.found.end = PATTERN_FOUND;
    free(r.seen);
    return r.found;
}
