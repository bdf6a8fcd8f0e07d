/* explanation.c - see explanation.h.
 * SPDX-License-Identifier: MIT */
#include "output/explanation.h"

#include <string.h>

#include "output/json_values.h"

enum { WIDTH = 96, INDENT = 5 };

/* Words in lines of WIDTH, the first of which goes on at `column`. */
static void print_wrapped(FILE *out, int column, const char *text)
{
    while (*text) {
        int length = (int)strcspn(text, " ");
        if (column + 1 + length > WIDTH) {
            fprintf(out, "\n%*s", INDENT, "");
            column = INDENT;
        } else if (column > INDENT) {
            fputc(' ', out);
            column++;
        }
        fprintf(out, "%.*s", length, text);
        column += length;
        text += length + (text[length] == ' ');
    }
    fputc('\n', out);
}

static void print_time(FILE *out, double s)
{
    if (s < 1e-6)
        fprintf(out, "%.0f ns", s * 1e9);
    else if (s < 1e-3)
        fprintf(out, "%.1f us", s * 1e6);
    else
        fprintf(out, "%.1f ms", s * 1e3);
}

static void print_term(FILE *out, const struct RadTerm *t)
{
    fprintf(out, "%s", t->name);
    if (!t->level) {
        fprintf(out, ": not known");
        return;
    }
    fprintf(out, t->size > 1 ? " = (" : " = ");
    for (int k = 0; k < t->size && k < 3; k++)
        fprintf(out, "%s%.6g", k ? ", " : "", t->value[k]);
    fprintf(out, "%s%s%s", t->size > 1 ? ")" : "", *t->unit ? " " : "", t->unit);
    if (t->level_count)
        fprintf(out, ", %s (level %d of %d)", t->level, t->level_number, t->level_count);
}

void explanation_print_terms(FILE *out, const struct RadTerm *terms, int count)
{
    for (int i = 0; i < count; i++) {
        fprintf(out, "     ");
        print_term(out, &terms[i]);
        fputc('\n', out);
    }
    if (count == 0)
        fprintf(out, "     nothing\n");
}

void explanation_print_node(FILE *out, const struct RadExplanation *x, int i)
{
    const struct RadAsked *a = &x->asked[i];
    int column = fprintf(out, "%3d  %s asks %s:", i + 1, a->node, a->tool);
    print_wrapped(out, column, a->doc);
    for (int k = 0; k < a->argument_count; k++) {
        const struct RadArgument *g = &a->arguments[k];
        fprintf(out, "     %s %s = %.6g%s%s%s\n", k ? "      " : "given ", g->name, g->value,
                *g->unit ? " " : "", g->unit, g->computed ? ", computed" : "");
    }
    for (int k = 0; k < a->term_count; k++) {
        const struct RadTerm *t = &a->terms[k];
        fprintf(out, "     %s ", t->changed ? "writes" : t->reads ? "reads " : "keeps ");
        print_term(out, t);
        if (t->changed && t->level_before == 0)
            fprintf(out, "; was not known");
        else if (t->changed && t->level_count)
            fprintf(out, "; was at level %d", t->level_before);
        fputc('\n', out);
    }
    fprintf(out, "     says   %s", a->answer);
    if (strcmp(a->kind, "command") != 0)
        fprintf(out, ", %s", a->kind);
    fprintf(out, " -> %s    [", a->target);
    if (a->rays)
        fprintf(out, "%llu rays, ", (unsigned long long)a->rays);
    print_time(out, a->seconds);
    fprintf(out, "]\n");
}

void explanation_print_decision(FILE *out, const struct RadExplanation *x)
{
    fprintf(out, "  => %s: %s\n     after %d node%s, %llu rays, ", x->decision_name,
            x->decision_doc, x->asked_count, x->asked_count == 1 ? "" : "s",
            (unsigned long long)x->rays);
    print_time(out, x->seconds);
    fputc('\n', out);
}

void explanation_print(FILE *out, const struct RadExplanation *x)
{
    for (int i = 0; i < x->asked_count; i++)
        explanation_print_node(out, x, i);
    explanation_print_decision(out, x);
}

static json_t *term_json(const struct RadTerm *t)
{
    json_t *value = t->size > 1 ? json_array() : NULL;
    for (int k = 0; k < t->size && k < 3 && value; k++)
        json_array_append_new(value, t->level ? json_finite(t->value[k]) : json_null());
    if (t->size == 1)
        value = t->level ? json_finite(t->value[0]) : json_null();
    json_t *level = t->level && t->level_count ? json_string(t->level) : json_null();
    return json_pack("{s:s, s:o, s:s, s:o, s:i, s:i, s:i, s:b, s:b, s:b}", "term", t->name, "value",
                     value, "unit", t->unit, "level", level, "level_number", t->level_number,
                     "levels", t->level_count, "level_before", t->level_before, "reads", t->reads,
                     "writes", t->writes, "changed", t->changed);
}

static json_t *terms_json(const struct RadTerm *terms, int count)
{
    json_t *list = json_array();
    for (int i = 0; i < count; i++)
        json_array_append_new(list, term_json(&terms[i]));
    return list;
}

json_t *explanation_json(const struct RadExplanation *x)
{
    json_t *nodes = json_array();
    for (int i = 0; i < x->asked_count; i++) {
        const struct RadAsked *a = &x->asked[i];
        json_t *arguments = json_array();
        for (int k = 0; k < a->argument_count; k++) {
            const struct RadArgument *g = &a->arguments[k];
            json_array_append_new(arguments,
                                  json_pack("{s:s, s:o, s:s, s:s, s:b}", "argument", g->name,
                                            "value", json_finite(g->value), "unit", g->unit, "doc",
                                            g->doc, "computed", g->computed));
        }
        json_array_append_new(nodes, json_pack("{s:s, s:s, s:s, s:o, s:o, s:s, s:s, s:s, s:I, s:f}",
                                               "node", a->node, "tool", a->tool, "doc", a->doc,
                                               "arguments", arguments, "terms",
                                               terms_json(a->terms, a->term_count), "answer",
                                               a->answer, "kind", a->kind, "target", a->target,
                                               "rays", (json_int_t)a->rays, "seconds", a->seconds));
    }
    return json_pack("{s:o, s:s, s:s, s:I, s:f, s:o}", "nodes", nodes, "decision", x->decision_name,
                     "doc", x->decision_doc, "rays", (json_int_t)x->rays, "seconds", x->seconds,
                     "terms", terms_json(x->terms, x->term_count));
}
