/* graph_drawing.c - see graph_drawing.h: which shapes there are, and what they say.
 *
 * Sizes must not depend on the fonts of the machine that draws, so a line's width is reckoned: .58
 * of the height for each letter, which is what Helvetica's small letters take with a margin.
 * SPDX-License-Identifier: MIT */
#include "output/graph_drawing.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/graph_expression.h"
#include "output/json_values.h"
#include "util/array.h"
#include "util/report.h"

static const double LETTER = 0.58, LINE = 1.3; /* of the letters' height */
enum { ARGUMENT_LETTERS = 40 }; /* what is longer ends in "..." and is told in whole on hovering */

double drawing_text_width(const char *text, double height)
{
    return LETTER * height * (double)strlen(text);
}

/* A text of the drawing's own; "" when there is no memory. */
static const char *say(struct drawing *p, const char *format, ...) PRINTF_LIKE(2, 3);
static const char *say(struct drawing *p, const char *format, ...)
{
    va_list list, again;
    va_start(list, format);
    va_copy(again, list);
    int length = vsnprintf(NULL, 0, format, list);
    char *text = length < 0 ? NULL : malloc((size_t)length + 1);
    if (text
        && array_reserve(&p->texts, p->text_count + 1, &p->text_capacity, sizeof *p->texts) < 0) {
        free(text);
        text = NULL;
    }
    if (text) {
        vsnprintf(text, (size_t)length + 1, format, again);
        p->texts[p->text_count++] = text;
    }
    p->failed |= !text;
    va_end(again);
    va_end(list);
    return text ? text : "";
}

