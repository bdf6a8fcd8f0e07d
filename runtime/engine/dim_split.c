/* dim_split.c - see dim_split.h.
 *
 * What a path that starts on a polygon finds there is as wrong as the solution it ends in; behind
 * two doors that is wrong by as much as the polygon. Particles that are split where light is dim
 * (particles.h) have no bias: the solution tells their windows only. They cost more where light is
 * merely weak, for they come from the emitters all the way, so they come last; but they serve all
 * polygons at once. How much they do not know, replicates say.
 *
 * Windows are of each band by itself. Walls that reflect blue alone, in red light and a little of
 * blue, are as bright as any by all light together; what is left of a red particle there, a blue
 * one, was then one of few that carried as much as others.
 *
 * A room that no light reaches but that of its own lamp, beside one that is a billion times as
 * strong, was known to a sixth of its light: particles of its lamp were as few as what they could
 * carry at the least, a millionth, and links, which were right to 3 %, made room for them. So that
 * least is what holds for light that comes from elsewhere, and a lamp is asked for as many as any
 * other, however weak it is.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/dim_split.h"
#include "kernel/constants.h"

enum { START = 64 }; /* particles of each replicate, which tell how many rays one takes */

/* Random numbers that nothing else takes. */
enum { DIM_STREAM = 0x73706c };

/* What they say by now. */
static void note(struct dim_faces *d, const struct tally *split)
{
    const uint32_t bands = d->tracer->bands;
    for (uint32_t j = 0; j < d->count; j++) {
        struct dim_polygon *p = &d->polygon[j];
        double sum[REPLICATES];
        dim_count_replicates(d, split, p, sum);
        p->split_light = dim_light_of(sum, &p->split_variance);
        for (uint32_t k = 0; k < bands; k++) {
            p->split[k] = 0;
            for (uint32_t i = p->from; i < p->to; i++)
                for (int r = 0; r < REPLICATES; r++)
                    p->split[k] += tally_face(split, r, d->face[i], k) / (REPLICATES * p->area);
        }
    }
}

/* Of the watch's whole, what has been done before and what is done now. */
struct stretch {
    const struct watch *watch;
    double from, to;
};

static int tell(void *context, double share)
{
    const struct stretch *s = context;
    return s->watch->tell(s->watch->context, fmin(s->from + share * (s->to - s->from), 1));
}

int dim_split_trace(struct dim_faces *d, const float *window, double rays,
                    int (*sure)(const struct dim_faces *d), struct tally *split)
{
    struct stretch stretch = {.watch = d->watch};
    const struct watch watch = {tell, &stretch};
    double more = START;
    int times = 0; /* in succession that all were sure */
    int failed = tally_open(split, d->tracer, DIM_STREAM, 1) < 0
                 || tally_split(split, d->tracer, window, DIM_LEAST, rays) < 0;
    while (!failed && more >= 1) {
        failed = tally_trace(split, d->tracer, (uint64_t)more, d->watch ? &watch : NULL) < 0;
        note(d, split);
        double each = (double)split->rays / (double)split->particles;
        more = fmin((rays - (double)split->rays) / each, (double)split->particles);
        /* once may be by chance: of so few replicates one in ten tells noise a quarter too small */
        times = sure(d) ? times + 1 : 0;
        if (times == 2)
            break;
        stretch.from = stretch.to;
        stretch.to = ((double)split->rays + more * each) / rays;
    }
    *d->rays += split->rays;
    return failed ? -1 : 0;
}
