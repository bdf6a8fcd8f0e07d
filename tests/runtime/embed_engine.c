/* embed_engine.c - examples/embed with the engine in the refiner's place: its own text, other
 * names. What the two print must be the same. Usage: embed_engine ORACLE.dag
 * SPDX-License-Identifier: MIT */
#include "oracles.h"
#include "oracle/refiner.h" /* the runtime's; its guard keeps the generated one out */
#include "standalone.h"

#define refiner_element element
#define refiner_segment segment
#define refiner_host host
#define refiner_host_open host_open
#define refiner_discussion discussion
#define refiner_decision decision
#define refiner_bf_guarded_parameters engine_parameters
#define refiner_bf_guarded_defaults engine_defaults
#define refiner_bf_guarded_refine engine_refine
#define REFINER_DECISION_LINK DECISION_LINK
#define REFINER_DECISION_SUBDIVIDE_RECEIVER DECISION_SUBDIVIDE_RECEIVER
#define REFINER_DECISION_SUBDIVIDE_EMITTER DECISION_SUBDIVIDE_EMITTER
#define main embed_main

struct engine_parameters {
    double min_share;
};

static struct refiner *engine;

static void engine_defaults(struct engine_parameters *parameters)
{
    parameters->min_share = 0;
}

/* The interpreter: neither generated nor compiled with the flat release. */
static enum decision engine_refine(const struct engine_parameters *parameters, struct discussion *d)
{
    refiner_set(engine, "min_share", parameters->min_share, NULL);
    return engine->refine(engine->state, d);
}

int embed_main(void);
#include "../../examples/embed/main.c"
#undef main

int main(int count, char **arguments)
{
    int result = 1;
    if (count == 2 && (engine = interpreted(arguments[1], NULL, NULL)) != NULL)
        result = embed_main();
    refiner_close(engine);
    return result;
}
