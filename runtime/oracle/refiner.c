/* refiner.c - parameters by name, for every release alike.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
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
    if (r->parameters[i].integer) {
        int whole;
        memcpy(&whole, at, sizeof whole);
        return whole;
    }
    double value;
    memcpy(&value, at, sizeof value);
    return value;
}

struct refiner *refiner_compiled(const struct oracle *oracle, const char *release)
{
    if (oracle->abi != RUNTIME_ABI)
        return NULL;
    struct refiner *r;
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
    r->wave = oracle->wave;
    r->state = r->block;
    r->oracle = oracle->name;
    r->doc = oracle->doc;
    r->fingerprint = oracle->fingerprint;
    r->release = release;
    r->parameters = oracle->parameters;
    r->parameter_count = oracle->parameter_count;
    r->reads = oracle->reads;
    r->read_count = oracle->read_count;
    return r;
}

int refiner_find(const struct refiner *r, const char *name)
{
    for (int i = 0; i < r->parameter_count; i++)
        if (strcmp(r->parameters[i].name, name) == 0)
            return i;
    return -1;
}

int refiner_find_role(const struct refiner *r, int role, int after)
{
    for (int i = after + 1; i < r->parameter_count; i++)
        if (r->parameters[i].role == role)
            return i;
    return -1;
}

int refiner_reads(const struct refiner *r, int fact)
{
    for (int i = 0; i < r->read_count; i++)
        if (r->reads[i] == fact)
            return 1;
    return 0;
}

static int say_none_such(const struct refiner *r, const char *name, struct messages *messages)
{
    char names[1000] = "";
    size_t used = 0;
    for (int i = 0; i < r->parameter_count && used < sizeof names; i++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s %s", i ? "," : "",
                                 r->parameters[i].name);
    return messages_say(messages, MESSAGE_ARGUMENT, "oracle %s has no parameter '%s'; it has%s",
                        r->oracle, name, r->parameter_count ? names : " none");
}

int refiner_set(struct refiner *r, const char *name, double value, struct messages *messages)
{
    int i = refiner_find(r, name);
    if (i < 0)
        return say_none_such(r, name, messages);
    const struct oracle_parameter *p = &r->parameters[i];
    const char *cause = NULL;
    if (p->fixed)
        return messages_say(messages, MESSAGE_ARGUMENT,
                            "%s is fixed by the author of oracle %s, at %g: only its file can "
                            "change that",
                            name, r->oracle, p->value);
    if (!(value >= p->low && value <= p->high))
        cause = "out of range";
    else if (p->integer && value != floor(value))
        cause = "not a whole number";
    if (cause)
        return messages_say(messages, MESSAGE_ARGUMENT, "%s = %g: %s; %s takes %s%g to %g%s%s",
                            name, value, cause, name, p->integer ? "whole numbers from " : "",
                            p->low, p->high, *p->unit ? " " : "", p->unit);
    write_parameter(r, i, value);
    if (r->prepare)
        r->prepare(r);
    return 0;
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
