/* graph_layout.c - Graphviz says where the shapes of a drawing stand.
 *
 * It is told the size of everything, as boxes without text, so that its answer does not hang on the
 * fonts of this machine, and gives places as JSON. Shapes go by number: n0, l0, e0, cluster_0.
 * [Gansner, Koutsofios, North, Vo 1993, for what dot does]
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/graph_drawing.h"
#include "output/json_values.h"
#include "util/report.h"
#include "util/run_between.h"

static const double INCH = 72;

/* ---- what dot is given */

/* A label's room. */
static void print_room(FILE *out, double width, double height)
{
    fprintf(out,
            "label=<<table border=\"0\" fixedsize=\"true\" width=\"%.0f\" height=\"%.0f\"><tr><td>"
            "</td></tr></table>>",
            ceil(width), ceil(height));
}

/* The shapes that stand in a branch (-1: in none), then the branches in it. */
static void print_branch(FILE *out, const struct drawing *p, int branch)
{
    for (size_t i = 0; i < p->node_count; i++)
        if (p->nodes[i].branch == branch)
            fprintf(out, "n%zu [width=%.4f, height=%.4f];\n", i, p->nodes[i].width / INCH,
                    p->nodes[i].height / INCH);
    for (size_t i = 0; i < p->leaf_count; i++)
        if (p->nodes[p->leaves[i].node].branch == branch)
            fprintf(out, "l%zu [width=%.4f, height=%.4f];\n", i, p->leaves[i].width / INCH,
                    p->leaves[i].height / INCH);
    for (size_t i = 0; i < p->branch_count; i++)
        if (p->branches[i].outer == branch) {
            fprintf(out, "subgraph cluster_%zu {\nmargin=10; labeljust=l; ", i);
            print_room(out, p->branches[i].label_width + 8, 1.5 * DRAWING_SMALL);
            fputs(";\n", out);
            print_branch(out, p, (int)i);
            fputs("}\n", out);
        }
}

/* nodes: of more, dot spends minutes on curves */
enum { CURVED = 100 };

static void print_dot(FILE *out, const struct drawing *p)
{
    fputs("digraph graph_ {\nrankdir=TB; nodesep=0.2; ranksep=0.3;\n"
          "node [shape=box, fixedsize=true, label=\"\"];\nedge [arrowsize=0.8];\n",
          out);
    if (p->node_count > CURVED)
        fputs("splines=line; nslimit=1; nslimit1=1; mclimit=0.1;\n", out);
    print_branch(out, p, -1);
    for (size_t i = 0; i < p->arc_count; i++) {
        const struct drawing_arc *a = &p->arcs[i];
        fprintf(out, "n%d -> %c%d [id=e%zu, ", a->from, a->node >= 0 ? 'n' : 'l',
                a->node >= 0 ? a->node : a->leaf, i);
        print_room(out, a->label_width, a->label_height);
        fputs("];\n", out);
    }
    fputs("}\n", out);
}

/* What dot makes of the drawing; NULL after a message. */
static json_t *ask_dot(const struct drawing *p)
{
    static const char *const dot[] = {"dot", "-Tjson0", NULL};
    FILE *from = tmpfile(), *to = tmpfile();
    json_t *placed = NULL;
    if (!from || !to) {
        report_error(p->oracle, 0, "no temporary file to draw it with: %s; make room in /tmp",
                     strerror(errno));
    } else {
        print_dot(from, p);
        const int status = run_between(dot, from, to);
        rewind(to);
        placed = status == 0 ? json_loadf(to, 0, NULL) : NULL;
        if (status == RUN_NO_PROGRAM)
            report_error(p->oracle, 0,
                         "cannot run 'dot': drawings are laid out by Graphviz; install it (package "
                         "graphviz)");
        else if (!placed)
            report_error(p->oracle, 0,
                         "'dot -Tjson0' could not lay out the graph; Graphviz 2.40 or later is "
                         "needed (package graphviz)");
    }
    if (from)
        fclose(from);
    if (to)
        fclose(to);
    return placed;
}

