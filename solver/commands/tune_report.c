/* tune_report.c - see tune_report.h.
 * SPDX-License-Identifier: MIT */
#include "commands/tune_report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/json_values.h"

static const char *const cost_words[] = {"rays + links", "links", "rays + 40 pairs"};

double tune_worst(const struct tune_outcome *o)
{
    double worst = o->fold_count ? 0 : (double)NAN;
    for (int i = 0; i < o->fold_count; i++)
        worst = !o->folds[i].known          ? (double)NAN
                : o->folds[i].ratio > worst ? o->folds[i].ratio
                                            : worst;
    return worst;
}

int tune_fails(const struct tune_outcome *o)
{
    return o->chosen
           && (tune_worst(o) > TUNE_CARRIES
               || (isinf(o->held[o->penalty].penalty) && o->all.found.value < 0));
}

double tune_needs(const struct tuner *t, const struct tune_result *r)
{
    double above = fmax(1, r->error / t->target);
    return r->cost * above * above;
}

/* What is known of a scene at a place; state TUNE_UNKNOWN where nothing is. */
static struct tune_result known(const struct tuner *t, const int *at, int scene)
{
    for (size_t i = 0; i < t->point_count; i++) {
        int same = 1;
        for (int k = 0; k < t->parameter_count; k++)
            same &= t->points[i].at[k] == at[k];
        if (same)
            return t->points[i].results[scene];
    }
    return (struct tune_result){.state = TUNE_UNKNOWN};
}

static const char *end_text(const struct tune_fit *f)
{
    static const char *const texts[] = {[PATTERN_FOUND] = "no step is better",
                                        [PATTERN_SPENT] = "all evaluations used",
                                        [PATTERN_STOPPED] = "stopped, the best so far",
                                        [PATTERN_MEMORY] = "out of memory"};
    return texts[f->found.end];
}

static void print_parameters(const struct tune_outcome *o)
{
    const struct tuner *t = o->tuner;
    printf("  %-16s %10s %10s   within\n", "parameter", "default", "fitted");
    for (int i = 0; i < t->parameter_count; i++) {
        const struct tune_parameter *p = &t->parameters[i];
        int at = o->all.at[i];
        printf("  %-16s %10.4g %10.4g   %.2g to %.2g%s\n", p->name, p->value, tune_value(p, at),
               tune_value(p, p->low), tune_value(p, p->high),
               p->low < p->high && (at == p->low || at == p->high) ? ": at an end" : "");
    }
}

static void print_scenes(const struct tune_outcome *o)
{
    static const int defaults[PATTERN_NUMBERS];
    const struct tuner *t = o->tuner;
    double mean = 0;
    printf("\n  %-16s %17s %23s %9s\n  %-16s %8s %8s %11s %11s %9s\n", "scene", "error, %",
           cost_words[t->cost], "price,", "", "default", "fitted", "default", "fitted", "times");
    for (int s = 0; s < t->scene_count; s++) {
        struct tune_result a = known(t, defaults, s), b = known(t, o->all.at, s);
        if (a.state != TUNE_KNOWN || b.state != TUNE_KNOWN)
            continue;
        mean += log(b.price / a.price) / t->scene_count;
        printf("  %-16.*s %8.2f %8.2f %11.4g %11.4g %9.3f\n", t->scenes[s].name_length,
               t->scenes[s].name, 100 * a.error, 100 * b.error, a.cost, b.cost, b.price / a.price);
    }
    printf("  %-16s %51.3f\n", "mean", exp(mean));
}

static void print_holds(const struct tune_outcome *o)
{
    if (!o->chosen)
        return;
    printf("\nhow near to the defaults fits stay\n  ");
    for (int h = 0; h < TUNE_PENALTIES; h++)
        if (isfinite(o->held[h].penalty))
            printf(" %6.3g ", 100 * o->held[h].penalty);
        else
            printf(" %6s ", "all");
    printf("   each doubling has to save, %%\n  ");
    for (int h = 0; h < TUNE_PENALTIES; h++)
        printf(" %6.3f%c", o->held[h].times, h == o->penalty ? '*' : ' ');
    printf("  price, scenes left out, times\n  ");
    for (int h = 0; h < TUNE_PENALTIES; h++)
        printf(" %6.2f%c", o->held[h].worst, h == o->penalty ? '*' : ' ');
    printf("  needed left out over used, at most\n");
}

static void print_folds(const struct tune_outcome *o)
{
    const struct tuner *t = o->tuner;
    if (!o->fold_count) {
        printf("\nnot cross-validated: that takes two scenes or more\n");
        return;
    }
    printf("\neach scene where it was used to fit, and where it was left out\n"
           "  %-16s %8s %8s %12s %12s %8s\n  %-16s %8s %8s %12s %12s %8s\n",
           "", "error, %", "", cost_words[t->cost], "", "ratio", "scene", "used", "left out",
           "used", "left out", "");
    for (int i = 0; i < o->fold_count; i++) {
        const struct tune_fold *f = &o->folds[i];
        printf("  %-16.*s", t->scenes[i].name_length, t->scenes[i].name);
        if (f->known)
            printf(" %8.2f %8.2f %12.4g %12.4g %8.3f\n", 100 * f->used_error, 100 * f->left.error,
                   f->used_cost, f->left.cost, f->ratio);
        else
            printf(" not known: its fit was stopped too soon\n");
    }
    double worst = tune_worst(o);
    if (isnan(worst))
        printf("cross-validation: not finished\n");
    else if (tune_fails(o))
        printf(
            "cross-validation: FAILS: nothing that fits found carries over; the defaults stay\n");
    else
        printf(
            "cross-validation: holds: left out, a scene needs at most %.2f times as much as used; "
            "%g is allowed\n",
            worst, TUNE_CARRIES);
}

