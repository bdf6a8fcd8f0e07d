/* refiner.c - parameters by name, for every release alike.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "oracle/refiner.h"

static void write_parameter(struct refiner *r, int i, double value)
{
    char *at = (char *)r->block + r->parameters[i].offset;
    if (r->parameters[i].integer) {
        int whole = (int)value;
        memcpy(at, &whole, sizeof whole);
    } else {
        memcpy(at, &value, sizeof value);
    }
}

double refiner_get(const struct refiner *r, int i)
{
    const char *at = (const char *)r->block + r->parameters[i].offset;
    double value;
    int whole;
    if (r->parameters[i].integer) {
        memcpy(&whole, at, sizeof whole);
        return whole;
    }
    memcpy(&value, at, sizeof value);
    return value;
}

struct refiner *refiner_compiled(const struct oracle *oracle, const char *release)
{
    struct refiner *r;
    if (oracle->abi != RUNTIME_ABI)
        return NULL;
    r = calloc(1, sizeof *r);
    if (!r)
        return NULL;
    r->block = calloc(1, oracle->parameters_size);
    if (!r->block) {
        free(r);
        return NULL;
    }
    oracle->defaults(r->block);
    r->refine = oracle->refine;
    r->state = r->block;
    r->oracle = oracle->name;
    r->doc = oracle->doc;
    r->release = release;
    r->parameters = oracle->parameters;
    r->parameter_count = oracle->parameter_count;
    return r;
}

const char *refiner_set(struct refiner *r, const char *name, double value)
{
    int i;
    for (i = 0; i < r->parameter_count; i++) {
        const struct oracle_parameter *p = &r->parameters[i];
        if (strcmp(p->name, name) != 0)
            continue;
        if (!(value >= p->low && value <= p->high))
            return "out of range";
        if (p->integer && value != floor(value))
            return "not a whole number";
        write_parameter(r, i, value);
        if (r->prepare)
            r->prepare(r);
        return NULL;
    }
    return "no such parameter";
}

void refiner_close(struct refiner *r)
{
    if (!r)
        return;
    if (r->release_state)
        r->release_state(r);
    free(r->block);
    free(r);
}
