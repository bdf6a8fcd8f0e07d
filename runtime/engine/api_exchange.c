/* api_exchange.c - exchange areas: the rows of view factors, and what they sum to.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/api.h"
#include "engine/exchange_closure.h"
#include "oracle/oracles.h"
#include "util/clock.h"

/* The tolerance that the defaults of oracle viewfactors are made for. */
#define MEANT 3e-4
#define NEAR 2.5

struct RadExchangeObject {
    atomic_int holders;
    RadScene scene;
    const char *phase;
    int cancelled;
    struct factor_tree tree;
    struct refinement refinement;
    struct factor_matrix matrix;
    struct factor_closure closure;
    struct factor_sky *sky; /* [inputs] */
    double *sums;           /* [inputs]: of the rows before closure, m2 */
    struct RadExchangeReport report;
};

static int watch(void *context, const struct refinement *r)
{
    struct RadExchangeObject *x = context;
    const struct RadProgress progress = { x->phase, 1, r->rounds, r->pairs, r->queue_count, r->link_count, rays_count(x->tree.rays).rays, 0 };
    x->cancelled |= api_progress(x->scene->device, &progress) != 0;
    return x->cancelled;
}

/* The oracle's limits for another tolerance: the error of half shadow falls with what is left to it. */
static struct refiner *default_oracle(double tolerance)
{
    struct refiner *refiner = oracle_open(NULL, "viewfactors", RELEASE_FLAT, NULL);
    for (int i = 0; refiner && i < refiner->parameter_count; i++) {
        const char *name = refiner->parameters[i].name;
        if (strcmp(name, "shadow") == 0 || strcmp(name, "group_shadow") == 0)
            (void)refiner_set(refiner, name, refiner_get(refiner, i) * tolerance / MEANT, NULL);
    }
    return refiner;
}

static int refine(RadExchange x, RadOracle oracle, double tolerance)
{
    struct refiner *own = oracle ? NULL : default_oracle(tolerance);
    const struct refiner *refiner = oracle ? oracle->refiner : own;
    int status = -1;
    x->phase = "refine";
    if (refiner && refinement_open(&x->refinement, &x->tree.h, &x->tree.host, refiner, x->scene->device->threads) == 0) {
        x->refinement.watch = watch;
        x->refinement.watch_context = x;
        status = refinement_start(&x->refinement);
    }
    refiner_close(own);
    return status;
}

/* Row sums, and what becomes of the light that rows lack. */
static int take_account(RadExchange x, const struct RadExchangeOptions *o, double tolerance)
{
    struct RadExchangeReport *r = &x->report;
    uint32_t n = x->matrix.inputs;
    double *share = malloc((n + 1) * sizeof *share), all = 0;
    x->sums = malloc((n + 1) * sizeof *x->sums);
    x->sky = calloc(n + 1, sizeof *x->sky);
    if (!share || !x->sums || !x->sky) {
        free(share);
        return -1;
    }
    factor_matrix_sums(&x->matrix, NULL, x->sums);
    for (uint32_t i = 0; i < n; i++)
        share[i] = x->matrix.area[i] > 0 ? x->sums[i] / x->matrix.area[i] : 1;
    factor_sky_ask(x->sky, &x->matrix, share, o->closure == RAD_CLOSURE_NONE ? tolerance : 0, x->scene->device->threads);
    r->low = INFINITY;
    for (uint32_t i = 0; i < n; i++) {
        const struct factor_sky *sky = &x->sky[i];
        double defect = fabs(1 - share[i]);
        if (!(x->matrix.area[i] > 0))
            continue;
        all += x->matrix.area[i];
        r->low = fmin(r->low, share[i]);
        r->high = fmax(r->high, share[i]);
        if (factor_sky_closed(sky)) {
            r->rows_closed++;
            r->defect_mean += defect;
            r->defect_most = fmax(r->defect_most, defect);
        } else if (sky->leaves > 0 || sky->lost > 0) {
            double lacks = fmax(1 - share[i] - (double)sky->buried, 0);
            r->rows_open++;
            r->environment_mean += x->matrix.area[i] * lacks;
            r->environment_most = fmax(r->environment_most, lacks);
        } else {
            r->rows_covered++;
        }
    }
    r->defect_mean /= r->rows_closed ? r->rows_closed : 1;
    r->environment_mean /= all > 0 ? all : 1;
    free(share);
    return 0;
}

