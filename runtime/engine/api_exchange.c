/* api_exchange.c - exchange areas: the rows of view factors, and what they sum to.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/api.h"
#include "engine/exchange.h"
#include "kernel/constants.h"
#include "oracle/oracles.h"

struct RadExchangeObject {
    atomic_int holders;
    RadScene scene;
    struct exchange exchange;
};

static int watch_exchange(void *context, const struct exchange *x, const char *phase)
{
    const struct refinement *r = &x->refinement;
    const struct RadProgress progress = { phase, 1, r->rounds, r->pairs, r->queue_count, r->link_count, rays_count(x->tree.rays).rays, 0 };
    return api_progress(context, &progress);
}

static struct refiner *default_oracle(double tolerance)
{
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    if (refiner)
        exchange_set_tolerance(refiner, tolerance);
    return refiner;
}

RadExchange radNewExchange(RadScene scene, RadOracle oracle, const struct RadExchangeOptions *given)
{
    static const struct RadExchangeOptions defaults;
    const struct RadExchangeOptions *o = given ? given : &defaults;
    const char *cause = "out of memory for exchange areas; a larger tolerance needs less";
    if (!scene)
        return NULL;
    RadDevice device = scene->device;
    if (!scene->committed) {
        api_fail(device, RAD_ERROR_INVALID_OPERATION, "radCommitScene comes before radNewExchange");
        return NULL;
    }
    if (!(o->tolerance >= 0 && o->tolerance < 1)) {
        api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "RadExchangeOptions.tolerance is %g; it takes a number above 0 and below 1, or 0 for the default", o->tolerance);
        return NULL;
    }
    if (o->closure != RAD_CLOSURE_NONE && o->closure != RAD_CLOSURE_ROWS && o->closure != RAD_CLOSURE_RECIPROCAL) {
        api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "RadExchangeOptions.closure takes one of enum RadClosure");
        return NULL;
    }
    double tolerance = o->tolerance > 0 ? o->tolerance : EXCHANGE_TOLERANCE;
    const struct exchange_options options = { tolerance, (enum closure)o->closure, device->threads, watch_exchange, device };
    struct refiner *own = oracle ? NULL : default_oracle(tolerance);
    RadExchange x = calloc(1, sizeof *x);
    int failed = !x || !(oracle || own) || exchange_open(&x->exchange, &scene->scene, oracle ? oracle->refiner : own, &options, &cause) < 0;
    refiner_close(own);
    if (failed) {
        if (cause)
            api_fail(device, api_cause(cause), "%s", cause);
        else
            api_fail(device, RAD_ERROR_CANCELLED, "cancelled by the progress function");
        free(x);
        return NULL;
    }
    atomic_init(&x->holders, 1);
    x->scene = scene;
    radRetainScene(scene);
    return x;
}

void radRetainExchange(RadExchange exchange)
{
    if (exchange)
        atomic_fetch_add(&exchange->holders, 1);
}

void radReleaseExchange(RadExchange x)
{
    if (!x || atomic_fetch_sub(&x->holders, 1) != 1)
        return;
    exchange_close(&x->exchange);
    radReleaseScene(x->scene);
    free(x);
}

double radGetExchangeRow(RadExchange x, uint32_t i, double *row)
{
    if (!x)
        return -1;
    uint32_t rows = x->exchange.areas.inputs;
    if (i >= rows || !row)
        return api_fail(x->scene->device, RAD_ERROR_INVALID_ARGUMENT, row ? "there is no row %u; there are %u, from 0" : "row %u of %u needs a place to go to",
                        (unsigned)i, (unsigned)rows);
    return exchange_row(&x->exchange, i, row);
}

/* The engine's report, under the interface's name. */
_Static_assert(sizeof(struct RadExchangeReport) == sizeof(struct exchange_report)
               && offsetof(struct RadExchangeReport, seconds) == offsetof(struct exchange_report, seconds), "one report under two names");
_Static_assert((int)RAD_CLOSURE_ROWS == CLOSURE_ROWS && (int)RAD_CLOSURE_RECIPROCAL == CLOSURE_RECIPROCAL, "one enum under two names");

void radGetExchangeReport(RadExchange exchange, struct RadExchangeReport *report)
{
    if (!report)
        return;
    memset(report, 0, sizeof *report);
    if (exchange)
        memcpy(report, &exchange->exchange.report, sizeof *report);
}