static double number_of(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

/* The object of a list whose member `key` is `name`, NULL when there is none. */
static const json_t *find(const json_t *list, const char *key, const char *name)
{
    size_t i;
    json_t *item;
    json_array_foreach(list, i, item)
    {
        if (strcmp(json_word(item, key), name) == 0)
            return item;
    }
    return NULL;
}

static int find_node(const struct drawing *p, const char *name)
{
    for (size_t i = 0; i < p->node_count; i++)
        if (strcmp(p->nodes[i].name, name) == 0)
            return (int)i;
    return -1;
}

static int find_branch(const struct drawing *p, const char *name)
{
    for (size_t i = 0; i < p->branch_count; i++)
        if (strcmp(p->branches[i].name, name) == 0)
            return (int)i;
    return -1;
}

/* "pair__cut__guard" in the branch "pair__cut" is "guard": the box around it says the rest. */
static const char *short_name(const char *name, const char *branch)
{
    size_t length = strlen(branch);
    return length && strncmp(name, branch, length) == 0 && strncmp(name + length, "__", 2) == 0
               ? name + length + 2
               : name;
}

/* Shares in steps that the eye tells apart: each about three times the one before. */
static int heat_of(double share)
{
    static const double steps[DRAWING_HEATS - 1] = {0.001, 0.003, 0.01, 0.03, 0.1, 0.3};
    int heat = 0;
    while (heat < DRAWING_HEATS - 1 && share >= steps[heat])
        heat++;
    return heat;
}

/* A share in percent with two digits, without an exponent. */
static const char *percent(struct drawing *p, double share)
{
    double x = 100 * share;
    return x >= 9.95 ? say(p, "%.0f %%", x) : say(p, "%.*f %%", x >= 0.995 || x == 0 ? 1 : 2, x);
}

/* ---- branches */

static void read_branches(struct drawing *p, const json_t *branches)
{
    for (size_t i = 0; i < p->branch_count; i++) {
        const json_t *from = json_array_get(branches, i);
        struct drawing_branch *b = &p->branches[i];
        const char *outer = json_word(from, "outer");
        b->name = json_word(from, "name");
        b->outer = find_branch(p, outer);
        b->label = say(p, "%s = %s", short_name(b->name, outer), json_word(from, "graph"));
        b->title = say(p, "%s: the branch %s\n%s", b->name, json_word(from, "graph"),
                       json_word(from, "doc"));
        b->label_width = drawing_text_width(b->label, DRAWING_SMALL);
    }
}

/* ---- nodes */

static void add_line(struct drawing_node *n, const char *line)
{
    if (n->line_count < DRAWING_LINES)
        n->lines[n->line_count++] = line;
}

/* Does the argument say what the tool does anyway? */
static int is_default(const json_t *tool, const char *name, const json_t *value)
{
    const json_t *usual = json_object_get(find(json_object_get(tool, "parameters"), "name", name),
                                          "default"),
                 *number = json_object_get(value, "number");
    return json_is_number(usual) && json_is_number(number)
           && json_number_value(usual) == json_number_value(number);
}

/* A line per argument that the node gives a value of its own. */
static void read_arguments(struct drawing *p, struct drawing_node *n, const json_t *node,
                           const json_t *tool)
{
    size_t i;
    json_t *argument;
    json_array_foreach(json_object_get(node, "arguments"), i, argument)
    {
        char value[512];
        const char *name = json_word(argument, "name");
        graph_expression_text(json_object_get(argument, "value"), value, sizeof value);
        int same = strcmp(name, value) == 0;
        const char *line = same ? say(p, "%s", name) : say(p, "%s = %s", name, value);
        n->title = say(p, "%s\n%s = %s", n->title, name, value);
        if (strlen(line) > ARGUMENT_LETTERS)
            line = say(p, "%.*s...", ARGUMENT_LETTERS - 3, line);
        if (n->line_count < DRAWING_LINES - 1
            && !is_default(tool, name, json_object_get(argument, "value")))
            add_line(n, line);
    }
}

/* What was counted of it. */
static void read_counted(struct drawing *p, struct drawing_node *n, const json_t *counted)
{
    double share = number_of(counted, "share"), time = number_of(counted, "seconds_share");
    n->discussed = number_of(counted, "calls");
    n->unused = n->discussed == 0;
    n->heat = heat_of(time);
    if (n->unused) {
        add_line(n, "never asked");
        n->title = say(p, "%s\nnever asked", n->title);
        return;
    }
    add_line(n, say(p, "%s asked, %s of time", percent(p, share), percent(p, time)));
    n->title = say(p, "%s\nasked %.0f times (%.3g %%), %.3g %% of the time, %.3g us each", n->title,
                   n->discussed, 100 * share, 100 * time, 1e6 * number_of(counted, "mean_seconds"));
    if (number_of(counted, "rays") > 0)
        n->title = say(p, "%s\n%.0f rays", n->title, number_of(counted, "rays"));
    const char *term;
    json_t *count;
    json_object_foreach(json_object_get(counted, "terms"), term, count)
    {
        n->title = say(p, "%s\n%s computed %.0f times", n->title, term, json_number_value(count));
    }
}

static void read_node(struct drawing *p, struct drawing_node *n, const json_t *node,
                      const json_t *tools, const json_t *statistics)
{
    const json_t *tool = find(tools, "name", json_word(node, "tool"));
    *n = (struct drawing_node){.name = json_word(node, "name"), .heat = -1, .branch = -1};
    n->branch = find_branch(p, json_word(node, "branch"));
    n->class = strcmp(json_word(tool, "kind"), "command") == 0        ? "command"
               : json_array_size(json_object_get(tool, "writes")) > 0 ? "term"
                                                                      : "question";
    n->guards = json_is_true(json_object_get(tool, "guards"));
    n->title = say(p, "%s = %s\n%s", n->name, json_word(tool, "name"), json_word(tool, "doc"));
    add_line(n, short_name(n->name, json_word(node, "branch")));
    add_line(n, json_word(tool, "name"));
    read_arguments(p, n, node, tool);
    if (statistics)
        read_counted(p, n, find(json_object_get(statistics, "nodes"), "node", n->name));
    n->width = drawing_text_width(n->lines[0], DRAWING_NAME);
    for (int i = 1; i < n->line_count; i++)
        n->width = fmax(n->width, drawing_text_width(n->lines[i], DRAWING_SMALL));
    n->width += 24;
    n->height = LINE * (DRAWING_NAME + DRAWING_SMALL * (n->line_count - 1)) + 10;
}

/* ---- arcs and leaves */

/* Where the answer leads. Returns -1 when there is no memory. */
static int find_target(struct drawing *p, struct drawing_arc *a, const json_t *arc,
                       const json_t *decisions)
{
    const char *decision = json_word(arc, "decision");
    a->leaf = -1;
    a->node = find_node(p, json_word(arc, "node"));
    if (a->node >= 0)
        return 0;
    for (size_t i = 0; i < p->leaf_count; i++)
        if (p->leaves[i].node == a->from && strcmp(p->leaves[i].decision, decision) == 0)
            a->leaf = (int)i;
    if (a->leaf >= 0)
        return 0;
    if (array_reserve(&p->leaves, p->leaf_count + 1, &p->leaf_capacity, sizeof *p->leaves) < 0)
        return -1;
    const json_t *how = find(decisions, "name", decision);
    struct drawing_leaf *leaf = &p->leaves[p->leaf_count];
    *leaf = (struct drawing_leaf){
        .node = a->from,
        .decision = decision,
        .class = json_is_true(json_object_get(how, "subdivides"))     ? "subdivides"
                 : json_array_size(json_object_get(how, "reads")) > 0 ? "links"
                                                                      : "stops",
        .title = say(p, "%s\n%s", decision, json_word(how, "doc")),
        .unused = 1,
        .width = drawing_text_width(decision, DRAWING_SMALL) + 12,
        .height = LINE * DRAWING_SMALL + 4};
    a->leaf = (int)p->leaf_count++;
    return 0;
}

/* An arc of the node so far that this answer may share. */
static struct drawing_arc *find_like(struct drawing *p, size_t first, const struct drawing_arc *a)
{
    for (size_t i = first; i < p->arc_count; i++) {
        struct drawing_arc *b = &p->arcs[i];
        if (b->node == a->node && b->leaf == a->leaf && b->dead == a->dead
            && strcmp(b->kind, a->kind) == 0)
            return b;
    }
    return NULL;
}

static const char *const kind_words[] = {"precise", "approximate", "other"};

/* The answers of node `from`. Returns 0, or -1 when there is no memory. */
static int read_arcs(struct drawing *p, int from, const json_t *node, const json_t *decisions,
                     const json_t *statistics)
{
    const struct drawing_node *n = &p->nodes[from];
    const json_t *counted =
        statistics ? find(json_object_get(statistics, "nodes"), "node", n->name) : NULL;
    const double all = number_of(statistics, "discussions");
    const size_t first = p->arc_count;
    size_t i;
    json_t *arc;
    json_array_foreach(json_object_get(node, "arcs"), i, arc)
    {
        const char *answer = json_word(arc, "answer"), *kind = json_word(arc, "kind");
        double count =
            number_of(find(json_object_get(counted, "answers"), "answer", answer), "count");
        struct drawing_arc a = {
            .from = from, .kind = "other", .answer = answer, .dead = counted && count == 0};
        for (size_t k = 0; k < sizeof kind_words / sizeof *kind_words; k++)
            a.kind = strcmp(kind, kind_words[k]) == 0 ? kind_words[k] : a.kind;
        if (strcmp(n->class, "command") == 0)
            a.kind = "command";
        if (find_target(p, &a, arc, decisions) < 0)
            return -1;
        if (a.leaf >= 0)
            p->leaves[a.leaf].unused &= a.dead;
        struct drawing_arc *to = find_like(p, first, &a);
        if (!to) {
            if (array_reserve(&p->arcs, p->arc_count + 1, &p->arc_capacity, sizeof *p->arcs) < 0)
                return -1;
            to = &p->arcs[p->arc_count++];
            a.title = "";
            a.share = counted ? 0 : -1;
            *to = a;
        }
        const char *target =
            *json_word(arc, "node") ? json_word(arc, "node") : json_word(arc, "decision");
        to->title = say(p, "%s%s%s: %s (%s) leads to %s", to->title, *to->title ? "\n" : "",
                        n->name, answer, a.kind, target);
        if (counted) {
            to->share += all > 0 ? count / all : 0;
            to->title = say(p, "%s, %.0f of %.0f times (%.3g %%)", to->title, count, n->discussed,
                            n->discussed > 0 ? 100 * count / n->discussed : 0);
        }
        if (to->line_count < DRAWING_LINES)
            to->lines[to->line_count++] =
                counted && !a.dead ? say(p, "%s %s", answer, percent(p, count / n->discussed))
                                   : answer;
        to->label_width = fmax(
            to->label_width, drawing_text_width(to->lines[to->line_count - 1], DRAWING_SMALL) + 6);
        to->label_height = LINE * DRAWING_SMALL * to->line_count + 2;
    }
    return 0;
}

/* ---- all together */

/* A file of statistics may be of another graph, or of another version of it. */
static int check_same(const struct drawing *p, const json_t *nodes, const json_t *statistics)
{
    const char *of = json_word(statistics, "oracle");
    size_t i, k;
    json_t *node, *arc;
    if (strcmp(of, p->oracle) != 0)
        return report_error("--statistics", 0, "they are of the oracle %s, not of %s; count again",
                            of, p->oracle);
    json_array_foreach(nodes, i, node)
    {
        const char *name = json_word(node, "name");
        const json_t *counted = find(json_object_get(statistics, "nodes"), "node", name);
        if (!counted || strcmp(json_word(counted, "tool"), json_word(node, "tool")) != 0)
            return report_error("--statistics", 0,
                                "they know no node %s with the tool %s: the graph has changed "
                                "since; count again",
                                name, json_word(node, "tool"));
        json_array_foreach(json_object_get(node, "arcs"), k, arc)
        {
            const char *answer = json_word(arc, "answer");
            if (!find(json_object_get(counted, "answers"), "answer", answer))
                return report_error("--statistics", 0,
                                    "they know no answer %s of the node %s: the graph has changed "
                                    "since; count again",
                                    answer, name);
        }
    }
    return 0;
}

int drawing_open(struct drawing *p, const json_t *graph, const char *name, const json_t *statistics)
{
    const json_t *oracle = find(json_object_get(graph, "oracles"), "name", name),
                 *catalog = json_object_get(graph, "catalog"),
                 *nodes = json_object_get(oracle, "nodes"),
                 *decisions = json_object_get(catalog, "decisions"),
                 *branches = json_object_get(oracle, "branches");
    *p = (struct drawing){.oracle = json_word(oracle, "name"), .doc = json_word(oracle, "doc")};
    if (statistics && check_same(p, nodes, statistics) < 0)
        return -1;
    p->branches = calloc(json_array_size(branches) + 1, sizeof *p->branches);
    p->nodes = calloc(json_array_size(nodes) + 1, sizeof *p->nodes);
    if (!p->nodes || !p->branches)
        return report_error(name, 0, "out of memory for its drawing");
    p->branch_count = json_array_size(branches);
    for (size_t i = 0; i < p->branch_count; i++)
        p->branches[i].name = json_word(json_array_get(branches, i), "name");
    read_branches(p, branches);
    for (size_t i = 0; i < json_array_size(nodes); i++, p->node_count++)
        read_node(p, &p->nodes[i], json_array_get(nodes, i), json_object_get(catalog, "tools"),
                  statistics);
    for (size_t i = 0; i < p->node_count && !p->failed; i++)
        p->failed = read_arcs(p, (int)i, json_array_get(nodes, i), decisions, statistics) < 0;
    if (statistics)
        p->summary = say(p,
                         "%s: %.0f discussions, %.0f rays, %.3g s in the nodes (estimated: one "
                         "discussion of %.0f was timed)",
                         json_word(statistics, "scene"), number_of(statistics, "discussions"),
                         number_of(statistics, "rays"), number_of(statistics, "seconds"),
                         number_of(statistics, "timed_every"));
    return p->failed ? report_error(name, 0, "out of memory for its drawing") : 0;
}

void drawing_close(struct drawing *p)
{
    for (size_t i = 0; i < p->text_count; i++)
        free(p->texts[i]);
    for (size_t i = 0; i < p->arc_count; i++)
        free(p->arcs[i].points);
    free(p->texts);
    free(p->nodes);
    free(p->leaves);
    free(p->arcs);
    free(p->branches);
    *p = (struct drawing){0};
}
