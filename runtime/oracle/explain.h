/* explain.h - one discussion of an interpreted graph, node by node.
 * SPDX-License-Identifier: MIT */
#ifndef EXPLAIN_H
#define EXPLAIN_H

#include "oracle/refiner.h"
#include "radiosity.h"

struct explanation {
    struct RadExplanation shown; /* points into what follows */
    struct RadAsked *asked;
    struct RadArgument *arguments;
    struct RadTerm *terms;
};

/* Hold the discussion `before`, on a copy, as often as it takes to time it. `real`: the host whose
 * functions answer; its numbers are those of before->host. After follow_open. Returns 0, or -1: out
 * of memory. Names are the refiner's. */
int explain(struct explanation *x, const struct refiner *refiner, const struct discussion *before,
            const struct host *real);
void explain_free(struct explanation *x);

#endif
