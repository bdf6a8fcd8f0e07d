/* cluster_visibility.wave.h - the tool of that name over a block: a few pairs are in hand at once,
 * whose samples are made together (kernel/cluster_batch.h). When a pair has its segments they are
 * cast, as those of one pair always are, and the next one takes its place.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_CLUSTER_VISIBILITY_WAVE_H
#define TOOL_CLUSTER_VISIBILITY_WAVE_H

#include "wave.h"
#include "kernel/cluster_batch.h"
#include "tools/cluster_visibility.h"

/* A pair joins those in hand, if its rays are not known. */
static inline void cluster_take(struct cluster_wave *w, struct discussion *d, int at, int rays)
{
    struct cluster_pair *p = w->pair[w->hand];
    enum visibility_level level = visibility_level_of(rays);
    level = level < VISIBILITY_RAYS_64 ? level : VISIBILITY_RAYS_64;
    if (d->terms.visibility_level >= level)
        return;
    d->terms.visibility = 0;
    d->terms.visibility_level = (unsigned char)level;
    p->at = at;
    p->cast = visibility_rays_of(level);
    p->count = cluster_made(p->cast);
    p->made = p->tried = 0;
    p->root[0] = p->root[1] = NULL;
    w->hand += cluster_ends_open(&p->ends, d->receiver, d->emitter, d->host);
}

/* Those pairs that have their segments cast them, and make room for others. */
static inline void cluster_finish(struct cluster_wave *w, struct discussion *block,
                                  const uint16_t *at)
{
    for (int j = w->hand - 1; j >= 0; j--) {
        struct cluster_pair *p = w->pair[j];
        struct discussion *d = &block[at[p->at]];
        if (cluster_wanted(p) > 0)
            continue;
        d->terms.visibility =
            cluster_cast(&p->ends, d->host, p->cast, p->made, p->segments, p->weight);
        w->pair[j] = w->pair[--w->hand];
        w->pair[w->hand] = p;
    }
}

/* The tool over a list, in vectors of a width, lanes_width() at the most. */
static inline void cluster_visibility_list(int width, struct discussion *block, const uint16_t *at,
                                           int count, const int *rays, unsigned char *answers)
{
    struct cluster_wave w;
    cluster_wave_open(&w, block[at[0]].host);
    for (int taken = 0; w.hand > 0 || taken < count;) {
        while (taken < count && w.hand < CLUSTER_HAND) {
            cluster_take(&w, &block[at[taken]], taken, rays[taken]);
            taken++;
        }
        cluster_share_out(&w);
        cluster_batch(width, &w);
        cluster_finish(&w, block, at);
    }
    for (int k = 0; k < count; k++)
        answers[k] = (unsigned char)cluster_visibility_of(block[at[k]].terms.visibility);
}

static inline void wave_cluster_visibility(struct discussion *block, const uint16_t *at, int count,
                                           const int *rays, unsigned char *answers)
{
    cluster_visibility_list(lanes_width(), block, at, count, rays, answers);
}

#endif
