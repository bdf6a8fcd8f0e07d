/* collocation.c - form factors of links from the receiver's centre.
 *
 * Galerkin's projection keeps of the irradiance on an element its mean, and a link's form factor is
 * the mean over the receiver. Collocation keeps its value at one point, the centre: the form factor
 * is the one from there, times the same V, which stays the receiver's mean. A link to an element
 * that is divided gathers at the centre of that element and is pushed down as constant: where the
 * oracle found a link good enough for the whole element, one point speaks for it, as one mean does.
 * Links of clusters bring light to each face at its centre (separable_links.h).
 *
 * The oracle decides, and links are discussed again, by the means that links hold: graphs do not
 * know of projections. So the links are the same for both at first, and differ later as the light
 * does that the oracle sees.
 *
 * Fails where the centre is no fair sample: under a lamp that is small against the receiver.
 * [Arvo et al. 1994, sections 4.2 and 5.2]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "engine/collocation.h"
#include "kernel/point_factor.h"
#include "util/thread_pool.h"

static void take_centres(const void *operator, size_t from, size_t to)
{
    const struct light_operator *op = operator;
    const struct element *elements = op->hierarchy->elements;
    for (size_t i = from; i < to; i++) {
        const struct link *link = &op->refinement->links[i];
        const struct element *r = &elements[link->receiver], *s = &elements[link->emitter];
        op->collocated[i] =
            r->vertices && s->vertices ? (float)point_factor(r, s) : link->form_factor;
    }
}

int collocation_update(struct light_operator *op)
{
    const struct refinement *r = op->refinement;
    if (op->problem->options.projection != RAD_PROJECTION_COLLOCATION)
        return 0;
    free(op->collocated);
    op->collocated = malloc((r->link_count + 1) * sizeof *op->collocated);
    if (!op->collocated)
        return -1;
    thread_pool_run(op->problem->options.threads, r->link_count, 1024, take_centres, op);
    return 0;
}
