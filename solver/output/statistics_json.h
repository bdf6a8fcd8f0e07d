/* statistics_json.h - the statistics of a graph as JSON, schema radiosity-statistics/1.
 * SPDX-License-Identifier: MIT */
#ifndef STATISTICS_JSON_H
#define STATISTICS_JSON_H

#include <jansson.h>
#include <math.h>
#include "radiosity.h"

#define STATISTICS_SCHEMA "radiosity-statistics/1"

/* `scene`: the file's name. The caller's; NULL: out of memory. */
json_t *statistics_json(const char *scene, RadOracle oracle, const struct RadStatistics *s);

/* A node's share: of a part in a whole, 0 where there is none. */
static inline double share_of(double part, double whole)
{
    return whole > 0 ? part / whole : 0;
}

/* Where bin i of a histogram begins: bins go by powers of two, half of them below 1. */
static inline double statistics_bin(int i)
{
    return ldexp(1, i - RAD_BINS / 2);
}

/* What a path ends with. */
static inline const char *statistics_decision(const struct RadStatistics *s,
                                              const struct RadPath *p)
{
    const int last = p->length - 1;
    return last < 0 ? "" : s->nodes[p->nodes[last]].answers[p->answers[last]].target;
}

/* Seconds, or rays, of all nodes together. */
static inline double statistics_seconds(const struct RadStatistics *s)
{
    double sum = 0;
    for (int i = 0; i < s->node_count; i++)
        sum += s->nodes[i].seconds;
    return sum;
}

static inline uint64_t statistics_rays(const struct RadStatistics *s)
{
    uint64_t sum = 0;
    for (int i = 0; i < s->node_count; i++)
        sum += s->nodes[i].rays;
    return sum;
}

#endif