static int compute(RadExchange x, RadOracle oracle, const struct RadExchangeOptions *o)
{
    static const enum factor_closure_kind kinds[] = { FACTOR_CLOSURE_NONE, FACTOR_CLOSURE_ROWS, FACTOR_CLOSURE_RECIPROCAL };
    double tolerance = o->tolerance > 0 ? o->tolerance : MEANT, start = seconds(), middle;
    /* Pairs nearer than so many radii are integrated exactly. The error of others falls with the fourth power of distance. */
    double near = fmax(NEAR * pow(MEANT / tolerance, 0.25), 1.5);
    if (refine(x, oracle, tolerance) < 0)
        return -1;
    middle = seconds();
    x->report.seconds.refine = middle - start;
    x->phase = "factors";
    if (watch(x, &x->refinement) != 0)
        return -1;
    if (factor_matrix_open(&x->matrix, &x->tree, &x->scene->scene, &x->refinement, near, x->scene->device->threads) < 0
        || take_account(x, o, tolerance) < 0 || factor_closure_make(&x->closure, kinds[o->closure], &x->matrix, x->sums, x->sky) < 0)
        return -1;
    x->report.seconds.fill = seconds() - middle;
    x->report.links = x->matrix.link_count;
    x->report.pairs = x->matrix.value_count;
    x->report.rays = rays_count(x->tree.rays).rays;
    x->report.closure_change = x->closure.most;
    x->report.closure_left = x->closure.left;
    return 0;
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
    RadExchange x = calloc(1, sizeof *x);
    if (!x) {
        api_fail(device, RAD_ERROR_OUT_OF_MEMORY, "%s", cause);
        return NULL;
    }
    atomic_init(&x->holders, 1);
    x->scene = scene;
    radRetainScene(scene);
    if (factor_tree_open(&x->tree, scene->scene.faces, scene->scene.face_count, device->threads, &cause) < 0 || compute(x, oracle, o) < 0) {
        if (x->cancelled)
            api_fail(device, RAD_ERROR_CANCELLED, "cancelled by the progress function");
        else
            api_fail(device, api_cause(cause), "%s", cause);
        radReleaseExchange(x);
        return NULL;
    }
    refinement_close(&x->refinement);
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
    free(x->sums);
    free(x->sky);
    factor_closure_free(&x->closure);
    factor_matrix_close(&x->matrix);
    refinement_close(&x->refinement);
    factor_tree_close(&x->tree);
    radReleaseScene(x->scene);
    free(x);
}

double radGetExchangeRow(RadExchange x, uint32_t i, double *row)
{
    if (!x)
        return -1;
    if (i >= x->matrix.inputs || !row)
        return api_fail(x->scene->device, RAD_ERROR_INVALID_ARGUMENT, row ? "there is no row %u; there are %u, from 0" : "row %u of %u needs a place to go to",
                        (unsigned)i, (unsigned)x->matrix.inputs);
    const struct factor_closure *c = &x->closure;
    double sum = 0;
    memset(row, 0, x->matrix.inputs * sizeof *row);
    if (!(x->matrix.area[i] > 0))
        return 0;
    double scale = (c->scale && !c->both ? c->scale[i] : 1) / x->matrix.area[i];
    (void)factor_matrix_row(&x->matrix, i, c->both ? c->scale : NULL, row);
    for (uint32_t j = 0; j < x->matrix.inputs; j++) {
        row[j] = fmin(row[j] * scale, 1);
        sum += row[j];
    }
    return sum;
}

void radGetExchangeReport(RadExchange exchange, struct RadExchangeReport *report)
{
    if (!report)
        return;
    memset(report, 0, sizeof *report);
    if (exchange)
        *report = exchange->report;
}
