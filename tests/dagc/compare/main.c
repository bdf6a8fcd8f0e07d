/* main.c - do the interpreter and flat code call the same tools with the same bits? For the oracles
 * g0, g1, ... of one file, over random parameters, facts and answers. Usage: compare FILE CATALOG.
 * Compiled with the file's flat code and the catalog's tables by check_language.
 * SPDX-License-Identifier: MIT */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "oracles.h"
#include "oracle/refiner.h"

extern const struct oracle *const oracles[]; /* list.c */
extern const int oracle_count;

double outside(const struct discussion *d)
{
    return d->record->facts[3] * 0.3 - d->terms.size;
}

static uint64_t seed = 7;

static double pick(void)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(seed >> 33) / (double)(UINT64_C(1) << 31);
}

/* Mostly ordinary, at times an end of the range. */
static double value(double low, double high)
{
    double kind = pick();
    if (kind < 0.05)
        return low;
    if (kind < 0.1)
        return high;
    if (high > 1e9)
        high = 10;
    return low + (high - low) * pick();
}

static void set(struct refiner *a, struct refiner *b)
{
    int i;
    for (i = 0; i < a->parameter_count; i++) {
        const struct oracle_parameter *p = &a->parameters[i];
        double v = value(p->low, p->high);
        if (p->integer)
            v = floor(v);
        if (refiner_set(a, p->name, v, NULL) || refiner_set(b, p->name, v, NULL))
            exit(2);
    }
}

/* The same bits; which NaN it is, C leaves open. */
static int same(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

int main(int count, char **arguments)
{
    static struct record one, two;
    static unsigned char script[4096];
    const struct extern_entry externs[] = {{"outside", outside}};
    struct interpretation how = {0};
    struct messages messages = {0};
    long calls = 0, wrong = 0, numbers = 0;
    int g, w, i, k;
    if (count < 3)
        return 2;
    how.path = arguments[1];
    how.catalog_path = arguments[2];
    for (g = 0; g < oracle_count; g++) {
        struct refiner *dag, *flat = refiner_compiled(oracles[g], "flat");
        how.oracle = oracles[g]->name;
        how.switches = "no-all"; /* random graphs, that no analysis would let pass */
        if (g == 0) {            /* without the extern it must say so and fail */
            how.extern_count = 0;
            dag = refiner_interpret(&how, &messages);
            if (dag || !strstr(messages_text(&messages), "nothing defines the extern 'outside'"))
                return fprintf(stderr, "an extern that is not registered: %s\n",
                               messages_text(&messages)),
                       1;
            messages_free(&messages);
        }
        how.externs = externs;
        how.extern_count = 1;
        dag = refiner_interpret(&how, &messages);
        if (!dag || !flat)
            return fprintf(stderr, "%s\n", messages_text(&messages)), 2;
        for (w = 0; w < 300; w++) {
            struct discussion a, b;
            enum decision x, y;
            if (w % 10 == 0)
                set(dag, flat);
            memset(&a, 0, sizeof a);
            memset(&one, 0, sizeof one);
            for (i = 0; i < 4; i++)
                one.facts[i] = i == 2 ? floor(9 * pick()) : value(0, i == 3 ? 1e300 : 5);
            for (i = 0; i < 4096; i++)
                script[i] = (unsigned char)(pick() * 256);
            one.script = script;
            two = one;
            b = a;
            a.record = &one;
            b.record = &two;
            x = dag->refine(dag->state, &a);
            y = flat->refine(flat->state, &b);
            wrong += x != y || one.calls != two.calls;
            for (i = 0; i < one.calls && i < two.calls; i++, calls++)
                for (k = 0; k < 2; k++) {
                    numbers += isfinite(one.arguments[i][k]) && one.arguments[i][k] > 0;
                    if (one.tools[i] != two.tools[i]
                        || !same(one.arguments[i][k], two.arguments[i][k])) {
                        if (wrong++ < 10)
                            fprintf(stderr, "%s, call %d: %.17g, %.17g\n", how.oracle, i,
                                    one.arguments[i][k], two.arguments[i][k]);
                    }
                }
            if (x == DECISION_KEEP && x == y)
                wrong += !same(a.terms.size, b.terms.size) || a.terms.times != b.terms.times;
        }
        refiner_close(dag);
        refiner_close(flat);
    }
    printf("%d oracles, %ld calls, %ld positive arguments, %ld differ\n", oracle_count, calls,
           numbers, wrong);
    return wrong != 0 || numbers < calls / 4;
}
