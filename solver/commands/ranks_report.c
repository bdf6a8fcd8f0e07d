/* ranks_report.c - see ranks_report.h.
 * SPDX-License-Identifier: MIT */
#include "commands/ranks_report.h"

#include <math.h>
#include <stdio.h>

static const char *const traffic_words[RAD_TRAFFICS] = {"splits", "links",     "sweeps",
                                                        "values", "particles", "pairs"};

json_t *ranks_json(const struct RadRank *ranks, int count)
{
    json_t *all = count > 1 ? json_array() : json_null();
    for (int i = 0; i < count && count > 1; i++) {
        const struct RadRank *r = &ranks[i];
        json_t *sent = json_object();
        for (int k = 0; k < RAD_TRAFFICS; k++)
            json_object_set_new(sent, traffic_words[k], json_integer((json_int_t)r->sent[k]));
        json_array_append_new(
            all, json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:f, s:f, s:o}", "links",
                           (json_int_t)r->links, "pairs", (json_int_t)r->pairs, "rays",
                           (json_int_t)r->rays, "faces", (json_int_t)r->faces, "ghosts",
                           (json_int_t)r->ghosts, "named", (json_int_t)r->named, "elements",
                           (json_int_t)r->elements, "memory_mb", r->memory / 1048576, "seconds",
                           r->seconds, "bytes_sent", sent));
    }
    return all;
}

/* Of the rank that has most, over the mean. */
static double imbalance_of(const struct RadRank *ranks, int count, int links)
{
    double all = 0, most = 0;
    for (int i = 0; i < count; i++) {
        const double work = (double)(links ? ranks[i].links : ranks[i].pairs);
        all += work;
        most = fmax(most, work);
    }
    return all > 0 ? most * count / all : 1;
}

void ranks_print(const struct RadRank *ranks, int count)
{
    double sent = 0, memory = 0;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < RAD_TRAFFICS; k++)
            sent += (double)ranks[i].sent[k];
        memory = fmax(memory, ranks[i].memory);
    }
    if (count > 1)
        printf("ranks     %d: %.3g MB sent; the one with most has %.2f times the mean of the "
               "links, %.2f of the pairs; at most %.0f MB each\n",
               count, sent / 1e6, imbalance_of(ranks, count, 1), imbalance_of(ranks, count, 0),
               memory / 1048576);
}
