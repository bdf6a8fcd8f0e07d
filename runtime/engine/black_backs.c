/* black_backs.c - see black_backs.h.
 *
 * A face is black behind unless it has two sides: so a surface that is turned the wrong way, as
 * programs export many, takes all light and is seen by none. The solution is right, of a scene that
 * nobody meant. What particles end there is told, and where most do.
 * SPDX-License-Identifier: MIT */
#include "engine/black_backs.h"

struct black_backs black_backs_met(const struct scene *scene, const struct tally *tally)
{
    struct black_backs b = {.most = scene->input_count};
    double all = 0, most = 0, polygon = 0;
    for (uint32_t i = 0; i < tally->faces && !tally->by_paths; i++) {
        /* the pieces that a polygon was cut into stand one after the other */
        if (i > 0 && scene->faces[i].input != scene->faces[i - 1].input)
            polygon = 0;
        polygon += (double)tally->back[i];
        all += (double)tally->back[i];
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
