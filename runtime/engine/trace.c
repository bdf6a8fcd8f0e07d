/* trace.c - see trace.h.
 * SPDX-License-Identifier: MIT */
#include "engine/trace.h"
#include "oracle/counted_host.h"
#include "oracle/follow.h"

enum decision trace_ask(struct traced_pair *out, int turned, const struct refiner *refiner,
                        struct discussion *d)
{
    const struct host *real = d->host;
    struct counted_host host;
    counted_host_make(&host, real, real);
    d->host = &host.host;
    enum decision decision = follow_ask(refiner, d, &out->way[turned]);
    d->host = real;
    out->form_factor[turned] = d->terms.form_factor;
    out->form_factor_level[turned] = d->terms.form_factor_level;
    out->visibility[turned] = d->terms.visibility;
    out->visibility_level[turned] = d->terms.visibility_level;
    out->rays[turned] = (uint32_t)host.rays;
    return decision;
}

int trace_tell(struct trace *trace, const struct refinement *r, size_t i, int turned,
               const struct link *before, const struct blockers *list)
{
    const struct traced_pair *t = &trace->pairs[i];
    const struct element *elements = r->hierarchy->elements;
    struct blockers copy = *list;
    struct discussion d = {.receiver = &elements[before->receiver],
                           .emitter = &elements[before->emitter],
                           .host = r->host,
                           .blockers = &copy};
    link_recall(before, &d.terms);
    const struct RadTraced told = {.pass = trace->pass,
                                   .round = r->rounds + 1,
                                   .receiver = before->receiver,
                                   .emitter = before->emitter,
                                   .before = &d,
                                   .decision = (enum decision)r->outcomes[i].decision[turned],
                                   .way = t->way[turned],
                                   .rays = t->rays[turned],
                                   .form_factor = t->form_factor[turned],
                                   .visibility = t->visibility[turned],
                                   .form_factor_level = t->form_factor_level[turned],
                                   .visibility_level = t->visibility_level[turned]};
    trace->stopped |= trace->tell(trace->user, &told) != 0;
    return trace->stopped ? -1 : 0;
}
