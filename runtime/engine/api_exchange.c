/* api_exchange.c - exchange areas: the rows of view factors, and what they sum to.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/api.h"
#include "kernel/constants.h"

static int watch(void *context, const struct exchange *x, const char *phase)
{
    const struct refinement *r = &x->refinement;
    const struct RadProgress progress = {phase,
                                         1,
                                         r->rounds,
                                         r->pairs,
                                         r->queue_count,
                                         r->link_count,
                                         x->state.rays + rays_count(x->tree.rays).rays,
                                         0,
                                         x->share};
    return api_progress(context, &progress);
}

static int check_options(RadDevice device, const struct RadExchangeOptions *o)
{
    if (!(o->tolerance >= 0 && o->tolerance < 1))
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadExchangeOptions.tolerance is %g; it takes a number above 0 and below "
                        "1, or 0 for the default",
                        o->tolerance);
    if (o->closure != RAD_CLOSURE_NONE && o->closure != RAD_CLOSURE_ROWS
        && o->closure != RAD_CLOSURE_RECIPROCAL)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RadExchangeOptions.closure takes one of enum RadClosure");
    if (o->closure == RAD_CLOSURE_RECIPROCAL && (o->stream || o->rows))
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "RAD_CLOSURE_RECIPROCAL needs all rows, kept: RadExchangeOptions.rows and "
                        "stream must be 0");
    return 0;
}

/* The built-in viewfactors. NULL when out of memory. */
static struct refiner *default_oracle(double tolerance)
{
    struct refiner *refiner = oracle_open(NULL, "viewfactors", RELEASE_FLAT, NULL);
    if (refiner)
        exchange_set_tolerance(refiner, tolerance);
    return refiner;
}

RadOracle radNewExchangeOracle(RadDevice device, double tolerance)
{
    if (!device)
        return NULL;
    if (check_options(device, &(struct RadExchangeOptions){.tolerance = tolerance}) < 0)
        return NULL;
    return api_oracle(device, default_oracle(tolerance > 0 ? tolerance : EXCHANGE_TOLERANCE));
}

RadExchange radNewExchange(RadScene scene, RadOracle oracle, const struct RadExchangeOptions *given)
{
    static const struct RadExchangeOptions defaults;
    static const enum closure closures[] = {CLOSURE_NONE, CLOSURE_ROWS, CLOSURE_RECIPROCAL};
    const struct RadExchangeOptions *o = given ? given : &defaults;
    const char *cause = "out of memory for exchange areas";
    if (!scene)
        return NULL;
    RadDevice device = scene->device;
    if (!scene->committed) {
        api_fail(device, RAD_ERROR_INVALID_OPERATION, "radCommitScene comes before radNewExchange");
        return NULL;
    }
    if (check_options(device, o) < 0)
        return NULL;
    if (o->rows > scene->scene.input_count) {
        api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                 "RadExchangeOptions.rows is %u; the scene has %u polygons", (unsigned)o->rows,
                 (unsigned)scene->scene.input_count);
        return NULL;
    }
    struct exchange_options options = {.tolerance =
                                           o->tolerance > 0 ? o->tolerance : EXCHANGE_TOLERANCE,
                                       .closure = closures[o->closure],
                                       .threads = device->threads,
                                       .progress = watch,
                                       .context = device,
                                       .rows = o->rows,
                                       .stream = o->stream,
                                       .keep = o->keep,
                                       .state = o->state,
                                       .ranks = device->ranks};
    struct refiner *own = oracle ? NULL : default_oracle(options.tolerance);
    const struct refiner *refiner = oracle ? oracle->refiner : own;
    RadExchange x = refiner ? calloc(1, sizeof *x) : NULL;
    if (!x || exchange_open(&x->exchange, &scene->scene, refiner, &options, &cause) < 0) {
        if (cause)
            api_fail(device,
                     x && x->exchange.refused ? RAD_ERROR_INVALID_ARGUMENT : api_cause(cause), "%s",
                     cause);
        else
            api_fail(device, RAD_ERROR_CANCELLED, "cancelled by the %s function",
                     x->exchange.cancelled ? "progress" : "state's");
        free(x);
        x = NULL;
    } else {
        atomic_init(&x->holders, 1);
        x->scene = scene;
        radRetainScene(scene);
    }
    refiner_close(own);
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

static int check_row(RadExchange x, uint32_t i)
{
    uint32_t count = x->exchange.areas.rows;
    return i < count
               ? 0
               : api_fail(x->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                          "there is no row %u; there are %u, from 0", (unsigned)i, (unsigned)count);
}

double radGetExchangeRow(RadExchange x, uint32_t i, double *row)
{
    if (!x || check_row(x, i) < 0)
        return -1;
    if (x->exchange.areas.refinement)
        return api_fail(x->scene->device, RAD_ERROR_INVALID_OPERATION,
                        "a stream keeps no rows: ask radMultiplyExchange, or set "
                        "RadExchangeOptions.stream to 0");
    if (!row)
        return api_fail(x->scene->device, RAD_ERROR_INVALID_ARGUMENT,
                        "row %u needs a place for %u values", (unsigned)i,
                        (unsigned)x->exchange.areas.inputs);
    return exchange_row(&x->exchange, i, row);
}

int radGetExchangeLoss(RadExchange x, uint32_t i, struct RadExchangeLoss *loss)
{
    if (!x || api_needs(x->scene->device, loss, "radGetExchangeLoss needs a place") < 0
        || check_row(x, i) < 0)
        return -1;
    const struct exchange_loss *l = &x->exchange.losses[i];
    *loss = (struct RadExchangeLoss){l->leaves, l->backs, l->covered};
    return 0;
}

int radMultiplyExchange(RadExchange x, uint32_t columns, const double *in, double *out)
{
    if (!x)
        return -1;
    RadDevice device = x->scene->device;
    if (columns && (!in || !out))
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "a product needs columns and a place");
    if (columns && exchange_multiply(&x->exchange, columns, in, out) < 0)
        return api_fail(device, RAD_ERROR_OUT_OF_MEMORY,
                        "out of memory for a product; fewer "
                        "columns at a time need less");
    return 0;
}

void radGetExchangeReport(RadExchange exchange, struct RadExchangeReport *report)
{
    if (!report)
        return;
    memset(report, 0, sizeof *report);
    if (!exchange)
        return;
    const struct exchange_report *r = &exchange->exchange.report;
    *report = (struct RadExchangeReport){.links = r->links,
                                         .pairs = r->pairs,
                                         .rays = r->rays,
                                         .low = r->low,
                                         .high = r->high,
                                         .rows_closed = r->rows_closed,
                                         .rows_open = r->rows_open,
                                         .rows_backs = r->rows_backs,
                                         .rows_covered = r->rows_covered,
                                         .defect_most = r->defect_most,
                                         .defect_mean = r->defect_mean,
                                         .worst = r->worst,
                                         .worst_row = r->worst_row,
                                         .environment_most = r->environment_most,
                                         .environment_mean = r->environment_mean,
                                         .backs_most = r->backs_most,
                                         .backs_mean = r->backs_mean,
                                         .closure_change = r->closure_change,
                                         .closure_left = r->closure_left,
                                         .entry_error = r->entry_error,
                                         .seconds = {r->seconds.refine, r->seconds.fill}};
}
