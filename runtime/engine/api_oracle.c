/* api_oracle.c - oracles: built in, from a file or a text, compiled into the program, or registered by hand.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "engine/api.h"
#include "oracle/builtin.h"
#include "oracle/oracles.h"

const char *const *radGetOracleNames(void)
{
    return builtin_names;
}

const char *radGetDefaultOracle(void)
{
    return DEFAULT_ORACLE;
}

static const struct builtin *find_builtin(const char *name)
{
    for (const struct builtin *b = builtins; b->name; b++)
        if (strcmp(b->name, name) == 0)
            return b;
    return NULL;
}

static const struct oracle *find_hand(RadDevice device, const char *name)
{
    const struct oracle *found = NULL;
    pthread_mutex_lock(&device->lock);
    for (int i = 0; i < device->hand_count && !found; i++)
        if (strcmp(device->hand[i]->name, name) == 0)
            found = device->hand[i];
    pthread_mutex_unlock(&device->lock);
    return found;
}

int radRegisterOracle(RadDevice device, const struct oracle *oracle)
{
    int status = 0;
    if (!device)
        return -1;
    if (!oracle || !oracle->name || !oracle->refine || !oracle->defaults)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "an oracle to register needs a name, defaults and a refine function");
    if (oracle->abi != RUNTIME_ABI)
        return api_fail(device, RAD_ERROR_INVALID_ORACLE, "oracle %s was compiled against ABI %d, not %d; compile it anew", oracle->name, oracle->abi, RUNTIME_ABI);
    pthread_mutex_lock(&device->lock);
    const struct oracle **more = realloc(device->hand, (size_t)(device->hand_count + 1) * sizeof *more);
    if (more) {
        device->hand = more;
        device->hand[device->hand_count++] = oracle;
    } else {
        status = -1;
    }
    pthread_mutex_unlock(&device->lock);
    return status < 0 ? api_fail(device, RAD_ERROR_OUT_OF_MEMORY, "out of memory") : 0;
}

int radHasOracle(RadDevice device, const char *name, enum RadRelease release)
{
    if (!device || !name)
        return 0;
    return release == RAD_RELEASE_HAND ? find_hand(device, name) != NULL : find_builtin(name) != NULL;
}

/* Takes the refiner over; NULL is out of memory. */
static RadOracle make_oracle(RadDevice device, struct refiner *refiner)
{
    RadOracle oracle = refiner ? calloc(1, sizeof *oracle) : NULL;
    if (!oracle) {
        refiner_close(refiner);
        api_fail(device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for an oracle");
        return NULL;
    }
    atomic_init(&oracle->holders, 1);
    oracle->device = device;
    oracle->refiner = refiner;
    radRetainDevice(device);
    return oracle;
}

RadOracle radNewOracle(RadDevice device, const char *name, enum RadRelease release)
{
    if (!device)
        return NULL;
    if (!name || (release != RAD_RELEASE_HAND && !find_builtin(name))) {
        api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "there is no built-in oracle '%s'; radGetOracleNames tells those that there are", name ? name : "");
        return NULL;
    }
    if (release == RAD_RELEASE_HAND) {
        const struct oracle *hand = find_hand(device, name);
        if (hand)
            return make_oracle(device, refiner_compiled(hand, "hand"));
        api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "no hand-written release of oracle '%s' has been registered", name);
        return NULL;
    }
    if (release != RAD_RELEASE_FLAT && release != RAD_RELEASE_DAG) {
        api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "%d is no release", (int)release);
        return NULL;
    }
    return make_oracle(device, oracles_open(name, release == RAD_RELEASE_DAG ? RELEASE_DAG : RELEASE_FLAT));
}

