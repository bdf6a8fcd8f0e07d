/* solve_tracer.h - what light paths are traced through: the scene of a solve.
 * SPDX-License-Identifier: MIT */
#ifndef SOLVE_TRACER_H
#define SOLVE_TRACER_H

#include "engine/solve.h"
#include "particles/tracer.h"

/* To be opened by tracer_open; it borrows from the solve. */
static inline struct tracer solve_tracer(const struct solve *s)
{
    return (struct tracer){.hierarchy = &s->hierarchy,
                           .quarters = &s->quarters,
                           .rays = s->problem.rays,
                           .exitance = s->problem.exitance,
                           .reflectance = s->problem.reflectance,
                           .bands = s->problem.bands,
                           .threads = s->problem.options.threads,
                           .ranks = s->problem.options.ranks,
                           .owner = s->operator.shares.owner,
                           .stretch = s->operator.shares.stretch };
}

#endif
