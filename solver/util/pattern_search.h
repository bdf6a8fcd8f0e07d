/* pattern_search.h - the least value of a function of a few whole numbers, by steps along each of
 * them. No derivatives, and steps or flat places in the function do no harm.
 * SPDX-License-Identifier: MIT */
#ifndef PATTERN_SEARCH_H
#define PATTERN_SEARCH_H

enum { PATTERN_NUMBERS = 16 };

struct pattern_search {
    int count;                                       /* of numbers, PATTERN_NUMBERS at the most */
    int low[PATTERN_NUMBERS], high[PATTERN_NUMBERS]; /* closed ranges */
    int step;                                        /* the first; the last is 1 */
    int together;    /* 1: all numbers at once are a direction, too, tried before each alone */
    int evaluations; /* places looked at, at the most */
    /* The function; INFINITY: never the least. Asked once for each place. Returns 0, or -1: the
     * search shall stop. */
    int (*value)(void *user, const int *at, double *value);
    void *user;
};

enum pattern_end {
    PATTERN_FOUND,   /* no place a step of 1 away is lower */
    PATTERN_SPENT,   /* `evaluations` are used up */
    PATTERN_STOPPED, /* `value` said so */
    PATTERN_MEMORY   /* out of memory */
};

struct pattern_found {
    enum pattern_end end;
    int at[PATTERN_NUMBERS]; /* the lowest place; where the search began while nothing is known */
    double value;            /* there; INFINITY where nothing is known */
    int evaluations;
};

/* From `start`, which lies in the ranges. */
struct pattern_found pattern_search(const struct pattern_search *search, const int *start);

#endif