/* The DAG release; what is wrong with the graph becomes the device's error. */
static RadOracle interpret(RadDevice device, const char *path, const char *text, const char *name)
{
    char *said = NULL;
    size_t length = 0;
    FILE *errors = open_memstream(&said, &length);
    RadOracle oracle = NULL;
    if (!errors) {
        api_fail(device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for an oracle");
        return NULL;
    }
    struct refiner *refiner = refiner_interpreted(path, text, name, errors);
    fclose(errors);
    while (length > 0 && said[length - 1] == '\n')
        said[--length] = 0;
    if (refiner)
        oracle = make_oracle(device, refiner);
    else
        api_fail(device, RAD_ERROR_INVALID_ORACLE, "%s", said && *said ? said : "out of memory for a graph");
    free(said);
    return oracle;
}

RadOracle radLoadOracle(RadDevice device, const char *path, const char *name, enum RadRelease release)
{
    if (!device)
        return NULL;
    if (!path) {
        api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "an oracle's file needs a name");
        return NULL;
    }
    if (release == RAD_RELEASE_DAG)
        return interpret(device, path, NULL, name);
    if (release != RAD_RELEASE_FLAT) {
        api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "a file has a flat release and a DAG release, and no other");
        return NULL;
    }
    struct refiner *refiner = oracles_open(path, RELEASE_FLAT);
    if (refiner)
        return make_oracle(device, refiner);
    api_fail(device, RAD_ERROR_INVALID_ORACLE, "%s: cannot be compiled; try RAD_RELEASE_DAG", path);
    return NULL;
}

RadOracle radParseOracle(RadDevice device, const char *path, const char *text, const char *name)
{
    if (!device)
        return NULL;
    if (!path || !text) {
        api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "a graph needs a name and a text");
        return NULL;
    }
    return interpret(device, path, text, name);
}

RadOracle radNewOracleCompiled(RadDevice device, const struct oracle *compiled, const char *release)
{
    if (!device)
        return NULL;
    if (!compiled || !compiled->refine || !compiled->defaults) {
        api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "a compiled oracle needs defaults and a refine function");
        return NULL;
    }
    if (compiled->abi != RUNTIME_ABI) {
        api_fail(device, RAD_ERROR_INVALID_ORACLE, "oracle %s was compiled against ABI %d, not %d; compile it anew", compiled->name, compiled->abi, RUNTIME_ABI);
        return NULL;
    }
    return make_oracle(device, refiner_compiled(compiled, release ? release : "flat"));
}

void radRetainOracle(RadOracle oracle)
{
    if (oracle)
        atomic_fetch_add(&oracle->holders, 1);
}

static void forget_statistics(RadOracle oracle)
{
    statistics_free(&oracle->counted);
    free(oracle->nodes);
    free(oracle->answers);
    free(oracle->bins);
    oracle->nodes = NULL;
    oracle->answers = NULL;
    oracle->bins = NULL;
}

void radReleaseOracle(RadOracle oracle)
{
    if (!oracle || atomic_fetch_sub(&oracle->holders, 1) != 1)
        return;
    forget_statistics(oracle);
    refiner_close(oracle->refiner);
    radReleaseDevice(oracle->device);
    free(oracle);
}

void radGetOracleReport(RadOracle oracle, struct RadOracleReport *report)
{
    if (!report)
        return;
    *report = (struct RadOracleReport){ .name = "", .release = "", .doc = "", .fingerprint = "" };
    if (!oracle)
        return;
    const struct refiner *r = oracle->refiner;
    const struct builtin *b = find_builtin(r->oracle);
    report->name = r->oracle;
    report->release = r->release;
    report->doc = r->doc;
    if (b && strcmp(r->release, "flat") == 0)
        report->fingerprint = b->flat->fingerprint;
    report->parameters = r->parameters;
    report->parameter_count = r->parameter_count;
    report->reads_importance = (r->reads & REFINER_READS_IMPORTANCE) != 0;
    report->reads_tolerance = (r->reads & REFINER_READS_ALLOWANCE) != 0;
}

static int find_parameter(const struct refiner *r, const char *name)
{
    for (int i = 0; name && i < r->parameter_count; i++)
        if (strcmp(r->parameters[i].name, name) == 0)
            return i;
    return -1;
}