/* ---- what it answers */

/* "a,b,c,d" into count numbers. Returns 0, or -1. */
static int read_numbers(const char *text, double *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        char *end;
        numbers[i] = strtod(text, &end);
        if (end == text)
            return -1;
        text = *end == ',' ? end + 1 : end;
    }
    return 0;
}

/* "e,X,Y X,Y X,Y ...": the tip, then the curve. Returns 0, or -1. */
static int read_curve(struct drawing_arc *a, const char *text, double top)
{
    size_t points = 1;
    if (strncmp(text, "e,", 2) != 0 || read_numbers(text + 2, a->tip, 2) < 0)
        return -1;
    a->tip[1] = top - a->tip[1];
    for (const char *c = text; *c; c++)
        points += *c == ' ';
    free(a->points);
    a->points = calloc(2 * points, sizeof *a->points);
    a->point_count = 0;
    if (!a->points)
        return -1;
    for (const char *at = strchr(text, ' '); at; at = strchr(at + 1, ' ')) {
        double *point = a->points + 2 * a->point_count;
        if (read_numbers(at + 1, point, 2) < 0)
            return -1;
        point[1] = top - point[1];
        a->point_count++;
    }
    return a->point_count % 3 == 1 ? 0 : -1;
}

static int read_box(struct drawing_branch *b, const json_t *object, double top)
{
    double box[4], label[2];
    if (read_numbers(json_word(object, "bb"), box, 4) < 0
        || read_numbers(json_word(object, "lp"), label, 2) < 0)
        return -1;
    b->left = box[0];
    b->right = box[2];
    b->top = top - box[3];
    b->bottom = top - box[1];
    b->label_x = label[0] - b->label_width / 2;
    b->label_y = top - label[1];
    return 0;
}

/* A node, a leaf or a branch. Returns 0, or -1. */
static int read_object(struct drawing *p, const json_t *object)
{
    const char *name = json_word(object, "name");
    double at[2];
    unsigned i;
    if (sscanf(name, "cluster_%u", &i) == 1 && i < p->branch_count)
        return read_box(&p->branches[i], object, p->height);
    if (read_numbers(json_word(object, "pos"), at, 2) < 0)
        return -1;
    at[1] = p->height - at[1];
    if (sscanf(name, "n%u", &i) == 1 && i < p->node_count) {
        p->nodes[i].x = at[0];
        p->nodes[i].y = at[1];
    } else if (sscanf(name, "l%u", &i) == 1 && i < p->leaf_count) {
        p->leaves[i].x = at[0];
        p->leaves[i].y = at[1];
    }
    return 0;
}

static int read_arc(struct drawing *p, const json_t *edge)
{
    double at[2];
    unsigned i;
    if (sscanf(json_word(edge, "id"), "e%u", &i) != 1 || i >= p->arc_count
        || read_curve(&p->arcs[i], json_word(edge, "pos"), p->height) < 0
        || read_numbers(json_word(edge, "lp"), at, 2) < 0)
        return -1;
    p->arcs[i].x = at[0];
    p->arcs[i].y = p->height - at[1];
    return 0;
}

int drawing_place(struct drawing *p)
{
    json_t *placed = ask_dot(p), *item;
    if (!placed)
        return -1;
    double box[4];
    size_t i;
    int failed = read_numbers(json_word(placed, "bb"), box, 4) < 0;
    p->width = failed ? 0 : box[2];
    p->height = failed ? 0 : box[3];
    json_array_foreach(json_object_get(placed, "objects"), i, item)
    {
        failed |= read_object(p, item) < 0;
    }
    json_array_foreach(json_object_get(placed, "edges"), i, item)
    {
        failed |= read_arc(p, item) < 0;
    }
    for (i = 0; i < p->arc_count; i++)
        failed |= p->arcs[i].point_count == 0;
    json_decref(placed);
    return failed ? report_error(p->oracle, 0,
                                 "Graphviz's layout is not as it should be; Graphviz 2.40 or later "
                                 "is needed (package graphviz)")
                  : 0;
}
