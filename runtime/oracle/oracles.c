/* oracles.c - the three releases of an oracle, by name or from a file.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "oracle/builtin.h"
#include "oracle/compile_oracle.h"
#include "dag.h"
#include "oracle/oracles.h"
#include "util/messages.h"

const char *const release_names[RELEASES] = { "flat", "dag", "hand" };

static const struct oracle *const nobody[] = { NULL };
static const struct oracle *const *hand_oracles = nobody;

void oracles_register_hand(const struct oracle *const *table)
{
    hand_oracles = table;
}

static int is_file(const char *oracle)
{
    size_t n = strlen(oracle);
    return strchr(oracle, '/') || (n > 4 && strcmp(oracle + n - 4, ".dag") == 0) || strcmp(oracle, "-") == 0;
}

static const struct builtin *find_builtin(const char *name)
{
    const struct builtin *b;
    for (b = builtins; b->name; b++)
        if (strcmp(b->name, name) == 0)
            return b;
    return NULL;
}

static const struct oracle *find_hand(const char *oracle)
{
    int i;
    for (i = 0; hand_oracles[i]; i++)
        if (strcmp(hand_oracles[i]->name, oracle) == 0)
            return hand_oracles[i];
    return NULL;
}

int oracles_by_hand(const char *oracle)
{
    return find_hand(oracle) != NULL;
}

static struct refiner *open_hand(const char *oracle)
{
    const struct oracle *hand = find_hand(oracle);
    char names[128] = "";
    int i;
    if (hand)
        return refiner_compiled(hand, "hand");
    for (i = 0; hand_oracles[i]; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s--oracle %s", i ? " or " : "", hand_oracles[i]->name);
    report_error(oracle, 0, "no hand-written release of this oracle; use --release flat or dag, or %s", names);
    return NULL;
}

/* What a compiled oracle reads, its graph being the text (NULL: the file's). */
static void know_reads(struct refiner *r, const char *path, const char *text, const char *name)
{
    struct dag *dag = text ? dag_load_text(path, text, strlen(text), NULL, NULL, NULL) : dag_load(path, NULL, NULL, NULL);
    int index = dag ? dag_oracle(dag, name) : -1;
    if (r && index >= 0)
        r->reads = oracle_reads(dag, index);
    dag_free(dag);
}

struct refiner *oracles_open(const char *oracle, enum release release)
{
    const struct builtin *b = find_builtin(oracle);
    struct refiner *r;
    if (!b && !is_file(oracle)) {
        report_error(oracle, 0, "no such oracle; `radiosity oracles` lists the built-in ones, a file's name ends in .dag");
        return NULL;
    }
    if (release == RELEASE_HAND)
        return open_hand(oracle);
    if (release == RELEASE_DAG)
        return refiner_interpreted(oracle, b ? b->text : NULL, b ? b->name : NULL, stderr);
    if (!b) {
        r = compile_oracle(oracle);
        know_reads(r, oracle, NULL, NULL);
        return r;
    }
    r = refiner_compiled(b->flat, "flat");
    if (!r)
        report_error(oracle, 0, "out of memory");
    know_reads(r, oracle, b->text, b->name);
    return r;
}

int oracles_set(struct refiner *r, char *const *settings, int count)
{
    int i, k;
    for (i = 0; i < count; i++) {
        const char *equals = strchr(settings[i], '='), *cause;
        char name[64], *end;
        double value;
        size_t length = equals ? (size_t)(equals - settings[i]) : 0;
        if (!equals || length == 0 || length >= sizeof name)
            return report_error("--set", 0, "'%s' names no parameter; write PARAM=VALUE", settings[i]);
        memcpy(name, settings[i], length);
        name[length] = 0;
        value = strtod(equals + 1, &end);
        if (!equals[1])
            return report_error("--set", 0, "%s has no value; write %s=NUMBER", name, name);
        if (end == equals + 1 || *end || isnan(value))
            return report_error("--set", 0, "'%s' is not a number (in %s)", equals + 1, settings[i]);
        if (isinf(value) && strpbrk(equals + 1, "0123456789"))
            return report_error("--set", 0, "%s: too large to be a number here; inf is one", settings[i]);
        cause = refiner_set(r, name, value);
        if (!cause)
            continue;
        for (k = 0; k < r->parameter_count && strcmp(r->parameters[k].name, name) != 0; k++)
            ;
        if (k < r->parameter_count)
            return report_error("--set", 0, "%s = %g: %s; %s takes %s%g to %g%s%s", name, value, cause, name,
                                r->parameters[k].integer ? "whole numbers from " : "", r->parameters[k].low,
                                r->parameters[k].high, *r->parameters[k].unit ? " " : "", r->parameters[k].unit);
        fprintf(stderr, "--set: error: oracle %s has no parameter '%s'; it has", r->oracle, name);
        for (k = 0; k < r->parameter_count; k++)
            fprintf(stderr, "%s %s", k ? "," : "", r->parameters[k].name);
        fprintf(stderr, "\n");
        return -1;
    }
    return 0;
}

void oracles_print(FILE *out)
{
    const struct builtin *b;
    int i;
    for (b = builtins; b->name; b++) {
        fprintf(out, "%s%s: %s\n", b->name, strcmp(b->name, DEFAULT_ORACLE) == 0 ? " (default)" : "", b->flat->doc);
        for (i = 0; i < b->flat->parameter_count; i++) {
            const struct oracle_parameter *p = &b->flat->parameters[i];
            fprintf(out, "  %-10s %8g %-5s %s\n", p->name, p->value, p->unit, p->doc);
        }
    }
}
