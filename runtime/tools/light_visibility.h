/* light_visibility.h - question: how much of the emitter's light arrives, by N rays to its parts in
 * proportion to the power of each? N as in visibility.h; kept as the term `visibility`.
 *
 * What a link ought to bring is F times the mean of V B, not the mean of V times that of B
 * (terms/unevenness.h). Rays whose ends lie by area tell the mean of V, and miss a small bright
 * part; rays whose ends lie by A B tell the visible share of the light itself, so that what is left
 * is noise, which differs in sign from link to link. An end is found by going down the emitter's
 * parts, each with a chance in proportion to its area times its radiosity. Not the same both ways.
 * [importance sampling of the emitter; derived here for links]
 * Fails: within a leaf light is taken as spread evenly; bands count by the largest.
 * SPDX-License-Identifier: MIT */
#ifndef TOOL_LIGHT_VISIBILITY_H
#define TOOL_LIGHT_VISIBILITY_H

#include "discussion.h"
#include "kernel/segments.h"
#include "kernel/surface_point.h"
#include "terms/visibility.h"

/* The part of e that u in [0, 1) chooses; what is left of u goes back to it. Where light is even
 * nothing is gone down, and so parts that this very pass has split off are not seen, whoever came
 * first. */
static inline const struct element *light_visibility_part(const struct element *e,
                                                          const struct element *all, double *u)
{
    while (e->children && e->spread > 0 && all) {
        const struct element *child = &all[e->child];
        double sum = 0;
        int c = 0;
        for (int i = 0; i < e->children; i++)
            sum += child[i].area * child[i].radiosity;
        if (!(sum > 0))
            return e;
        double at = *u * sum;
        for (; c < e->children - 1 && at >= child[c].area * child[c].radiosity; c++)
            at -= child[c].area * child[c].radiosity;
        double part = child[c].area * child[c].radiosity;
        *u = at < part ? at / part : 0.5;
        e = &child[c];
    }
    return e;
}

/* The ends on s lie by A B. */
static inline void light_visibility_ends(struct samples *samples, int batch,
                                         const struct element *s, const struct host *host)
{
    const struct element *elements = host->elements ? *host->elements : NULL;
    for (int i = 0; i < batch; i++) {
        double u = sobol_unit(samples->digit[2][i]), to[3];
        const struct element *part = light_visibility_part(s, elements, &u);
        surface_point(to, part, u, sobol_unit(samples->digit[3][i]));
        for (int k = 0; k < 3; k++)
            samples->to[k][i] = to[k];
    }
    for (int i = batch; i % LANES; i++) /* no numbers there, but read */
        samples->to[0][i] = samples->to[1][i] = samples->to[2][i] = 0;
}

OUTLINE double light_visibility_rays(const struct element *r, const struct element *s,
                                     const struct host *host, int count, int near)
{
    return visibility_among(r, s, host, visibility_choice(r, s, count, near), count,
                            hash64(r->id + 2 * hash64(s->id)), light_visibility_ends);
}

TOOL enum light_visibility_answer tool_light_visibility(struct discussion *d, int rays, int near)
{
    enum visibility_level level = visibility_level_of(rays);
    double v =
        light_visibility_rays(d->receiver, d->emitter, d->host, visibility_rays_of(level), near);
    d->terms.visibility = v;
    d->terms.visibility_level = (unsigned char)level;
    return v <= 0 ? LIGHT_VISIBILITY_NONE : v < 1 ? LIGHT_VISIBILITY_PARTIAL : LIGHT_VISIBILITY_ALL;
}

#endif