void tune_print(const struct tune_outcome *o)
{
    const struct tuner *t = o->tuner;
    printf("%s on %d scene%s, for %g %% error (power %d): %d places, %s; %d solves, %.1f s\n\n",
           o->oracle, t->scene_count, t->scene_count == 1 ? "" : "s", 100 * t->target, t->power,
           o->all.found.evaluations, end_text(&o->all), t->solves, o->seconds);
    print_parameters(o);
    print_scenes(o);
    print_holds(o);
    print_folds(o);
}

/* ---- JSON */

static json_t *parameters_json(const struct tuner *t, const int *at)
{
    json_t *object = json_object();
    for (int i = 0; i < t->parameter_count; i++)
        json_object_set_new(object, t->parameters[i].name,
                            json_real(tune_value(&t->parameters[i], at[i])));
    return object;
}

static json_t *result_json(struct tune_result r)
{
    return r.state == TUNE_KNOWN
               ? json_pack("{s:f, s:f, s:f}", "error", r.error, "cost", r.cost, "price", r.price)
               : json_null();
}

static json_t *name_json(const struct tune_scene *s)
{
    char *name = strndup(s->name, (size_t)s->name_length);
    json_t *text = name ? json_text(name) : NULL;
    free(name);
    return text;
}

static json_t *fold_json(const struct tuner *t, const struct tune_fold *f, int scene)
{
    json_t *name = name_json(&t->scenes[scene]);
    if (!f->known)
        return json_pack("{s:o, s:n}", "scene", name, "ratio");
    return json_pack("{s:o, s:o, s:o, s:{s:f, s:f}, s:o, s:f}", "scene", name, "parameters",
                     parameters_json(t, f->fit.at), "lowest", parameters_json(t, f->fit.found.at),
                     "used", "error", f->used_error, "cost", f->used_cost, "left_out",
                     result_json(f->left), "ratio", f->ratio);
}

/* Mean logarithm of what the scenes' prices are multiplied by. */
static double price_of(const struct tune_outcome *o)
{
    static const int defaults[PATTERN_NUMBERS];
    const struct tuner *t = o->tuner;
    double mean = 0;
    for (int s = 0; s < t->scene_count; s++)
        mean += log(known(t, o->all.at, s).price / known(t, defaults, s).price) / t->scene_count;
    return mean;
}

json_t *tune_json(const struct tune_outcome *o)
{
    static const int defaults[PATTERN_NUMBERS];
    const struct tuner *t = o->tuner;
    json_t *scenes = json_array(), *folds = json_array(), *holds = json_array();
    double worst = tune_worst(o);
    for (int s = 0; s < t->scene_count; s++)
        json_array_append_new(scenes, json_pack("{s:o, s:f, s:I, s:o, s:o}", "scene",
                                                name_json(&t->scenes[s]), "uncertain",
                                                t->scenes[s].uncertain, "particles",
                                                (json_int_t)t->scenes[s].particles, "default",
                                                result_json(known(t, defaults, s)), "fitted",
                                                result_json(known(t, o->all.at, s))));
    for (int i = 0; i < o->fold_count; i++)
        json_array_append_new(folds, fold_json(t, &o->folds[i], i));
    for (int h = 0; h < TUNE_PENALTIES && o->chosen; h++)
        json_array_append_new(
            holds, json_pack("{s:o, s:f, s:o, s:b}", "penalty", json_finite(o->held[h].penalty),
                             "left_out_times", o->held[h].times, "worst_ratio",
                             json_finite(o->held[h].worst), "taken", h == o->penalty));
    return json_pack(
        "{s:o, s:s, s:f, s:i, s:s, s:o, s:o, s:f, s:i, s:s, s:o, s:o, s:o, s:o, s:o, s:i, s:f}",
        "oracle", json_text(o->oracle), "basis",
        t->basis == RAD_BASIS_LINEAR ? "linear" : "constant", "target", t->target, "power",
        t->power, "cost", cost_words[t->cost], "default", parameters_json(t, defaults), "fitted",
        parameters_json(t, o->all.at), "price_times", exp(price_of(o)), "evaluations",
        o->all.found.evaluations, "ended", end_text(&o->all), "scenes", scenes, "penalties", holds,
        "folds", folds, "worst_ratio", json_finite(worst), "carries_over",
        isnan(worst) ? json_null() : json_boolean(!tune_fails(o)), "solves", t->solves, "seconds",
        o->seconds);
}
