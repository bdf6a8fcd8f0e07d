/* described.c - what both releases say of themselves against the graph: names, units, texts,
 * defaults and ranges of the parameters, where they are, roles, facts that are read and
 * fingerprint; and that a parameter which is set is set, and one out of range is not.
 *
 * A program goes by these and not by the graph: a default of another value decides otherwise.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "prove/proving.h"

static const char *const release_names[PROVE_RELEASES] = {"the compiled oracle", "the interpreter"};

static void differs(struct proof *proof, enum prove_release release, const char *what,
                    const char *wanted, const char *got)
{
    proof->different = 1;
    fprintf(proof->report, "%s: %s differs in %s: the graph has %s, it has %s\n",
            proof->oracle->name, release_names[release], what, wanted, got);
}

static void compare_texts(struct proof *proof, enum prove_release release, const char *what,
                          const char *wanted, const char *got)
{
    if (got == NULL || strcmp(wanted, got) != 0)
        differs(proof, release, what, dag_format(&proof->dag->arena, "\"%s\"", wanted),
                got == NULL ? "none" : dag_format(&proof->dag->arena, "\"%s\"", got));
}

static void compare_numbers(struct proof *proof, enum prove_release release, const char *what,
                            double wanted, double got)
{
    char a[32], b[32];
    if (memcmp(&wanted, &got, sizeof wanted) != 0)
        differs(proof, release, what, dag_number(wanted, a), dag_number(got, b));
}

/* A value that a program may set: not the default, where there is another. */
static double other_value(const struct parameter *p, int whole)
{
    double step = whole ? 1 : p->value == 0 ? 0.5 : fabs(p->value) / 2;
    if (p->value + step <= p->high)
        return p->value + step;
    return p->value - step >= p->low ? p->value - step : p->value;
}

static void set(struct proof *proof, enum prove_release release, int number,
                const struct parameter *p, const char *what)
{
    const struct prove_library *library = proof->library;
    int whole = proof->dag->types[p->type].base == BASE_INTEGER;
    double value = other_value(p, whole), then,
           out[] = {whole ? p->high + 1 : nextafter(p->high, INFINITY),
                    whole ? p->low - 1 : nextafter(p->low, -INFINITY), (double)NAN};
    int refused = library->set(release, number, value, &then) != 0;
    if (refused != p->fixed)
        differs(proof, release, what, p->fixed ? "that it is fixed" : "that it can be set",
                refused ? "that it cannot be set" : "that it can");
    compare_numbers(proof, release, what, p->fixed ? p->value : value, then);
    for (size_t i = 0; i < sizeof out / sizeof *out; i++)
        if (!(out[i] >= p->low && out[i] <= p->high)
            && library->set(release, number, out[i], &then) == 0)
            differs(proof, release, what, "its range", "none");
    if (!p->fixed)
        (void)library->set(release, number, p->value, &then);
}

static void compare_parameter(struct proof *proof, enum prove_release release, int number)
{
    const struct dag *dag = proof->dag;
    const struct parameter *p = &dag->parameters[proof->oracle->parameters.first + number];
    const struct type *type = &dag->types[p->type];
    struct prove_parameter got;
    proof->library->parameter(release, number, &got);
#define WHAT(what) dag_format(&proof->dag->arena, what " of parameter %s", p->name)
    compare_texts(proof, release, WHAT("the name"), p->name, got.name);
    compare_texts(proof, release, WHAT("the unit"), type->unit_text, got.unit);
    compare_texts(proof, release, WHAT("the text"), p->doc, got.doc);
    compare_numbers(proof, release, WHAT("the default"), p->value, got.value);
    compare_numbers(proof, release, WHAT("the default that is filled in"), p->value, got.given);
    compare_numbers(proof, release, WHAT("the least value"), p->low, got.low);
    compare_numbers(proof, release, WHAT("the largest value"), p->high, got.high);
    compare_numbers(proof, release, WHAT("the kind"), type->base == BASE_INTEGER, got.integer);
    compare_numbers(proof, release, WHAT("the role"), p->role + 1, got.role);
    compare_numbers(proof, release, WHAT("being fixed"), p->fixed, got.fixed);
    if (release == PROVE_FLAT)
        compare_numbers(proof, release, WHAT("the offset"), (double)got.field, (double)got.offset);
    if (!proof->different)
        set(proof, release, number, p, WHAT("setting"));
#undef WHAT
}

static void compare_reads(struct proof *proof, enum prove_release release,
                          const struct prove_description *got)
{
    int count = 0;
    for (int i = 0; i < proof->dag->fact_count; i++)
        if (dag_reads_fact(proof->dag, proof->oracle, i)) {
            if (count >= got->reads || got->read[count] != i)
                differs(proof, release, "the facts that it reads", proof->dag->facts[i].name,
                        "not");
            count++;
        }
    compare_numbers(proof, release, "how many facts it reads", count, got->reads);
}

int prove_descriptions(struct proof *proof)
{
    char fingerprint[17];
    dag_fingerprint_text(proof->oracle, fingerprint);
    for (enum prove_release release = 0; release < PROVE_RELEASES; release++) {
        struct prove_description got;
        proof->library->describe(release, &got);
        compare_texts(proof, release, "its name", proof->oracle->name, got.name);
        compare_texts(proof, release, "its text", proof->oracle->doc, got.doc);
        compare_texts(proof, release, "its fingerprint", fingerprint, got.fingerprint);
        if (release == PROVE_FLAT) {
            compare_numbers(proof, release, "the size of its parameters", (double)got.block,
                            (double)got.size);
        }
        compare_reads(proof, release, &got);
        compare_numbers(proof, release, "how many parameters it has",
                        proof->oracle->parameters.count, got.parameters);
        for (int i = 0; i < proof->oracle->parameters.count && i < got.parameters; i++)
            compare_parameter(proof, release, i);
    }
    return proof->different;
}