int radSetOracleParameter(RadOracle oracle, const char *name, double value)
{
    if (!oracle)
        return -1;
    const struct refiner *r = oracle->refiner;
    int i = find_parameter(r, name);
    if (i < 0) {
        char names[MESSAGE_SIZE / 2] = "";
        for (int k = 0; k < r->parameter_count; k++) {
            size_t at = strlen(names);
            snprintf(names + at, sizeof names - at, "%s %s", k ? "," : "", r->parameters[k].name);
        }
        return api_fail(oracle->device, RAD_ERROR_INVALID_ARGUMENT, "oracle %s has no parameter '%s'; it has%s", r->oracle, name ? name : "", names);
    }
    const struct oracle_parameter *p = &r->parameters[i];
    const char *cause = refiner_set(oracle->refiner, name, value);
    if (cause)
        return api_fail(oracle->device, RAD_ERROR_INVALID_ARGUMENT, "%s = %g: %s; %s takes %s%g to %g%s%s", name, value, cause, name,
                        p->integer ? "whole numbers from " : "", p->low, p->high, *p->unit ? " " : "", p->unit);
    return 0;
}

double radGetOracleParameter(RadOracle oracle, const char *name)
{
    int i = oracle ? find_parameter(oracle->refiner, name) : -1;
    return i < 0 ? (double)NAN : refiner_get(oracle->refiner, i);
}

enum decision radAskOracle(RadOracle oracle, struct discussion *discussion)
{
    return oracle->refiner->refine(oracle->refiner->state, discussion);
}

int radCountOracle(RadOracle oracle)
{
    if (!oracle)
        return -1;
    if (strcmp(oracle->refiner->release, "dag") != 0)
        return api_fail(oracle->device, RAD_ERROR_INVALID_OPERATION, "only interpreted graphs count; make oracle %s with RAD_RELEASE_DAG", oracle->refiner->oracle);
    if (refiner_count(oracle->refiner, oracle->device->threads) < 0)
        return api_fail(oracle->device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for the statistics");
    oracle->counting = 1;
    return 0;
}

_Static_assert((int)RAD_COUNTS == (int)STATISTICS_COUNTS && (int)RAD_RECORDS == (int)STATISTICS_SLOTS && (int)RAD_BINS == STATISTICS_HIGH - STATISTICS_LOW,
               "statistics have one size");

/* The engine's statistics in the caller's form. Returns 0, or -1 when out of memory. */
static int show_statistics(RadOracle oracle)
{
    const struct statistics *s = &oracle->counted;
    size_t answers = 0;
    for (int i = 0; i < s->node_count; i++)
        answers += (size_t)s->nodes[i].answer_count;
    oracle->nodes = malloc(((size_t)s->node_count + 1) * sizeof *oracle->nodes);
    oracle->answers = malloc((answers + 1) * sizeof *oracle->answers);
    oracle->bins = malloc(RAD_RECORDS * sizeof *oracle->bins);
    if (!oracle->nodes || !oracle->answers || !oracle->bins)
        return -1;
    struct RadAnswerCount *to = oracle->answers;
    for (int i = 0; i < s->node_count; i++) {
        const struct node_statistics *n = &s->nodes[i];
        oracle->nodes[i] = (struct RadNodeCount){ n->name, n->tool, n->calls, to, n->answer_count };
        for (int k = 0; k < n->answer_count; k++)
            *to++ = (struct RadAnswerCount){ n->answers[k].name, n->answers[k].kind, n->answers[k].target, n->answers[k].count };
    }
    for (int i = 0; i < RAD_RECORDS; i++) {
        oracle->zero[i] = s->records[i].zero;
        memcpy(oracle->bins[i], s->records[i].bins, sizeof oracle->bins[i]);
    }
    return 0;
}

int radGetOracleStatistics(RadOracle oracle, struct RadStatistics *statistics)
{
    if (!oracle || !statistics)
        return -1;
    forget_statistics(oracle);
    if (!oracle->counting)
        return api_fail(oracle->device, RAD_ERROR_INVALID_OPERATION, "nothing is counted; radCountOracle comes first");
    if (statistics_take(&oracle->counted, oracle->refiner) < 0 || show_statistics(oracle) < 0) {
        forget_statistics(oracle);
        return api_fail(oracle->device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for the statistics");
    }
    *statistics = (struct RadStatistics){ oracle->nodes, oracle->counted.node_count, oracle->counted.counts,
                                          (const uint64_t (*)[RAD_BINS])oracle->bins, oracle->zero };
    return 0;
}
