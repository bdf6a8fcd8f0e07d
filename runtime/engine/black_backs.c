/* black_backs.c - see black_backs.h.
 *
 * A face is black behind unless it has two sides: so a surface that is turned the wrong way, as
 * programs export many, takes all light and is seen by none. The solution is right, of a scene that
 * nobody meant. What particles end there is told, and where most do.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "engine/black_backs.h"

/* back[face], of all ranks. */
static struct black_backs sum(const struct scene *scene, const struct tally *tally,
                              const uint64_t *back)
{
    struct black_backs b = {.most = scene->input_count};
    double all = 0, most = 0, polygon = 0;
    for (uint32_t i = 0; i < tally->faces; i++) {
        /* the pieces that a polygon was cut into stand one after the other */
        if (i > 0 && scene->faces[i].input != scene->faces[i - 1].input)
            polygon = 0;
        polygon += (double)back[i];
        all += (double)back[i];
        if (polygon > most) {
            most = polygon;
            b.most = scene->faces[i].input;
        }
    }
    if (all > 0) {
        b.share = all * tally_unit(tally) / REPLICATES / tally->power;
        b.most_share = most / all;
    }
    return b;
}

int black_backs_find(struct black_backs *b, const struct scene *scene, const struct tally *tally,
                     struct ranks *ranks)
{
    *b = (struct black_backs){.most = scene->input_count};
    if (tally->by_paths)
        return 0;
    uint64_t *back = malloc(((size_t)tally->faces + 1) * sizeof *back);
    if (ranks_any(ranks, !back)) {
        free(back);
        return -1;
    }
    for (uint32_t i = 0; i < tally->faces; i++)
        back[i] = (uint64_t)tally->back[i];
    if (tally->quarters) /* each rank has those of what it has traced */
        ranks_add_counts(ranks, RANKS_PARTICLES, back, tally->faces);
    *b = sum(scene, tally, back);
    free(back);
    return 0;
}
